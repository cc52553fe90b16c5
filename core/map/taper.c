#include "core/map/taper.h"
#include "core/sum.h"

static const double PI = 3.14159265358979323846;
static const double TUKEY_SIDE = 0.1; /* share of the length that falls, at each end */

/* Returns the window at point i of n. */
static double weight_at(size_t i, size_t n, enum map_window window) {
    const double place = ((double)i + 0.5) / (double)n, side = fmin(place, 1 - place);
    const double width = window == MAP_WINDOW_HANN ? 0.5 : TUKEY_SIDE;
    if (n == 1 || window == MAP_WINDOW_NONE || side >= width)
        return 1;
    const double root = sin(PI / 2 * side / width);
    return root * root;
}

double map_taper(const struct grid *grid, double *z, enum map_window window) {
    struct sum heights = {0}, weights = {0}, squares = {0};
    for (size_t j = 0; j < grid->ny; j++) {
        const double row = weight_at(j, grid->ny, window);
        for (size_t i = 0; i < grid->nx; i++) {
            const double weight = row * weight_at(i, grid->nx, window);
            sum_add(&heights, weight * z[j * grid->nx + i]);
            sum_add(&weights, weight);
            sum_add(&squares, weight * weight);
        }
    }
    const double mean = sum_value(&heights) / sum_value(&weights);
    for (size_t j = 0; j < grid->ny; j++) {
        const double row = weight_at(j, grid->ny, window);
        for (size_t i = 0; i < grid->nx; i++)
            z[j * grid->nx + i] =
                row * weight_at(i, grid->nx, window) * (z[j * grid->nx + i] - mean);
    }
    return sum_value(&squares) / (double)grid_points(grid);
}
