/* A scalar as JSON: a value with its error, and theory. */
#ifndef RUGO_JOBS_SCALAR_H
#define RUGO_JOBS_SCALAR_H

#include "jobs/estimate.h"
#include "jobs/value.h"

/* theory: NaN where there is none. False when out of memory. */
bool scalar_put(cJSON *scalars, const char *name, struct estimate estimate, double theory);

#endif
