#include "core/statistics/open_roughness.h"

struct powers {
    struct average second, third, fourth;  /* of heights about the mean */
    struct average slope_x, slope_y;       /* squares of forward differences */
    struct average bend_x, bend_y, either; /* squares of second ones, and of their sum */
};

static void heights_measure(const struct measured_map *map, struct roughness *out) {
    struct average mean = {0};
    out->lowest = INFINITY;
    out->highest = -INFINITY;
    for (size_t point = 0; point < grid_points(map->grid); point++) {
        double z = map->z[point];
        average_add(&mean, z);
        out->lowest = z < out->lowest ? z : out->lowest;
        out->highest = z > out->highest ? z : out->highest;
    }
    out->mean = average_value(&mean);
}

/* Adds point i, j; dx and dy are the spacings. */
static void point_add(const struct measured_map *map, long i, long j, double mean, double dx,
                      double dy, struct powers *powers) {
    double z = map_height(map, i, j), h = z - mean;
    double right = map_height(map, i + 1, j), left = map_height(map, i - 1, j);
    average_add(&powers->second, h * h);
    average_add(&powers->third, h * h * h);
    average_add(&powers->fourth, h * h * h * h);
    double slope_x = (right - z) / dx, bend_x = (left - 2 * z + right) / (dx * dx);
    average_add(&powers->slope_x, slope_x * slope_x);
    average_add(&powers->bend_x, bend_x * bend_x);
    if (grid_is_profile(map->grid))
        return;
    double up = map_height(map, i, j - 1), down = map_height(map, i, j + 1);
    double slope_y = (down - z) / dy, bend_y = (up - 2 * z + down) / (dy * dy);
    average_add(&powers->slope_y, slope_y * slope_y);
    average_add(&powers->bend_y, bend_y * bend_y);
    average_add(&powers->either, (bend_x + bend_y) * (bend_x + bend_y));
}

void open_roughness_measure(const struct measured_map *map, struct roughness *out) {
    const struct grid *grid = map->grid;
    bool profile = grid_is_profile(grid);
    double dx = grid_dx(grid), dy = profile ? dx : grid_dy(grid);
    struct powers powers = {0};
    heights_measure(map, out);
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            point_add(map, (long)i, (long)j, out->mean, dx, dy, &powers);
    double variance = average_value(&powers.second), slope_x = average_value(&powers.slope_x);
    double bend_x = average_value(&powers.bend_x);
    out->rms_height = sqrt(variance);
    out->skewness = average_value(&powers.third) / (variance * out->rms_height);
    out->kurtosis = average_value(&powers.fourth) / (variance * variance);
    out->m2 = profile ? slope_x : (slope_x + average_value(&powers.slope_y)) / 2;
    out->m4 = profile ? bend_x : (bend_x + average_value(&powers.bend_y)) / 2;
    out->rms_slope = profile ? sqrt(slope_x) : sqrt(2 * out->m2);
    out->rms_curvature = profile ? sqrt(bend_x) : sqrt(average_value(&powers.either)) / 2;
    out->nayak_alpha = variance / out->m2 * (out->m4 / out->m2);
}
