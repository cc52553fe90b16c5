/* Form taken out of a height map before it is measured: a polynomial fitted by least squares over
 * all heights that are not holes (NaN). FORMULAS.md, F18.1. */
#ifndef RUGO_CORE_MAP_DETREND_H
#define RUGO_CORE_MAP_DETREND_H

#include "core/surface/grid.h"

enum detrend { DETREND_NONE, DETREND_MEAN, DETREND_PLANE, DETREND_QUADRATIC };

/* height + slope_x x + slope_y y + (bend_xx x^2 + 2 bend_xy x y + bend_yy y^2)/2, x and y counted
 * from the middle of the points, in the unit of the grid; 0 where not fitted. */
struct trend {
    double height, slope_x, slope_y, bend_xx, bend_xy, bend_yy;
};

/* Takes the trend out of z in place; holes stay. ERROR_INPUT where the heights are too few, or too
 * much in line, to tell it; z is as it was then. */
int detrend(const struct grid *grid, double *z, enum detrend kind, struct trend *out,
            struct error *err);

#endif
