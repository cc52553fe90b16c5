/* A height map: heights on a grid. */
#ifndef RUGO_CORE_MAP_HEIGHT_MAP_H
#define RUGO_CORE_MAP_HEIGHT_MAP_H

#include "core/surface/grid.h"

/* Points at most: 2^31; at least 2 along x. */
struct height_map {
    struct grid grid; /* spacing from the file (xyz) or from dx */
    double *z;        /* owned, grid_points; NaN: a hole, where nothing was measured */
    /* Units of x and y, and of z: "m" where the file tells a length, which is in metres then; ""
     * where it tells none; else what the file says, of layers that hold no heights ("V"). */
    char xy_unit[16], z_unit[16];
};
void height_map_clear(struct height_map *map);

/* Returns how many heights are holes. */
size_t height_map_holes(const struct height_map *map);
/* ERROR_INPUT with the number and the first of the holes where there are any: for callers that need
 * all heights. */
int height_map_check_whole(const struct height_map *map, struct error *err);

/* Checks the counts and sets the grid of a map with spacing dx. */
int height_map_shape(struct height_map *map, size_t ny, size_t nx, double dx, struct error *err);

#endif
