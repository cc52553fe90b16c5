/* The form removed from a height map before it is measured: a polynomial fitted by least squares to
 * all heights that are not holes (NaN). FORMULAS.md, F18.1. */
#ifndef RUGO_CORE_MAP_DETREND_H
#define RUGO_CORE_MAP_DETREND_H

#include "core/rugo_lists.h"
#include "core/surface/grid.h"

#define DETREND_KIND(type, name, value) DETREND_##type,
enum detrend { DETREND_NONE, RUGO_TRENDS(DETREND_KIND) };
#undef DETREND_KIND
extern const char *const DETREND_NAMES[]; /* by the enum */

/* height + slope_x x + slope_y y + (bend_xx x^2 + 2 bend_xy x y + bend_yy y^2)/2, x and y counted
 * from the middle of the points, in the unit of the grid; 0 where not fitted. */
struct trend {
    double height, slope_x, slope_y, bend_xx, bend_xy, bend_yy;
};

/* Subtracts the trend from z in place; holes stay. ERROR_INPUT where the heights are too few, or
 * too nearly in line, to determine it; z is unchanged then. */
int detrend(const struct grid *grid, double *z, enum detrend kind, struct trend *out,
            struct error *err);

#endif
