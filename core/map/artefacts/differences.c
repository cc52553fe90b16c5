#include "core/map/artefacts/differences.h"
#include "core/statistics/measured_map.h"
#include <math.h>

static void axis_measure(const struct grid *grid, const double *z, int axis,
                         struct differences *out) {
    const size_t stride = axis == 0 ? 1 : grid->nx;
    const size_t columns = grid->nx - (axis == 0 ? 1 : 0), rows = grid->ny - (axis == 0 ? 0 : 1);
    struct average mean = {0}, square = {0}, second = {0};
    for (size_t j = 0; j < rows; j++)
        for (size_t i = 0; i < columns; i++) {
            const double *at = z + j * grid->nx + i, step = at[stride] - at[0];
            average_add(&mean, step);
            average_add(&square, step * step);
            if ((axis == 0 ? i : j) > 0) {
                const double bend = second_difference(at, stride);
                average_add(&second, bend * bend);
            }
        }
    out->mean = average_value(&mean);
    out->first = fmax(average_value(&square) - out->mean * out->mean, 0);
    out->second = average_value(&second);
}

void map_differences_measure(const struct grid *grid, const double *z,
                             struct map_differences *out) {
    static const struct differences NONE = {(double)NAN, (double)NAN, (double)NAN};
    struct average height = {0}, square = {0};
    double base = 0; /* a height, which keeps squares free of a large mean */
    *out = (struct map_differences){.axis = {NONE, NONE}};
    for (size_t point = 0; point < grid_points(grid); point++) {
        if (isnan(z[point]))
            continue;
        base = height.count == 0 ? z[point] : base;
        average_add(&height, z[point] - base);
        average_add(&square, (z[point] - base) * (z[point] - base));
        out->highest = fmax(out->highest, fabs(z[point]));
    }
    const double mean = average_value(&height);
    out->rms_height = sqrt(fmax(average_value(&square) - mean * mean, 0));
    axis_measure(grid, z, 0, &out->axis[0]);
    if (!grid_is_profile(grid))
        axis_measure(grid, z, 1, &out->axis[1]);
}

double differences_square(const struct grid *grid, const double first[2]) {
    const double dx = grid_dx(grid), along_x = first[0] / (dx * dx);
    if (grid_is_profile(grid))
        return along_x;
    return along_x + first[1] / (grid_dy(grid) * grid_dy(grid));
}
