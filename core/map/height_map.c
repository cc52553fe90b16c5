#include "core/map/height_map.h"
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
