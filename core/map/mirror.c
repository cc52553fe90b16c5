#include "core/map/mirror.h"
#include <stdlib.h>

int height_map_mirror(struct height_map *map, struct error *err) {
    const struct grid *grid = &map->grid;
    size_t nx = grid->nx, ny = grid->ny, rows = grid_is_profile(grid) ? 1 : 2 * ny;
    struct height_map twice = {0};
    int status = height_map_shape(&twice, rows, 2 * nx, 1, err);
    if (status != 0)
        return error_context(err, "mirrored");
    twice.z = array_create(2 * nx * rows, sizeof *twice.z);
    if (twice.z == NULL)
        return error_memory(err, 2 * nx * rows * sizeof *twice.z, "a mirrored map");
    for (size_t j = 0; j < rows; j++)
        for (size_t i = 0; i < 2 * nx; i++) {
            size_t from_i = i < nx ? i : 2 * nx - 1 - i, from_j = j < ny ? j : 2 * ny - 1 - j;
            twice.z[j * 2 * nx + i] = map->z[from_j * nx + from_i];
        }
    free(map->z);
    map->z = twice.z;
    map->grid = (struct grid){2 * nx, rows, 2 * grid->lx, rows == 1 ? grid->ly : 2 * grid->ly};
    return 0;
}
