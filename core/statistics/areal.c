#include "core/statistics/areal.h"
#include "core/statistics/hills.h"
#include "core/statistics/open_roughness.h"

static const double CORRELATION_LEVEL = 0.2, PRUNED_SHARE = 0.05; /* the standard's defaults */

static double mean_size(const struct measured_map *map, double mean) {
    struct average size = {0};
    for (size_t point = 0; point < grid_points(map->grid); point++)
        average_add(&size, fabs(map->z[point] - mean));
    return average_value(&size);
}

/* Returns sqrt(1 + x^2 + y^2) - 1. */
static double stretch(double x, double y) {
    double square = x * x + y * y;
    return square / (sqrt(1 + square) + 1);
}

/* Of each cell of four points the mean over its corners, whose triangles have these slopes. */
static double developed_area(const struct measured_map *map) {
    const struct grid *grid = map->grid;
    double dx = grid_dx(grid), dy = grid_dy(grid);
    struct average area = {0};
    for (long j = 0; j < (long)grid->ny; j++)
        for (long i = 0; i < (long)grid->nx; i++) {
            double a = map_height(map, i, j), b = map_height(map, i + 1, j);
            double c = map_height(map, i, j + 1), d = map_height(map, i + 1, j + 1);
            double x0 = (b - a) / dx, x1 = (d - c) / dx, y0 = (c - a) / dy, y1 = (d - b) / dy;
            average_add(
                &area, (stretch(x0, y0) + stretch(x0, y1) + stretch(x1, y0) + stretch(x1, y1)) / 4);
        }
    return average_value(&area);
}

int areal_measure(const struct measured_map *map, const struct correlation *correlation,
                  struct summit_list *list, struct areal *out, struct error *err) {
    struct roughness roughness;
    struct hills hills;
    double shortest, longest;
    open_roughness_measure(map, &roughness);
    double highest = roughness.highest - roughness.mean, lowest = roughness.mean - roughness.lowest;
    int status = hills_find(map, PRUNED_SHARE * (highest + lowest), list, &hills, err);
    if (status != 0)
        return status;
    correlation_lengths(correlation, CORRELATION_LEVEL, &shortest, &longest);
    *out = (struct areal){.sa = mean_size(map, roughness.mean),
                          .sq = roughness.rms_height,
                          .ssk = roughness.skewness,
                          .sku = roughness.kurtosis,
                          .sp = highest,
                          .sv = lowest,
                          .sz = highest + lowest,
                          .sdq = roughness.rms_slope,
                          .sdr = developed_area(map),
                          .sal = shortest,
                          .str = shortest / longest,
                          .spd = hills.density,
                          .spc = hills.curvature};
    return 0;
}
