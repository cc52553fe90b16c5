/* The seam of a map: where its last points would be followed by its first ones, did it repeat. */
#ifndef RUGO_CORE_STATISTICS_SEAM_H
#define RUGO_CORE_STATISTICS_SEAM_H

#include "core/surface/grid.h"

/* How rough the seams are, across x and across y, over the roughest place inside (FORMULAS.md,
 * F18.3): above 1 the map does not repeat. Infinite where nothing can be compared: fewer than
 * SEAM_POINTS points, holes along the seam, a flat inside with a step at the seam; 0 for a flat
 * map, and across y for a profile. */
struct seam {
    double x, y;
};
enum { SEAM_POINTS = 9 };
/* ERROR_MEMORY alone. */
int seam_measure(const struct grid *grid, const double *z, struct seam *out, struct error *err);

#endif
