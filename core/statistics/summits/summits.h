/* Summits of surfaces, peaks of profiles, on periodic grids.
 *
 * A grid summit is strictly higher than its 8 (nine-point) or 4 (five-point) neighbours, in
 * profiles than its 2: a plateau holds none. A refined summit is a true maximum (zero gradient,
 * negative definite Hessian) of the band-limited surface through the grid, found between the
 * points; or of the surface that is translated from a band-limited field through the grid. */
#ifndef RUGO_CORE_STATISTICS_SUMMITS_SUMMITS_H
#define RUGO_CORE_STATISTICS_SUMMITS_SUMMITS_H

#include "core/rugo_lists.h"
#include "core/statistics/summits/summit_list.h"
#include "core/surface/grid.h"
#include "core/surface/translation/height_function.h"

#define SUMMIT_STENCIL(type, name, value) SUMMITS_##type,
enum summit_stencil { RUGO_SUMMIT_RULES(SUMMIT_STENCIL) };
#undef SUMMIT_STENCIL
enum summit_curvature { CURVATURE_FINITE_DIFFERENCE, CURVATURE_SPECTRAL };

struct summit_finder;
/* Workspace, made once a case. mode_x, mode_y bound the band of the surfaces to come (spectral
 * curvature and refined summits use it; pass nx/2, ny/2 when unknown). Refined summits always have
 * exact curvatures. */
int summit_finder_create(struct summit_finder **out, const struct grid *grid,
                         enum summit_stencil stencil, enum summit_curvature curvature,
                         size_t mode_x, size_t mode_y, struct error *err);
void summit_finder_destroy(struct summit_finder **finder);
/* Whether summits and their curvatures need more than the points of the grid: a band. */
static inline bool summit_needs_band(enum summit_stencil stencil, enum summit_curvature curvature) {
    return stencil == SUMMITS_REFINED || curvature == CURVATURE_SPECTRAL;
}
/* Says that surfaces to come are translated, z = height f(g), from a Gaussian field g of the
 * finder's band (FORMULAS.md, F5.8). Refined summits are then those of g, and spectral curvatures
 * follow from derivatives of g (F6.13); others need no such call. Borrows f. ERROR_MEMORY. */
int summit_finder_translate(struct summit_finder *finder, const struct height_function *function,
                            double height, struct error *err);
/* Sets g on the points of the surface that a translated finder looks at next. Borrows it. */
void summit_finder_gaussian(struct summit_finder *finder, const double *gaussian);
/* translated: with what that takes. */
double summit_finder_bytes(const struct grid *grid, enum summit_stencil stencil,
                           enum summit_curvature curvature, size_t mode_x, size_t mode_y,
                           bool translated);
/* Replaces the contents of list by the summits of z, in row order. */
int summits_find(struct summit_finder *finder, const double *z, struct summit_list *list,
                 struct error *err);
/* Does the same with the pits of z, as the summits of the mirrored surface -z that they are. */
int pits_find(struct summit_finder *finder, const double *z, struct summit_list *list,
              struct error *err);
/* Appends the summits and the pits of rows first .. first + count - 1, those of the two above in
 * one look at each point. Lists are empty for row 0, with which refined ones are all found; rows
 * rise from call to call. */
int extremes_find(struct summit_finder *finder, const double *z, size_t first, size_t count,
                  struct summit_list *summits, struct summit_list *pits, struct error *err);

#endif
