#include "core/map/crop.h"
#include <stdlib.h>
#include <string.h>

int map_crop(struct height_map *map, size_t x, size_t y, size_t width, size_t height,
             struct error *err) {
    struct grid *grid = &map->grid;
    if (width < 2 || height < 1 || width > grid->nx || x > grid->nx - width || height > grid->ny ||
        y > grid->ny - height)
        return error_set(
            err, ERROR_INPUT,
            "columns from %zu and rows from %zu, %zu by %zu points, of a map of %zu by "
            "%zu; allowed: at least 2 by 1, within the map",
            x, y, width, height, grid->nx, grid->ny);
    double dx = grid_dx(grid), dy = grid_dy(grid);
    for (size_t j = 0; j < height; j++)
        memmove(map->z + j * width, map->z + (y + j) * grid->nx + x, width * sizeof *map->z);
    double *less = realloc(map->z, width * height * sizeof *map->z);
    map->z = less != NULL ? less : map->z;
    *grid = (struct grid){width, height, dx * (double)width, dy * (double)height};
    return 0;
}
