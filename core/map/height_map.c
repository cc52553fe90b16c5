#include "core/map/height_map.h"
#include <math.h>
#include <stdlib.h>

void height_map_clear(struct height_map *map) {
    free(map->z);
    *map = (struct height_map){0};
}

int height_map_shape(struct height_map *map, size_t ny, size_t nx, double dx, struct error *err) {
    const size_t most = (size_t)1 << 31;
    if (nx < 2 || ny < 1 || nx > most || ny > most / nx)
        return error_set(err, ERROR_INPUT,
                         "a map of %zu rows of %zu points: at least 2 points a row and at most "
                         "2^31 in all are read",
                         ny, nx);
    map->grid = (struct grid){nx, ny, dx * (double)nx, dx * (double)ny};
    return grid_check(&map->grid, err);
}

size_t height_map_holes(const struct height_map *map) {
    size_t holes = 0;
    for (size_t point = 0; point < grid_points(&map->grid); point++)
        holes += isnan(map->z[point]) ? 1 : 0;
    return holes;
}

int height_map_check_whole(const struct height_map *map, struct error *err) {
    size_t points = grid_points(&map->grid), first = 0;
    while (first < points && !isnan(map->z[first]))
        first++;
    if (first == points)
        return 0;
    return error_set(
        err, ERROR_INPUT,
        "%zu of %zu heights are holes (NaN), the first in row %zu, column %zu, counted "
        "from 1; all heights are needed here",
        height_map_holes(map), points, first / map->grid.nx + 1, first % map->grid.nx + 1);
}
