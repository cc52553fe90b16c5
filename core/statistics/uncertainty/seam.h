/* The seam of a map: where its last points would be followed by its first ones, did it repeat. */
#ifndef RUGO_CORE_STATISTICS_UNCERTAINTY_SEAM_H
#define RUGO_CORE_STATISTICS_UNCERTAINTY_SEAM_H

#include "core/surface/grid.h"
#include <stdbool.h>

/* How rough the seams are, across x and across y, over the roughest position inside (FORMULAS.md,
 * F18.3). Infinite where nothing can be compared: fewer than SEAM_POINTS points, holes along the
 * seam, a flat inside with a step at the seam; 0 for a flat map, and across y for a profile. */
struct seam {
    double x, y;
};
/* In maps that repeat the seam may be the roughest position, but hardly by as much as this. */
#define SEAM_LIMIT 1.2
static inline bool seam_is_rough(const struct seam *seam) {
    return !(seam->x <= SEAM_LIMIT && seam->y <= SEAM_LIMIT);
}
enum { SEAM_POINTS = 9 };
/* ERROR_MEMORY alone. */
int seam_measure(const struct grid *grid, const double *z, struct seam *out, struct error *err);

#endif
