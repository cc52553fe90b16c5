/* The tolerance of a contact study that gives none. */
#ifndef RUGO_JOBS_CONTACT_CONTACT_TOLERANCE_H
#define RUGO_JOBS_CONTACT_CONTACT_TOLERANCE_H

#include "core/error.h"
#include <cjson/cJSON.h>
#include <stddef.h>

/* The tolerance of cases whose program did not yet write one out. */
#define CONTACT_TOLERANCE_OLD 1e-8

/* Returns a hundredth of the relative error that meshes leave of which the finest has so many
 * points a shortest wave, from 1e-8 to 1e-4. Means change by less than the tolerance, so that the
 * solver stays a hundred times below that error. It does not depend on the number of realisations:
 * a study with more of them continues the results of one with fewer. */
double contact_tolerance(double points, size_t levels);

/* Puts it into /contact/tolerance of a case whose study gives none. ERROR_MEMORY. */
int contact_tolerance_fill(const cJSON *document, cJSON *parameters, struct error *err);

#endif
