/* Functions that the wrappers of rugo.h share: they convert its plain structs to those of the
 * library's own headers. */
#ifndef RUGO_CORE_RUGO_SHARED_H
#define RUGO_CORE_RUGO_SHARED_H

#include "core/rugo.h"
#include "core/statistics/heights/roughness.h"
#include "core/statistics/summits/summits.h"
#include "core/surface/spectrum.h"

/* Copies a failure of the library to its caller's error; returns status. */
int error_give(int status, const struct error *from, struct rugo_error *to);
struct grid grid_of_rugo(const struct rugo_grid *grid);
/* Copies a grid and checks it. */
int grid_take(struct grid *out, const struct rugo_grid *grid, struct error *err);
void moments_give(const struct moments *from, struct rugo_moments *to);
void roughness_give(const struct roughness *from, struct rugo_roughness *to);
/* Fails for an unknown rule. */
int stencil_take(enum summit_stencil *out, enum rugo_summit_rule rule, struct error *err);
/* Copies a list, for the caller of the library to clear. */
int summits_give(const struct summit_list *list, struct rugo_summits *out, struct error *err);

#endif
