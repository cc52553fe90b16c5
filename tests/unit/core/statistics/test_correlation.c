/* Protects: the autocorrelation of a map is the mean product over the pairs that are there,
 * whatever its boundary and its holes; its lengths are those of waves whose correlation is known.
 */
#include "core/statistics/spectra/correlation.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdlib.h>

enum { POINTS_MOST = 30 * 30 };

static struct correlation *correlate(const struct measured_map *map) {
    struct correlation *c = NULL;
    assert_int_equal(correlation_create(&c, map, NULL), 0);
    return c;
}

/* Returns the sum written out. */
static double by_pairs(const struct measured_map *map, long x, long y) {
    struct average mean = {0}, product = {0}, square = {0};
    long nx = (long)map->grid->nx, ny = (long)map->grid->ny;
    for (long point = 0; point < nx * ny; point++)
        average_add(&mean, map->z[point]);
    double middle = average_value(&mean);
    for (long j = 0; j < ny; j++)
        for (long i = 0; i < nx; i++) {
            double here = map_height(map, i, j) - middle;
            average_add(&square, here * here);
            average_add(&product, here * (map_height(map, i + x, j + y) - middle));
        }
    return average_value(&product) / average_value(&square);
}

/* Sides of few points, whose longest lags have neighbours without a pair. */
static void lags_beside_none(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{2, 9, 2, 9}, {4, 4, 4, 4}, {5, 3, 5, 3}};
    for (size_t g = 0; g < sizeof GRIDS / sizeof *GRIDS; g++) {
        double z[18];
        for (size_t point = 0; point < grid_points(&GRIDS[g]); point++)
            z[point] = sin((double)(3 * point * point));
        const struct measured_map map = {&GRIDS[g], z, BOUNDARY_OPEN};
        struct correlation *c = correlate(&map);
        const long reach_x = (long)GRIDS[g].nx / 2, reach_y = (long)GRIDS[g].ny / 2;
        for (long y = -reach_y; y <= reach_y; y++)
            for (long x = -reach_x; x <= reach_x; x++)
                check_close(correlation_at(c, (double)x, (double)y), by_pairs(&map, x, y), 1e-12);
        correlation_destroy(&c);
    }
}

static void means_of_pairs(void **state) {
    (void)state;
    uint64_t seed = seed_or(8);
    for (int trial = 0; trial < 24; trial++) {
        const struct grid grid = {9 + next_word(&seed) % 20,
                                  trial % 4 == 3 ? 1 : 9 + next_word(&seed) % 20, 3, 2};
        double z[POINTS_MOST];
        for (size_t point = 0; point < grid_points(&grid); point++)
            z[point] = 5 + (double)(next_word(&seed) >> 40) * 0x1p-24;
        for (int hole = 0; hole < trial % 3; hole++)
            z[next_word(&seed) % grid_points(&grid)] = NAN;
        const struct measured_map map = {&grid, z,
                                         trial % 2 == 0 ? BOUNDARY_OPEN : BOUNDARY_PERIODIC};
        struct correlation *c = correlate(&map);
        long reach_x = (long)grid.nx / 2, reach_y = trial % 4 == 3 ? 0 : (long)grid.ny / 2;
        double sums[POINTS_MOST] = {0}, counts[POINTS_MOST] = {0};
        for (long y = -reach_y; y <= reach_y; y++)
            for (long x = -reach_x; x <= reach_x; x++) {
                double expected = by_pairs(&map, x, y);
                check_close(correlation_at(c, (double)x, (double)y), expected, 1e-12);
                double ratio = reach_y > 0 ? grid_dy(&grid) / grid_dx(&grid) : 0;
                size_t r = (size_t)(hypot((double)x, (double)y * ratio) + 0.5);
                sums[r] += expected;
                counts[r]++;
            }
        double lag[POINTS_MOST], mean[POINTS_MOST];
        assert_int_equal(correlation_rings(c), reach_x + 1);
        correlation_radial(c, lag, mean);
        for (long r = 0; r <= reach_x; r++) {
            check_close(mean[r], sums[r] / counts[r], 1e-12);
            check_relative(lag[r], (double)r * grid_dx(&grid), 1e-14);
        }
        assert_true(isnan(correlation_at(c, (double)reach_x + 0.1, 0)));
        correlation_destroy(&c);
    }
}

/* cos(k x) cos(k y) falls to 0.2 at acos(0.2)/k along the axes and at sqrt(2) acos(sqrt(0.2))/k
 * between them; one wave does so along x alone. Cubic interpolation of 16 points a wave: 1e-3. */
static void lengths_of_waves(void **state) {
    (void)state;
    const struct grid grid = {64, 96, 32, 24}; /* spacings 1/2 and 1/4 */
    double *z = malloc(grid_points(&grid) * sizeof *z), k = 2 * M_PI / 8, shortest, longest;
    assert_non_null(z);
    const struct measured_map map = {&grid, z, BOUNDARY_PERIODIC};
    for (int wave = 0; wave < 2; wave++) {
        for (size_t point = 0; point < grid_points(&grid); point++) {
            size_t i = point % 64, j = point / 64;
            z[point] = cos(k * (double)i / 2) * (wave == 0 ? cos(k * (double)j / 4) : 1);
        }
        struct correlation *c = correlate(&map);
        correlation_lengths(c, 0.2, &shortest, &longest);
        check_relative(shortest, acos(0.2) / k, 1e-3);
        if (wave == 0)
            check_relative(longest, sqrt(2) * acos(sqrt(0.2)) / k, 1e-3);
        else
            assert_true(isnan(longest));
        correlation_lengths(c, -1.5, &shortest, &longest);
        assert_true(isnan(shortest) && isnan(longest));
        correlation_destroy(&c);
    }
    for (size_t point = 0; point < grid_points(&grid); point++)
        z[point] = 3;
    struct correlation *flat = correlate(&map);
    assert_true(isnan(correlation_at(flat, 0, 0)));
    correlation_destroy(&flat);
    free(z);
}

/* A direction is walked in steps that suit it, not in those of the finer axis: 1e9 times as many
 * would not end. Tolerance as above. */
static void lengths_where_spacings_are_far_apart(void **state) {
    (void)state;
    static const double RATIOS[] = {1e-9, 1e9, 1e-300, 1e300};
    double z[64 * 64], k = 2 * M_PI / 16, shortest, longest;
    for (size_t point = 0; point < 64 * 64; point++) {
        const size_t i = point % 64, j = point / 64;
        z[point] = cos(k * (double)i) * cos(k * (double)j);
    }
    for (size_t n = 0; n < sizeof RATIOS / sizeof *RATIOS; n++) {
        const struct grid grid = {64, 64, 64, 64 * RATIOS[n]};
        const struct measured_map map = {&grid, z, BOUNDARY_PERIODIC};
        struct correlation *c = correlate(&map);
        correlation_lengths(c, 0.2, &shortest, &longest);
        check_relative(shortest, fmin(1, RATIOS[n]) * acos(0.2) / k, 1e-3);
        double lag[33], mean[33];
        assert_int_equal(correlation_rings(c), 33);
        correlation_radial(c, lag, mean);
        assert_true(mean[8] < 0.1 && lag[8] == 8);
        correlation_destroy(&c);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(means_of_pairs),
        cmocka_unit_test(lags_beside_none),
        cmocka_unit_test(lengths_of_waves),
        cmocka_unit_test(lengths_where_spacings_are_far_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
