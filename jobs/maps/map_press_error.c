#include "jobs/maps/map_press_error.h"
#include <math.h>
#include <stdlib.h>

enum { SIDE_LEAST = 16 };

static bool thins(size_t count, bool periodic) {
    return count >= SIDE_LEAST && !(periodic && count % 2 == 1);
}

/* Every second point of the map as it was measured, which is the first part of that pressed. */
static int thin(struct height_map *out, const struct map_press *press, const struct height_map *map,
                struct error *err) {
    const struct grid *grid = &press->map;
    bool profile = grid_is_profile(grid);
    size_t nx = (grid->nx + 1) / 2, ny = profile ? 1 : (grid->ny + 1) / 2;
    *out = (struct height_map){.grid = {nx, ny, 2 * grid_dx(grid) * (double)nx,
                                        profile ? grid->ly : 2 * grid_dy(grid) * (double)ny},
                               .z = array_create(nx * ny, sizeof *out->z)};
    if (out->z == NULL)
        return error_memory(err, nx * ny * sizeof *out->z, "every second point");
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++)
            out->z[j * nx + i] = map->z[2 * j * map->grid.nx + 2 * i];
    return 0;
}

static double area_of(const struct grid *grid) {
    return grid_is_profile(grid) ? grid->lx : grid->lx * grid->ly;
}

/* The factor from the unit of the coarse map to that of the map. */
static double unit_factor(const struct map_press *press, const struct map_press *coarse,
                          double wider, enum press_unit unit) {
    switch (unit) {
    case PRESS_SHARE:
        return wider;
    case PRESS_PRESSURE:
        return coarse->slope / press->slope;
    case PRESS_LENGTH:
        return coarse->height / press->height;
    case PRESS_NUMBER:
        break;
    }
    return 1;
}

static int press_thinned(const struct map_press *press, struct map_press *coarse, size_t loads,
                         const double *pressures, struct press_row *rows, struct error *err) {
    double wider = area_of(&coarse->map) / area_of(&press->map);
    int status = 0;
    for (size_t l = 0; l < loads && status == 0; l++) {
        struct press_row found;
        status = map_press_load(coarse, pressures[l] / wider, &found, err);
        for (size_t c = 0; c < PRESS_VALUES && status == 0; c++) {
            double factor = unit_factor(press, coarse, wider, PRESS_COLUMNS[c].unit);
            if (PRESS_COLUMNS[c].uncertain)
                rows[l].error[c] = fabs(found.value[c] * factor - rows[l].value[c]);
        }
    }
    return status;
}

int map_press_error(const struct map_press *press, const struct height_map *map,
                    const struct press_block *block, size_t loads, const double *pressures,
                    struct press_row *rows, struct error *err) {
    struct map_press coarse = {0};
    struct height_map thinned = {0};
    bool periodic = block->boundary == PRESS_PERIODIC;
    for (size_t l = 0; l < loads; l++)
        for (size_t value = 0; value < PRESS_VALUES; value++)
            rows[l].error[value] = NAN;
    if (!thins(press->map.nx, periodic) ||
        !(grid_is_profile(&press->map) || thins(press->map.ny, periodic)))
        return 0;
    int status = thin(&thinned, press, map, err);
    if (status == 0)
        status = map_press_begin(&coarse, &thinned, block, err);
    if (status == 0)
        status = press_thinned(press, &coarse, loads, pressures, rows, err);
    map_press_clear(&coarse);
    height_map_clear(&thinned);
    return status == ERROR_INPUT || status == ERROR_NUMERIC ? 0 : status;
}
