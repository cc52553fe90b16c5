/* Protects: the areal parameters of waves are what they are in closed form; a flat map has no
 * hills. */
#include "core/statistics/heights/areal.h"
#include "tests/support/check.h"
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

/* Without a range a hill of 5 % of it would be one of no height. */
static void a_flat_map_has_no_hills(void **state) {
    (void)state;
    const struct grid grid = {20, 20, 10, 20};
    double z[400];
    for (size_t point = 0; point < 400; point++)
        z[point] = 0.1;
    for (int boundary = BOUNDARY_PERIODIC; boundary <= BOUNDARY_OPEN; boundary++) {
        const struct measured_map map = {&grid, z, (enum boundary)boundary};
        struct correlation *correlation = NULL;
        struct roughness roughness;
        struct areal areal;
        assert_int_equal(correlation_create(&correlation, &map, NULL), 0);
        open_roughness_measure(&map, &roughness);
        assert_int_equal(areal_measure(&map, &roughness, correlation, NULL, &areal, NULL), 0);
        assert_true(areal.sz == 0 && areal.spd == 0 && isnan(areal.spc));
        correlation_destroy(&correlation);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_double_wave),
        cmocka_unit_test(a_roof),
        cmocka_unit_test(a_flat_map_has_no_hills),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
