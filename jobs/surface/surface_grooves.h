/* The grooves of a machined face, /surface/grooves/...: read, and fitted to the periodic cell. */
#ifndef RUGO_JOBS_SURFACE_SURFACE_GROOVES_H
#define RUGO_JOBS_SURFACE_SURFACE_GROOVES_H

#include "jobs/surface/surface_case.h"

/* Adds the grooves that the values have to a surface whose grid is known, with faults where they do
 * not fit it. ERROR_MEMORY alone. */
int surface_grooves_fill(struct surface_case *out, struct values *values, struct error *err);

#endif
