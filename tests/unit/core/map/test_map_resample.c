/* Protects: a map on other points is the same surface: of a periodic map to rounding, of an open
 * one as its spline; waves that wider points cannot show do not come back as others. */
#include "core/map/preparation/map_resample.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

/* A map of nx by ny points dx and dy apart with these heights; `where` is the position of the
 * first. */
static void make(struct height_map *map, size_t nx, size_t ny, double dx, double dy,
                 double (*height)(double x, double y)) {
    *map = (struct height_map){.grid = {nx, ny, dx * (double)nx, dy * (double)ny}};
    map->z = array_create(nx * ny, sizeof *map->z);
    assert_non_null(map->z);
    for (size_t j = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++)
            map->z[j * nx + i] = height(dx * (double)i, dy * (double)j);
}

/* The cell is 3 by 2. */
static double few_waves(double x, double y) {
    return 4 + sin(2 * PI * (3 * x / 3 - 2 * y / 2)) + 0.5 * cos(2 * PI * (5 * x / 3 + 4 * y / 2));
}

static double many_waves(double x, double y) {
    return few_waves(x, y) + sin(2 * PI * 11 * x / 3) + cos(2 * PI * 9 * y / 2);
}

static double cubic(double x, double y) {
    return 3 - x + 0.5 * y + (x - 2) * (x - 2) * (x - 2) + (y - 1) * x * x - y * y * y * x;
}

static void check_map(const struct height_map *map, double x0, double y0,
                      double (*height)(double x, double y), size_t margin, double tolerance) {
    const struct grid *grid = &map->grid;
    for (size_t j = margin; j + margin < grid->ny; j++)
        for (size_t i = margin; i + margin < grid->nx; i++)
            check_close(map->z[j * grid->nx + i],
                        height(x0 + (double)i * grid_dx(grid), y0 + (double)j * grid_dy(grid)),
                        tolerance);
}

static void periodic_maps_keep_their_waves(void **state) {
    (void)state;
    static const size_t COUNTS[][2] = {{36, 30}, {13, 11}, {24, 20}, {25, 31}, {64, 20}};
    for (size_t c = 0; c < 5; c++) {
        struct height_map map;
        make(&map, 24, 20, 3.0 / 24, 2.0 / 20, few_waves);
        assert_int_equal(
            map_resample(&map, BOUNDARY_PERIODIC, COUNTS[c][0], COUNTS[c][1], 0, 0, NULL), 0);
        check_close(map.grid.lx, 3, 1e-14);
        check_map(&map, 0, 0, few_waves, 0, 1e-12);
        height_map_clear(&map);
        make(&map, 24, 20, 3.0 / 24, 2.0 / 20, many_waves);
        assert_int_equal(map_resample(&map, BOUNDARY_PERIODIC, 16, 13, 0, 0, NULL), 0);
        check_map(&map, 0, 0, few_waves, 0, 1e-12);
        height_map_clear(&map);
    }
}

/* The spline is exact of cubic polynomials up to the sides. */
static void open_maps_are_splines(void **state) {
    (void)state;
    struct height_map map;
    make(&map, 9, 7, 0.5, 0.25, cubic);
    assert_int_equal(map_resample(&map, BOUNDARY_OPEN, 33, 19, 0.125, 0.0833, NULL), 0);
    check_map(&map, 0, (6 * 0.25 - 18 * 0.0833) / 2, cubic, 0, 1e-12);
    height_map_clear(&map);
    for (size_t n = 2; n < 6; n++) { /* as few points as there may be */
        make(&map, n, 1, 0.5, 0.5, cubic);
        const double was[2] = {map.z[0], map.z[n - 1]};
        assert_int_equal(map_resample(&map, BOUNDARY_OPEN, 2 * n - 1, 1, 0.25, 0.25, NULL), 0);
        check_close(map.z[0], was[0], 1e-13);
        check_close(map.z[2 * n - 2], was[1], 1e-13);
        if (n >= 4)
            check_map(&map, 0, 0, cubic, 0, 1e-12);
        height_map_clear(&map);
    }
}

static double wave_length; /* of the profiles below */
static double one_wave(double x, double y) {
    (void)y;
    return 10 + sin(2 * PI * x / wave_length + 0.3);
}
static double no_wave(double x, double y) {
    (void)x;
    (void)y;
    return 10;
}
static double slope(double x, double y) {
    return 10 + x - 2 * y;
}

/* Between points 3.3 times as far apart, waves of 2.7 of the new spacings and longer stay, and
 * those that are too short for them are gone. */
static void wider_points_show_no_false_waves(void **state) {
    (void)state;
    static const double LENGTHS[] = {30, 5, 2.7, 2, 1.9, 1.2, 0.95};
    for (size_t l = 0; l < 7; l++) {
        struct height_map map;
        wave_length = LENGTHS[l] * 3.3;
        make(&map, 1000, 1, 1, 1, one_wave);
        assert_int_equal(map_resample(&map, BOUNDARY_OPEN, 300, 1, 3.3, 3.3, NULL), 0);
        const double first = (999 - 299 * 3.3) / 2;
        if (LENGTHS[l] > 2.5)
            check_map(&map, first, 0, one_wave, 25, 3e-4);
        else
            check_map(&map, first, 0, no_wave, 25, 3e-4);
        height_map_clear(&map);
    }
    struct height_map map;
    make(&map, 200, 150, 1, 1, slope);
    assert_int_equal(map_resample(&map, BOUNDARY_OPEN, 100, 75, 2, 2, NULL), 0);
    check_map(&map, 0.5, 0.5, slope, 0, 1e-3);
    height_map_clear(&map);
}

static void too_few_points_are_refused(void **state) {
    (void)state;
    struct height_map map;
    struct error err = {0};
    make(&map, 40, 40, 1, 1, slope);
    assert_int_equal(map_resample(&map, BOUNDARY_OPEN, 10, 10, 4, 4, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "along x: from 40 points to 10"));
    assert_int_equal(map_resample(&map, BOUNDARY_OPEN, 1, 1, 4, 4, &err), ERROR_INPUT);
    assert_int_equal(map_resample(&map, BOUNDARY_OPEN, (size_t)1 << 31, 2, 1e-9, 1, &err),
                     ERROR_INPUT);
    assert_int_equal(map.grid.nx, 40);
    check_map(&map, 0, 0, slope, 0, 0);
    height_map_clear(&map);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(periodic_maps_keep_their_waves),
        cmocka_unit_test(open_maps_are_splines),
        cmocka_unit_test(wider_points_show_no_false_waves),
        cmocka_unit_test(too_few_points_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
