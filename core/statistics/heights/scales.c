#include "core/statistics/heights/scales.h"

static struct scale scale_measure(const struct measured_map *map, long lag) {
    const struct grid *grid = map->grid;
    bool profile = grid_is_profile(grid);
    double lx = (double)lag * grid_dx(grid), ly = profile ? lx : (double)lag * grid_dy(grid);
    struct average slope_x = {0}, slope_y = {0}, height = {0}, curvature = {0};
    for (long j = 0; j < (long)grid->ny; j++)
        for (long i = 0; i < (long)grid->nx; i++) {
            double z = map_height(map, i, j);
            double right = map_height(map, i + lag, j) - z, left = map_height(map, i - lag, j) - z;
            double bend = (left + right) / (lx * lx);
            average_add(&slope_x, right * right / (lx * lx));
            average_add(&height, right * right / 2);
            if (!profile) {
                double down = map_height(map, i, j + lag) - z, up = map_height(map, i, j - lag) - z;
                average_add(&slope_y, down * down / (ly * ly));
                average_add(&height, down * down / 2);
                bend = (bend + (up + down) / (ly * ly)) / 2;
            }
            average_add(&curvature, bend * bend);
        }
    return (struct scale){
        .length = lx,
        .height = sqrt(average_value(&height)),
        .slope = sqrt(average_value(&slope_x) + (profile ? 0 : average_value(&slope_y))),
        .curvature = sqrt(average_value(&curvature))};
}

size_t scales_measure(const struct measured_map *map, struct scale *out) {
    const struct grid *grid = map->grid;
    size_t side = grid_is_profile(grid) || grid->nx < grid->ny ? grid->nx : grid->ny, count = 0;
    for (size_t lag = 1; count < SCALES_MOST && (lag == 1 || 4 * lag <= side); lag *= 2)
        out[count++] = scale_measure(map, (long)lag);
    return count;
}
