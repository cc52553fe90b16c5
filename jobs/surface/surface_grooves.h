/* The grooves of a machined face, /surface/grooves/...: read, and fitted to the periodic cell. */
#ifndef RUGO_JOBS_SURFACE_SURFACE_GROOVES_H
#define RUGO_JOBS_SURFACE_SURFACE_GROOVES_H

#include "core/surface/grooves/grooves.h"
#include "schema/study/values.h"

/* Makes the grooves that the values have on a grid, with faults where they do not fit it. *out,
 * NULL before, is the caller's to free, and NULL where there are none. translated: the random part
 * is so, which is a fault. ERROR_MEMORY alone. */
int surface_grooves_read(struct grooves **out, const struct grid *grid, bool translated,
                         struct values *values, struct error *err);

#endif
