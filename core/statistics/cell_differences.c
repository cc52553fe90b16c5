#include "core/statistics/cell_differences.h"
#include <math.h>

enum { POINTS_A_LAG = 4 };

/* The lag in points, the distances that it is, and how far apart the points are that are taken. */
struct lag {
    long x, y, every_x, every_y;
    double length_x, length_y;
};

static struct lag lag_make(const struct grid *grid, size_t points) {
    bool profile = grid_is_profile(grid);
    double ratio = profile ? 0 : grid_dx(grid) / grid_dy(grid);
    struct lag lag = {.x = (long)points, .y = lround((double)points * ratio)};
    lag.y = profile ? 0 : lag.y > 1 ? lag.y : 1;
    lag.every_x = lag.x > POINTS_A_LAG ? lag.x / POINTS_A_LAG : 1;
    lag.every_y = lag.y > POINTS_A_LAG ? lag.y / POINTS_A_LAG : 1;
    lag.length_x = (double)lag.x * grid_dx(grid);
    lag.length_y = profile ? 1 : (double)lag.y * grid_dy(grid);
    return lag;
}

/* Rows of heights, NULL beside an open map. */
struct rows {
    const double *middle, *up, *down;
};

static const double *row_at(const struct measured_map *map, long j) {
    long ny = (long)map->grid->ny;
    bool inside = j >= 0 && j < ny;
    if (!inside && map->boundary == BOUNDARY_OPEN)
        return NULL;
    return map->z + (size_t)((j % ny + ny) % ny) * map->grid->nx;
}

/* left, right: columns a lag before and behind column i. */
static void point_add(const struct rows *rows, size_t i, size_t left, size_t right,
                      const struct lag *lag, size_t cell, struct cell_differences *out) {
    double z = rows->middle[i], ahead = rows->middle[right];
    double slope_x = (ahead - z) / lag->length_x;
    double bend_x = (ahead - 2 * z + rows->middle[left]) / (lag->length_x * lag->length_x);
    double slope_y = 0, bend_y = 0, x = slope_x, y = 0;
    if (lag->y > 0) {
        double down = rows->down[i], corner = rows->down[right];
        slope_y = (down - z) / lag->length_y;
        bend_y = (down - 2 * z + rows->up[i]) / (lag->length_y * lag->length_y);
        x = (ahead - z + corner - down) / (2 * lag->length_x);
        y = (down - z + corner - ahead) / (2 * lag->length_y);
    }
    if (isnan(bend_x + bend_y + x + y))
        return;
    double slope = slope_x * slope_x + slope_y * slope_y;
    double curvature = lag->y > 0 ? (bend_x + bend_y) / 2 : bend_x;
    out->count[cell]++;
    out->slope[cell] += slope;
    out->bend[cell] += bend_x * bend_x + bend_y * bend_y;
    out->curvature[cell] += curvature * curvature;
    out->area[cell] += sqrt(1 + slope);
    out->gradient[cell] += x * x + y * y;
    out->along[cell] += x * x - y * y;
    out->across[cell] += 2 * x * y;
}

static void row_add(const struct measured_map *map, const struct low_modes *modes,
                    const struct rows *rows, size_t first_cell, const struct lag *lag,
                    struct cell_differences *out) {
    bool open = map->boundary == BOUNDARY_OPEN;
    long nx = (long)map->grid->nx;
    long begin = open ? lag->x : 0, end = open ? nx - lag->x : nx;
    begin = (begin + lag->every_x - 1) / lag->every_x * lag->every_x;
    size_t cell = 0, next = cell_begin(1, modes->cells_x, (size_t)nx);
    for (long i = begin; i < end; i += lag->every_x) {
        while ((size_t)i >= next)
            next = cell_begin(++cell + 1, modes->cells_x, (size_t)nx);
        long left = i - lag->x, right = i + lag->x;
        point_add(rows, (size_t)i, (size_t)(left < 0 ? left + nx : left),
                  (size_t)(right >= nx ? right - nx : right), lag, first_cell + cell, out);
    }
}

void cell_differences_measure(const struct measured_map *map, const struct low_modes *modes,
                              size_t lag, struct cell_differences *out) {
    const struct lag steps = lag_make(map->grid, lag);
    *out = (struct cell_differences){0};
    if (lag >= map->grid->nx)
        return;
    for (long j = 0; j < (long)map->grid->ny; j += steps.every_y) {
        struct rows rows = {row_at(map, j), row_at(map, j - steps.y), row_at(map, j + steps.y)};
        size_t cell = cell_of((size_t)j, modes->cells_y, map->grid->ny) * modes->cells_x;
        if (rows.up != NULL && rows.down != NULL)
            row_add(map, modes, &rows, cell, &steps, out);
    }
}
