#include "core/map/artefacts/differences.h"
#include "core/statistics/lanes.h"
#include "core/statistics/measured_map.h"
#include "core/vectors.h"
#include <math.h>

/* Adds n steps to the next height, and their squares. */
WIDE_VECTORS static void steps_add(const double *restrict z, size_t stride, size_t n,
                                   struct lanes *restrict mean, struct lanes *restrict square) {
    const double *next = z + stride;
    for (size_t l = 0; l < n; l++) {
        double step = next[l] - z[l];
        lane_add(mean, l, step);
        lane_add(square, l, step * step);
    }
}

WIDE_VECTORS static void bends_add(const double *restrict z, size_t stride, size_t n,
                                   struct lanes *restrict second) {
    const double *before = z - stride, *next = z + stride;
    for (size_t l = 0; l < n; l++) {
        double bend = next[l] - z[l] - (z[l] - before[l]);
        lane_add(second, l, bend * bend);
    }
}

WIDE_VECTORS static void heights_add(const double *restrict z, double base, size_t n,
                                     struct lanes *restrict mean, struct lanes *restrict square) {
    for (size_t l = 0; l < n; l++) {
        double height = z[l] - base;
        lane_add(mean, l, height);
        lane_add(square, l, height * height);
    }
}

static size_t together(size_t left) {
    return left < LANES ? left : LANES;
}

static void axis_measure(const struct grid *grid, const double *z, int axis,
                         struct differences *out) {
    const size_t stride = axis == 0 ? 1 : grid->nx;
    const size_t columns = grid->nx - (axis == 0 ? 1 : 0), rows = grid->ny - (axis == 0 ? 0 : 1);
    struct lane_mean mean = {0}, square = {0}, second = {0};
    struct lanes step = {0}, squared = {0}, bend = {0};
    for (size_t j = 0; j < rows; j++) {
        const double *row = z + j * grid->nx;
        for (size_t i = 0; i < columns; i += LANES)
            steps_add(row + i, stride, together(columns - i), &step, &squared);
        for (size_t i = axis == 0 ? 1 : 0; i < columns && (axis == 0 || j > 0); i += LANES)
            bends_add(row + i, stride, together(columns - i), &bend);
        lane_mean_add(&mean, &step);
        lane_mean_add(&square, &squared);
        lane_mean_add(&second, &bend);
    }
    out->mean = lane_mean_value(&mean);
    out->first = fmax(lane_mean_value(&square) - out->mean * out->mean, 0);
    out->second = lane_mean_value(&second);
}

/* Returns a height, which keeps squares free of a large mean; NaN: there is none. */
static double first_height(size_t points, const double *z) {
    size_t point = 0;
    while (point < points && isnan(z[point]))
        point++;
    return point < points ? z[point] : (double)NAN;
}

void map_differences_measure(const struct grid *grid, const double *z,
                             struct map_differences *out) {
    static const struct differences NONE = {(double)NAN, (double)NAN, (double)NAN};
    const size_t points = grid_points(grid);
    const double base = first_height(points, z);
    struct lane_mean height = {0}, square = {0};
    struct lanes heights = {0}, squares = {0};
    *out = (struct map_differences){.axis = {NONE, NONE}};
    for (size_t point = 0; point < points; point += LANES) {
        heights_add(z + point, base, together(points - point), &heights, &squares);
        if (point % grid->nx < LANES) { /* about once a row */
            lane_mean_add(&height, &heights);
            lane_mean_add(&square, &squares);
        }
    }
    lane_mean_add(&height, &heights);
    lane_mean_add(&square, &squares);
    for (size_t point = 0; point < points; point++)
        out->highest = fabs(z[point]) > out->highest ? fabs(z[point]) : out->highest;
    const double mean = lane_mean_value(&height);
    out->rms_height = sqrt(fmax(lane_mean_value(&square) - mean * mean, 0));
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
