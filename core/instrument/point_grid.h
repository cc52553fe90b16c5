/* Maps from points in any order on a regular grid along x and y; the grid is found from the
 * points. */
#ifndef RUGO_CORE_INSTRUMENT_POINT_GRID_H
#define RUGO_CORE_INSTRUMENT_POINT_GRID_H

#include "core/map/height_map.h"

/* Largest distance of a measured point from its node, in steps of the grid. */
#define POINT_GRID_TOLERANCE 0.02

struct point_list { /* borrows */
    size_t n, stride;
    const double *of[3]; /* x, y and z of point p at p * stride */
    bool measured;       /* coordinates of one column differ, by POINT_GRID_TOLERANCE at most */
};

/* Sets the grid and the heights of a map, and leaves its units. Nodes without a point are holes, as
 * are those whose z is NaN. metres: in one unit of x and of y. ERROR_INPUT where the points lie on
 * no grid, two of them at one node, or they are too few for its nodes; map->z is NULL then. */
int point_grid_map(struct height_map *map, const struct point_list *points, const double metres[2],
                   struct error *err);

#endif
