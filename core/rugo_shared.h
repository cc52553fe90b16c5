/* What the wrappers of rugo.h share: its plain structs as those of the library's own headers. */
#ifndef RUGO_CORE_RUGO_SHARED_H
#define RUGO_CORE_RUGO_SHARED_H

#include "core/rugo.h"
#include "core/surface/spectrum.h"

/* Gives a failure of the library to its caller; returns status. */
int error_give(int status, const struct error *from, struct rugo_error *to);
struct grid grid_of_rugo(const struct rugo_grid *grid);
/* Copies a grid and checks it. */
int grid_take(struct grid *out, const struct rugo_grid *grid, struct error *err);
void moments_give(const struct moments *from, struct rugo_moments *to);

#endif
