/* A height map: heights on a grid. */
#ifndef RUGO_CORE_MAP_HEIGHT_MAP_H
#define RUGO_CORE_MAP_HEIGHT_MAP_H

#include "core/surface/grid.h"

/* Points at most: 2^31; at least 2 along x. */
struct height_map {
    struct grid grid; /* spacing from the file (xyz) or from dx */
    double *z;        /* owned, grid_points */
};
void height_map_clear(struct height_map *map);

/* Checks the counts and sets the grid of a map with spacing dx. */
int height_map_shape(struct height_map *map, size_t ny, size_t nx, double dx, struct error *err);

#endif
