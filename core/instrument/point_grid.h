/* Points in any order, as they lie on a regular grid along x and y: the grid is found from them. */
#ifndef RUGO_CORE_INSTRUMENT_POINT_GRID_H
#define RUGO_CORE_INSTRUMENT_POINT_GRID_H

#include "core/map/height_map.h"

/* How far a point may lie from its place, in steps of the grid. */
#define POINT_GRID_TOLERANCE 0.02
/* Places of a grid at most, for each point that there is. */
enum { POINT_GRID_PLACES = 16 };

/* Makes a map of n points, sets its grid and leaves its units; places without a point are holes, as
 * are those whose z is NaN. ERROR_INPUT where the points lie on no grid, two of them at one place,
 * or they fill less than a share of 1 / POINT_GRID_PLACES. *out is untouched on failure. */
int point_grid_map(struct height_map *out, const double *x, const double *y, const double *z,
                   size_t n, struct error *err);

#endif
