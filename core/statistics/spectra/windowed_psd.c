#include "core/statistics/spectra/windowed_psd.h"
#include "core/statistics/heights/roughness.h"
#include <stdlib.h>
#include <string.h>

/* Returns the mean of the neighbours of a hole that have heights; NaN where none has. */
static double neighbours_mean(const struct measured_map *map, long i, long j) {
    struct average mean = {0};
    for (long y = j - 1; y <= j + 1; y++)
        for (long x = i - 1; x <= i + 1; x++)
            average_add(&mean, map_height(map, x, y));
    return average_value(&mean);
}

/* Fills the holes beside heights; returns how many are left. The list, of all holes, is the
 * caller's; their heights are set behind the search, so that the order of points does not matter.
 */
static size_t holes_shrink(const struct grid *grid, double *z, size_t *holes, size_t count,
                           double *heights) {
    const struct measured_map map = {grid, z, BOUNDARY_OPEN};
    size_t left = 0;
    for (size_t h = 0; h < count; h++)
        heights[h] =
            neighbours_mean(&map, (long)(holes[h] % grid->nx), (long)(holes[h] / grid->nx));
    for (size_t h = 0; h < count; h++) {
        z[holes[h]] = heights[h];
        if (isnan(heights[h]))
            holes[left++] = holes[h];
    }
    return left;
}

static int holes_fill(const struct grid *grid, double *z, struct error *err) {
    size_t count = 0, points = grid_points(grid);
    for (size_t point = 0; point < points; point++)
        count += isnan(z[point]) ? 1 : 0;
    if (count == 0)
        return 0;
    if (count == points)
        return error_set(err, ERROR_INPUT, "the map has no heights, only holes");
    size_t *holes = array_create(count, sizeof *holes);
    double *heights = array_create(count, sizeof *heights);
    int status = holes != NULL && heights != NULL
                     ? 0
                     : error_memory(err, count * sizeof *heights, "holes of a map");
    for (size_t point = 0, h = 0; point < points && status == 0; point++)
        if (isnan(z[point]))
            holes[h++] = point;
    while (status == 0 && count > 0)
        count = holes_shrink(grid, z, holes, count, heights);
    free(holes);
    free(heights);
    return status;
}

double hann_window(size_t i, size_t n) {
    double sine = sin(M_PI * ((double)i + 0.5) / (double)n);
    return n == 1 ? 1 : sine * sine;
}

/* Multiplies heights about their mean under the window by it; returns its mean square. along: the
 * window over x, nx. */
static double window_apply(const struct grid *grid, const double *along, double *z) {
    struct sum total = {0}, heights = {0}, squares = {0};
    for (int pass = 0; pass < 2; pass++)
        for (size_t j = 0; j < grid->ny; j++) {
            double across = hann_window(j, grid->ny);
            for (size_t i = 0; i < grid->nx; i++) {
                double weight = across * along[i], *at = &z[j * grid->nx + i];
                if (pass == 1) {
                    *at = weight * (*at - sum_value(&heights) / sum_value(&total));
                    continue;
                }
                sum_add(&total, weight);
                sum_add(&heights, weight * *at);
                sum_add(&squares, weight * weight);
            }
        }
    return sum_value(&squares) / (double)grid_points(grid);
}

int windowed_heights(const struct measured_map *map, double *z, double *power, struct error *err) {
    memcpy(z, map->z, grid_points(map->grid) * sizeof *z);
    size_t nx = map->grid->nx;
    double *along = array_create(nx, sizeof *along);
    if (along == NULL)
        return error_memory(err, nx * sizeof *along, "a window");
    for (size_t i = 0; i < nx; i++)
        along[i] = hann_window(i, nx);
    int status = holes_fill(map->grid, z, err);
    if (status == 0)
        *power = window_apply(map->grid, along, z);
    free(along);
    return status;
}

int windowed_psd_measure(const struct measured_map *map, double *wave_number, double *density,
                         struct error *err) {
    const struct grid *grid = map->grid;
    size_t points = grid_points(grid), bins = radial_bins(grid);
    double power = 1, *z = array_create(points, sizeof *z);
    if (z == NULL)
        return error_memory(err, points * sizeof *z, "a map under a window");
    int status = windowed_heights(map, z, &power, err);
    if (status == 0)
        status = psd_measure(grid, z, wave_number, density, err);
    for (size_t r = 0; r < bins && status == 0; r++)
        density[r] /= power;
    free(z);
    return status;
}
