#include "core/statistics/heights/areal.h"
#include "core/statistics/lanes.h"
#include "core/statistics/summits/hills.h"
#include "core/vectors.h"
#include <stdlib.h>

static const double CORRELATION_LEVEL = 0.2, PRUNED_SHARE = 0.05; /* the standard's defaults */

static double mean_size(const struct measured_map *map, double mean) {
    struct average size = {0};
    for (size_t point = 0; point < grid_points(map->grid); point++)
        average_add(&size, fabs(map->z[point] - mean));
    return average_value(&size);
}

/* Returns sqrt(1 + x^2 + y^2) - 1. */
static inline double stretch(double x, double y) {
    double square = x * x + y * y;
    return square / (sqrt(1 + square) + 1);
}

/* Adds n cells of four points, a and b = a + 1 above c and d, whose triangles have these slopes: of
 * each the mean over its corners. */
WIDE_VECTORS static void areas_add(size_t n, const double *a, const double *b, const double *c,
                                   const double *d, double dx, double dy,
                                   struct lanes *restrict lanes) {
    for (size_t l = 0; l < n; l++) {
        double x0 = (b[l] - a[l]) / dx, x1 = (d[l] - c[l]) / dx;
        double y0 = (c[l] - a[l]) / dy, y1 = (d[l] - b[l]) / dy;
        lane_add(lanes, l,
                 (stretch(x0, y0) + stretch(x0, y1) + stretch(x1, y0) + stretch(x1, y1)) / 4);
    }
}

static double developed_area(const struct measured_map *map) {
    const size_t nx = map->grid->nx, ny = map->grid->ny;
    const bool open = map->boundary == BOUNDARY_OPEN;
    double dx = grid_dx(map->grid), dy = grid_dy(map->grid);
    struct lanes lanes = {0};
    struct lane_mean area = {0};
    for (size_t j = 0; j < (open ? ny - 1 : ny); j++) {
        const double *row = map->z + j * nx, *down = map->z + (j + 1 < ny ? j + 1 : 0) * nx;
        for (size_t i = 0; i + 1 < nx; i += LANES)
            areas_add(nx - 1 - i < LANES ? nx - 1 - i : LANES, row + i, row + i + 1, down + i,
                      down + i + 1, dx, dy, &lanes);
        if (!open)
            areas_add(1, row + nx - 1, row, down + nx - 1, down, dx, dy, &lanes);
        lane_mean_add(&area, &lanes);
    }
    return lane_mean_value(&area);
}

void areal_measure_heights(const struct measured_map *map, const struct roughness *roughness,
                           const struct correlation *correlation, struct areal *out) {
    double shortest, longest;
    double highest = roughness->highest - roughness->mean;
    double lowest = roughness->mean - roughness->lowest;
    correlation_lengths(correlation, CORRELATION_LEVEL, &shortest, &longest);
    *out = (struct areal){.sa = mean_size(map, roughness->mean),
                          .sq = roughness->rms_height,
                          .ssk = roughness->skewness,
                          .sku = roughness->kurtosis,
                          .sp = highest,
                          .sv = lowest,
                          .sz = highest + lowest,
                          .sdq = roughness->rms_slope,
                          .sdr = developed_area(map),
                          .sal = shortest,
                          .str = shortest / longest,
                          .spd = (double)NAN,
                          .spc = (double)NAN};
}

int areal_measure(const struct measured_map *map, const struct roughness *roughness,
                  const struct correlation *correlation, struct summit_list *list,
                  struct areal *out, struct error *err) {
    struct hills hills;
    areal_measure_heights(map, roughness, correlation, out);
    int status = hills_find(map, PRUNED_SHARE * out->sz, list, &hills, err);
    if (status != 0)
        return status;
    out->spd = hills.density;
    out->spc = hills.curvature;
    return 0;
}
