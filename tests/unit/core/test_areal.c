/* Protects: the areal parameters of waves are what they are in closed form, and hills that stand
 * out are those that a search from every maximum finds. */
#include "core/statistics/heights/areal.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdlib.h>

/* A cos(k x) cos(k y), 16 points a wave, 4 by 6 waves of length 8. */
static void a_double_wave(void **state) {
    (void)state;
    const struct grid grid = {64, 96, 32, 48};
    const double height = 0.01, k = 2 * M_PI / 8;
    double *z = malloc(grid_points(&grid) * sizeof *z);
    assert_non_null(z);
    for (size_t point = 0; point < grid_points(&grid); point++) {
        size_t i = point % 64, j = point / 64;
        z[point] = 3 + height * cos(k * (double)i / 2) * cos(k * (double)j / 2);
    }
    const struct measured_map map = {&grid, z, BOUNDARY_PERIODIC};
    struct correlation *correlation = NULL;
    struct roughness roughness;
    struct areal areal;
    assert_int_equal(correlation_create(&correlation, &map, NULL), 0);
    open_roughness_measure(&map, &roughness);
    assert_int_equal(areal_measure(&map, &roughness, correlation, NULL, &areal, NULL), 0);
    double sampled = 2 / (16 * tan(M_PI / 16)); /* mean |cos| of 16 points a wave, for 2/pi */
    double difference = sin(M_PI / 16) * 2 / 0.5, bend = difference * difference;
    check_relative(areal.sa, height * sampled * sampled, 1e-9);
    check_relative(areal.sq, height / 2, 1e-9);
    check_close(areal.ssk, 0, 1e-9);
    check_relative(areal.sku, 2.25, 1e-9);
    check_relative(areal.sp, height, 1e-9);
    check_relative(areal.sv, height, 1e-9);
    check_relative(areal.sz, 2 * height, 1e-9);
    check_relative(areal.sdq, height * difference / sqrt(2), 1e-9);
    check_relative(areal.sdr, areal.sdq * areal.sdq / 2, 1e-4); /* slopes of 0.008 */
    check_relative(areal.sal, acos(0.2) / k, 1e-3);
    check_relative(areal.str, acos(0.2) / (sqrt(2) * acos(sqrt(0.2))), 1e-3);
    check_relative(areal.spd, 2.0 / 64, 1e-12);
    check_relative(areal.spc, height * bend, 1e-9);
    correlation_destroy(&correlation);
    free(z);
}

/* A roof of slope 1 along x has a developed area of sqrt(2). */
static void a_roof(void **state) {
    (void)state;
    const struct grid grid = {20, 20, 10, 20};
    double z[400];
    for (size_t point = 0; point < 400; point++)
        z[point] = fabs((double)(point % 20) - 10) * 0.5;
    for (int boundary = BOUNDARY_PERIODIC; boundary <= BOUNDARY_OPEN; boundary++) {
        const struct measured_map map = {&grid, z, (enum boundary)boundary};
        struct correlation *correlation = NULL;
        struct roughness roughness;
        struct areal areal;
        assert_int_equal(correlation_create(&correlation, &map, NULL), 0);
        open_roughness_measure(&map, &roughness);
        assert_int_equal(areal_measure(&map, &roughness, correlation, NULL, &areal, NULL), 0);
        check_relative(areal.sdq, 1, 1e-12);
        check_relative(areal.sdr, sqrt(2) - 1, 1e-12);
        assert_true(isnan(areal.str));
        correlation_destroy(&correlation);
    }
}

/* --- hills --- */

enum { SIDE_MOST = 14, WIDER = 64, POINTS_MOST = SIDE_MOST * (SIDE_MOST + WIDER) };

/* Higher, or as high and before it: as areal.c ranks peaks of one height. */
static bool outranks(const struct measured_map *map, long a, long b) {
    return map->z[a] > map->z[b] || (map->z[a] == map->z[b] && a < b);
}

static long wrapped(long i, long n) {
    return i < 0 ? i + n : i >= n ? i - n : i;
}

/* Visits all points that can be reached from a peak without going `least` below it; returns whether
 * one of them outranks it. */
static bool reaches_higher(const struct measured_map *map, long peak_i, long peak_j, double least) {
    long nx = (long)map->grid->nx, ny = (long)map->grid->ny, count = 1, peak = peak_j * nx + peak_i;
    bool seen[POINTS_MOST] = {false};
    struct {
        long i, j;
    } stack[POINTS_MOST] = {{peak_i, peak_j}};
    seen[peak] = true;
    while (count > 0) {
        long i = stack[--count].i, j = stack[count].j;
        if (outranks(map, j * nx + i, peak))
            return true;
        for (long step = 0; step < 9; step++) {
            long x = i + step % 3 - 1, y = j + step / 3 - 1;
            double z = map_height(map, x, y);
            long beside = wrapped(y, ny) * nx + wrapped(x, nx);
            if (isnan(z) || seen[beside] || !(z > map->z[peak] - least))
                continue;
            seen[beside] = true;
            stack[count].i = wrapped(x, nx);
            stack[count++].j = wrapped(y, ny);
        }
    }
    return false;
}

/* Whole numbers for heights, so that there are many ties. Some maps are wider than the blocks that
 * rows are searched in. */
static void hills_as_by_search(void **state) {
    (void)state;
    uint64_t seed = seed_or(4);
    size_t found = 0;
    for (int trial = 0; trial < 400; trial++) {
        size_t more = trial % 8 == 5 || trial % 8 == 6 ? WIDER : 0;
        const struct grid grid = {3 + next_word(&seed) % 12 + more, 3 + next_word(&seed) % 12, 2,
                                  3};
        double z[POINTS_MOST], least = (double)(1 + next_word(&seed) % 8);
        unsigned char whole[POINTS_MOST];
        bool open = trial % 2 == 0;
        for (size_t point = 0; point < grid_points(&grid); point++)
            z[point] = (double)(next_word(&seed) % 12);
        if (trial % 4 == 0)
            z[next_word(&seed) % grid_points(&grid)] = NAN;
        const struct measured_map map = {&grid, z, open ? BOUNDARY_OPEN : BOUNDARY_PERIODIC};
        struct hills hills;
        size_t marked = map_mark_whole(&map, 1, 1, whole), expected = 0;
        for (size_t j = 0; j < grid.ny; j++)
            for (size_t i = 0; i < grid.nx; i++)
                if (whole[j * grid.nx + i] != 0 && !reaches_higher(&map, (long)i, (long)j, least))
                    expected++;
        assert_int_equal(hills_find(&map, least, NULL, &hills, NULL), 0);
        assert_int_equal(hills.count, expected);
        if (marked > 0)
            check_relative(hills.density + 1,
                           1 + (double)expected / ((double)marked * 6 / (double)grid_points(&grid)),
                           1e-12);
        found += expected;
    }
    assert_true(found > 100);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_double_wave),
        cmocka_unit_test(a_roof),
        cmocka_unit_test(hills_as_by_search),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
