#include "core/map/height_map.h"
#include <math.h>
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

void height_map_reverse_rows(struct height_map *map) {
    const size_t nx = map->grid.nx, ny = map->grid.ny;
    for (size_t j = 0; j < ny / 2; j++)
        for (size_t i = 0; i < nx; i++) {
            double *low = &map->z[j * nx + i], *high = &map->z[(ny - 1 - j) * nx + i], kept = *low;
            *low = *high;
            *high = kept;
        }
}

const char *height_map_unit_note(const struct height_map *map) {
    if (*map->xy_unit == '\0' && *map->z_unit == '\0')
        return "units: the file names none; --dx 0.5um and --z-unit nm (or others) say what x, y "
               "and heights are in";
    if (*map->xy_unit == '\0')
        return "units: the file names none of x and y; --dx 0.5um (or another) says it";
    if (*map->z_unit == '\0')
        return "units: the file names none of heights; --z-unit nm (or another) says it";
    return NULL;
}

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

static size_t holes_count(const struct grid *grid, const double *z) {
    size_t holes = 0;
    for (size_t point = 0; point < grid_points(grid); point++)
        holes += isnan(z[point]) ? 1 : 0;
    return holes;
}

size_t height_map_holes(const struct height_map *map) {
    return holes_count(&map->grid, map->z);
}

int heights_check_whole(const struct grid *grid, const double *z, struct error *err) {
    size_t points = grid_points(grid), first = 0;
    while (first < points && !isnan(z[first]))
        first++;
    if (first == points)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "%zu of %zu heights are holes (NaN), the first in row %zu, column %zu, "
                     "counted from 1; all heights are needed here",
                     holes_count(grid, z), points, first / grid->nx + 1, first % grid->nx + 1);
}

int height_map_check_whole(const struct height_map *map, struct error *err) {
    return heights_check_whole(&map->grid, map->z, err);
}
