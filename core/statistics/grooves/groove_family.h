/* A family of grooves in a map: its heights, and its estimate beside the random part (FORMULAS.md,
 * F18.79). */
#ifndef RUGO_CORE_STATISTICS_GROOVES_GROOVE_FAMILY_H
#define RUGO_CORE_STATISTICS_GROOVES_GROOVE_FAMILY_H

#include "core/statistics/grooves/groove_shape.h"

/* Adds `times` the heights of all lines, and of what a named shape has beyond those that the grid
 * resolves, which its points fold back. jump: the share of its period within which a saw falls. */
void groove_family_add(const struct groove_lines *lines, const struct groove_shape_fit *fit,
                       const struct grid *grid, double times, double jump, double *z);

/* While a saw is estimated it falls within such a share, so that its heights change steadily with
 * its wave vector, as those of points beside a jump do not. */
#define GROOVE_JUMP 0.01

/* Moves lines and shape, which are nearly right, to their estimates, and fills their errors. left:
 * heights of the map without any family; changed to those without the new estimate, with that jump.
 * rest: of such heights, with that lay. ERROR_MEMORY. */
int groove_family_estimate(struct groove_lines *lines, struct groove_shape_fit *fit,
                           const struct grid *grid, const struct groove_background *rest,
                           const struct lay *lay, double *left, struct error *err);

#endif
