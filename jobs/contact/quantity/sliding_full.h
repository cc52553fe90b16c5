/* Blocks at finite strain, dragged along a path with friction (core/full/friction). Private to
 * jobs/contact/quantity. */
#ifndef RUGO_JOBS_CONTACT_QUANTITY_SLIDING_FULL_H
#define RUGO_JOBS_CONTACT_QUANTITY_SLIDING_FULL_H

#include "jobs/contact/quantity/sliding_record.h"

struct sliding_full;
int sliding_full_create(struct sliding_full **out, const struct quantity_scene *scene,
                        struct error *err);
void sliding_full_destroy(struct sliding_full **sliding);
/* Presses heights z to the held load and drags the flat along the path of the case. ERROR_NUMERIC
 * names load and sliding; the points before it are filled. */
int sliding_full_solve(struct sliding_full *sliding, const struct measure_context *context,
                       const double *z, struct sliding_record *record, struct error *err);
double sliding_full_bytes(const struct quantity_scene *scene);
double sliding_full_seconds(const struct quantity_scene *scene);
/* What only some realisations take of these. */
struct cost_jumps sliding_full_jumps(const struct quantity_scene *scene);

#endif
