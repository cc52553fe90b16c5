/* The loads of a contact study that gives "to" and "steps", written out as the decimals that a
 * person would write. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_LOADS_H
#define RUGO_JOBS_CONTACT_CONTACT_LOADS_H

#include "core/error.h"
#include <cjson/cJSON.h>
#include <stddef.h>

/* The loads of a study that gives neither. */
#define CONTACT_LOAD_HIGHEST 0.3
enum { CONTACT_LOADS = 30 };

/* Returns load k (from 0) of so many in equal steps up to `to`, as the double nearest to its
 * decimal of 15 digits: 0.06 rather than 0.06000000000000001. The last one is `to` itself. */
double contact_load(double to, size_t k, size_t count);

/* Returns the position of the first number that the flat, from 0, does not turn to reach; `count`
 * where each is reached in the direction against the one before. */
size_t contact_loads_turns(const double *turns, size_t count);
/* Fills the path of the flat, count * steps + 1 points: from 0 to each turning point in so many
 * equal steps. */
void contact_loads_path(const double *turns, size_t count, size_t steps, double *path);

/* Puts the loads as a list into /contact/pressures/values of a case without one, in place of
 * "steps", and of "to" where the study does not sweep it. Loads in Pa have no default.
 * ERROR_MEMORY. */
int contact_loads_fill(const cJSON *document, cJSON *parameters, struct error *err);

/* Adds loads below `held`, which is made one of them, where rising ones are so far apart that a
 * curve of what slips at `held` would show it: by tenths of it, then each half of the last, to an
 * eightieth. loads: rising, of any unit, with room for so many more. Returns the position of
 * `held`. */
enum { CONTACT_LOADS_ADDED = 13 };
size_t contact_loads_add(double *loads, size_t *count, double held);
/* Makes `held` one of the loads, and adds no others. */
size_t contact_loads_hold(double *loads, size_t *count, double held);

#endif
