/* Protects: means in lanes, and the scales of maps, are over all that is there: whatever the width
 * of the map, with holes, open and periodic. */
#include "core/statistics/heights/scales.h"
#include "core/statistics/lanes.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"

static void means_leave_holes_out(void **state) {
    (void)state;
    struct lanes lanes = {0};
    struct lane_mean mean = {0};
    assert_true(isnan(lane_mean_value(&mean)));
    for (size_t row = 0; row < 2; row++) { /* 3, 4, ..., LANES + 2 twice, but for a hole in both */
        for (size_t l = 0; l < LANES; l++)
            lane_add(&lanes, l, l == 5 ? (double)NAN : (double)l + 3);
        lane_mean_add(&mean, &lanes);
    }
    double total = 0.5 * LANES * (LANES - 1) + 3 * LANES - 8;
    check_close(mean.count, 2 * (LANES - 1), 0);
    check_relative(lane_mean_value(&mean), total / (LANES - 1), 1e-15);
}

/* Point by point, as FORMULAS.md has it (F18.6). */
static struct scale scale_by_points(const struct measured_map *map, long lag) {
    const struct grid *grid = map->grid;
    double lx = (double)lag * grid_dx(grid), ly = (double)lag * grid_dy(grid);
    struct average x = {0}, y = {0}, height = {0}, curvature = {0};
    for (long j = 0; j < (long)grid->ny; j++)
        for (long i = 0; i < (long)grid->nx; i++) {
            double z = map_height(map, i, j);
            double right = map_height(map, i + lag, j) - z, down = map_height(map, i, j + lag) - z;
            double left = map_height(map, i - lag, j) - z, up = map_height(map, i, j - lag) - z;
            average_add(&x, pow(right / lx, 2));
            average_add(&y, pow(down / ly, 2));
            average_add(&height, right * right / 2);
            average_add(&height, down * down / 2);
            average_add(&curvature,
                        pow((left + right) / (lx * lx) / 2 + (up + down) / (ly * ly) / 2, 2));
        }
    return (struct scale){.length = lx,
                          .height = sqrt(average_value(&height)),
                          .slope = sqrt(average_value(&x) + average_value(&y)),
                          .curvature = sqrt(average_value(&curvature))};
}

static void scales_are_of_all_differences(void **state) {
    (void)state;
    enum { NX_MOST = 140, NY_MOST = 30 };
    uint64_t seed = seed_or(19);
    for (size_t trial = 0; trial < 40; trial++) {
        const struct grid grid = {9 + next_word(&seed) % (NX_MOST - 8),
                                  9 + next_word(&seed) % (NY_MOST - 8), 7, 5};
        double z[NX_MOST * NY_MOST];
        for (size_t point = 0; point < grid_points(&grid); point++) {
            z[point] = (double)(next_word(&seed) % 1000) / 100;
            if (trial % 4 >= 2 && next_word(&seed) % 50 == 0)
                z[point] = (double)NAN;
        }
        const struct measured_map map = {&grid, z, trial % 2 ? BOUNDARY_OPEN : BOUNDARY_PERIODIC};
        struct scale scales[SCALES_MOST];
        size_t count = scales_measure(&map, scales);
        assert_true(count >= 2);
        for (size_t n = 0; n < count; n++) {
            struct scale expected = scale_by_points(&map, 1L << n);
            check_relative(scales[n].length, expected.length, 1e-14);
            check_relative(scales[n].height, expected.height, 1e-12);
            check_relative(scales[n].slope, expected.slope, 1e-12);
            check_relative(scales[n].curvature, expected.curvature, 1e-12);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(means_leave_holes_out),
        cmocka_unit_test(scales_are_of_all_differences),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
