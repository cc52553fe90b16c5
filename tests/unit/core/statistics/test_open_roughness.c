/* Protects: parameters of maps that do not repeat, or that have holes, are sums over what is there;
 * of a whole periodic map they are the usual ones. No unit of heights takes them out of the range
 * of numbers. */
#include "core/statistics/heights/roughness.h"
#include "tests/support/check.h"
#include "tests/support/cut.h"
#include "tests/support/seed.h"

static void periodic_maps_as_usual(void **state) {
    (void)state;
    const struct grid grids[] = {{128, 100, 8, 6}, {100, 1, 10, 1}};
    for (size_t g = 0; g < 2; g++) {
        double *z = whole_surface(&grids[g], 0.5, g);
        const struct measured_map map = {&grids[g], z, BOUNDARY_PERIODIC};
        struct roughness usual, open;
        roughness_measure(&grids[g], z, &usual);
        open_roughness_measure(&map, &open);
        check_close(open.mean, usual.mean, 1e-14);
        check_relative(open.rms_height, usual.rms_height, 1e-13);
        check_relative(open.rms_slope, usual.rms_slope, 1e-13);
        check_relative(open.rms_curvature, usual.rms_curvature, 1e-13);
        check_relative(open.skewness, usual.skewness, 1e-11);
        check_relative(open.kurtosis, usual.kurtosis, 1e-13);
        check_relative(open.m2, usual.m2, 1e-13);
        check_relative(open.m4, usual.m4, 1e-13);
        check_relative(open.nayak_alpha, usual.nayak_alpha, 1e-12);
        assert_true(open.lowest == usual.lowest && open.highest == usual.highest);
        free(z);
    }
}

/* Skewness and kurtosis have no unit: they are the same where fourth powers of the heights, or
 * their squares, would be no numbers. */
static void shape_has_no_unit(void **state) {
    (void)state;
    static const double UNITS[] = {1e77, 1e150, 1e-81, 1e-155, 1e-300};
    const struct grid grids[] = {{64, 50, 8, 6}, {100, 1, 10, 1}};
    for (size_t g = 0; g < 2; g++) {
        const size_t points = grid_points(&grids[g]);
        double *z = whole_surface(&grids[g], 0.5, g);
        double *scaled = array_create(points, sizeof *scaled);
        struct roughness plain, found[2];
        assert_non_null(scaled);
        roughness_measure(&grids[g], z, &plain);
        for (size_t u = 0; u < sizeof UNITS / sizeof *UNITS; u++) {
            const struct measured_map map = {&grids[g], scaled, BOUNDARY_PERIODIC};
            for (size_t point = 0; point < points; point++)
                scaled[point] = z[point] * UNITS[u];
            roughness_measure(&grids[g], scaled, &found[0]);
            open_roughness_measure(&map, &found[1]);
            for (size_t by = 0; by < 2; by++) {
                check_relative(found[by].skewness, plain.skewness, 1e-9);
                check_relative(found[by].kurtosis, plain.kurtosis, 1e-12);
                check_relative(found[by].rms_height / UNITS[u], plain.rms_height, 1e-12);
            }
        }
        free(scaled);
        free(z);
    }
}

/* A paraboloid: its curvature is the same everywhere inside, its slopes are written out. */
static void sums_are_of_the_inside(void **state) {
    (void)state;
    enum { NX = 7, NY = 5 };
    const struct grid grid = {NX, NY, NX * 0.5, NY * 0.25};
    for (int holes = 0; holes < 2; holes++) {
        double z[NX * NY], slope_x = 0, slope_y = 0, count_x = 0, count_y = 0;
        for (size_t point = 0; point < NX * NY; point++) {
            size_t i = point % NX, j = point / NX;
            double x = (double)i * 0.5, y = (double)j * 0.25;
            z[point] = 3 * x * x + 5 * y * y;
        }
        if (holes == 1)
            z[2 * NX + 3] = z[0] = NAN;
        for (size_t j = 0; j < NY; j++)
            for (size_t i = 0; i < NX; i++) {
                double x = i + 1 < NX ? (z[j * NX + i + 1] - z[j * NX + i]) / 0.5 : (double)NAN;
                double y = j + 1 < NY ? (z[(j + 1) * NX + i] - z[j * NX + i]) / 0.25 : (double)NAN;
                slope_x += isnan(x) ? 0 : x * x;
                slope_y += isnan(y) ? 0 : y * y;
                count_x += isnan(x) ? 0 : 1;
                count_y += isnan(y) ? 0 : 1;
            }
        const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
        struct roughness r;
        open_roughness_measure(&map, &r);
        check_relative(r.rms_slope, sqrt(slope_x / count_x + slope_y / count_y), 1e-13);
        check_relative(r.rms_curvature, 8, 1e-12);
        check_relative(r.m4, (36 + 100) / 2.0, 1e-12);
        assert_int_equal((int)(count_x + count_y), holes == 0 ? 6 * 5 + 7 * 4 : 6 * 5 + 7 * 4 - 6);
    }
}

static bool whole_by_sight(const struct measured_map *map, long i, long j, long before,
                           long after) {
    bool profile = grid_is_profile(map->grid);
    for (long y = profile ? 0 : -before; y <= (profile ? 0 : after); y++)
        for (long x = -before; x <= after; x++)
            if (isnan(map_height(map, i + x, j + y)))
                return false;
    return true;
}

static void marks_are_of_points_with_all_around(void **state) {
    (void)state;
    uint64_t seed = seed_or(3);
    for (int trial = 0; trial < 200; trial++) {
        const struct grid grid = {5 + next_word(&seed) % 9,
                                  trial % 3 == 0 ? 1 : 5 + next_word(&seed) % 9, 1, 1};
        size_t points = grid_points(&grid), before = next_word(&seed) % 4,
               after = next_word(&seed) % 4;
        double z[200] = {0};
        unsigned char whole[200];
        for (size_t hole = next_word(&seed) % 4; hole > 0; hole--)
            z[next_word(&seed) % points] = NAN;
        const struct measured_map map = {&grid, z,
                                         trial % 2 == 0 ? BOUNDARY_OPEN : BOUNDARY_PERIODIC};
        size_t marked = map_mark_whole(&map, before, after, whole), count = 0;
        for (size_t point = 0; point < points; point++) {
            long i = (long)(point % grid.nx), j = (long)(point / grid.nx);
            bool expected = whole_by_sight(&map, i, j, (long)before, (long)after);
            assert_int_equal(whole[point], expected ? 1 : 0);
            count += whole[point];
        }
        assert_int_equal(marked, count);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(periodic_maps_as_usual),
        cmocka_unit_test(shape_has_no_unit),
        cmocka_unit_test(sums_are_of_the_inside),
        cmocka_unit_test(marks_are_of_points_with_all_around),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
