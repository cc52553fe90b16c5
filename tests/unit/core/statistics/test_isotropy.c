/* Protects: the ratio and the direction of slopes, and the sector of waves, are those of waves in
 * closed form; a map turned by two right angles has the same ones; p-values of maps without a
 * direction are uniform. */
#include "core/statistics/uncertainty/isotropy.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <stdlib.h>

enum { SIDE = 64, POINTS = SIDE * SIDE };
static const struct grid GRID = {SIDE, SIDE, SIDE, SIDE};
static const double DEGREE = M_PI / 180;

static void measure(const double *z, enum boundary boundary, struct isotropy *out) {
    static struct low_modes modes;
    static struct cell_differences differences;
    const struct measured_map map = {&GRID, z, boundary};
    assert_true(low_modes_fill(&map, NULL, &modes));
    cell_differences_measure(&map, &modes, 1, &differences);
    isotropy_measure(&differences, 1, &modes, 1, out);
}

/* 3 cos(k r) + cos(q r) with q at right angles to k, as long. */
static void two_waves(void **state) {
    (void)state;
    static const long WAVES[][2] = {{8, 0}, {0, 8}, {6, 6}, {-6, 6}};
    static const double ANGLES[] = {0, 90, 45, -45};
    static double z[POINTS];
    for (size_t n = 0; n < 4; n++) {
        struct isotropy found;
        double x = 2 * M_PI * (double)WAVES[n][0] / SIDE, y = 2 * M_PI * (double)WAVES[n][1] / SIDE;
        for (size_t point = 0; point < POINTS; point++) {
            size_t row = point / SIDE;
            double i = (double)(point % SIDE), j = (double)row;
            z[point] = 3 * cos(x * i + y * j) + cos(-y * i + x * j);
        }
        measure(z, BOUNDARY_PERIODIC, &found);
        check_relative(found.ratio, 3, 1e-9);
        check_relative(found.anisotropy, 0.8, 1e-9);
        /* in either direction along y */
        check_close(fabs(sin(found.direction - ANGLES[n] * DEGREE)), 0, 1e-9);
        assert_true(found.p_value < 1e-6);
    }
    struct isotropy flat;
    for (size_t point = 0; point < POINTS; point++)
        z[point] = 1;
    measure(z, BOUNDARY_PERIODIC, &flat);
    assert_true(isnan(flat.ratio) && isnan(flat.p_value));
}

/* Squares of four points are the same ones in the turned map, at all lags, in maps that repeat and
 * in others, with sides of even and odd numbers of points, and with a hole. */
static void turned_maps_are_alike(void **state) {
    (void)state;
    enum { MOST = 90 * 71 };
    static const struct grid GRIDS[] = {{64, 48, 64, 48}, {90, 71, 90, 35.5}};
    static double z[MOST], turned[MOST];
    static struct low_modes modes;
    static struct cell_differences differences[2];
    uint64_t seed = seed_or(9);
    for (size_t n = 0; n < 8; n++) {
        const struct grid *grid = &GRIDS[n % 2];
        const enum boundary boundary = n % 4 < 2 ? BOUNDARY_PERIODIC : BOUNDARY_OPEN;
        const struct measured_map maps[] = {{grid, z, boundary}, {grid, turned, boundary}};
        const size_t points = grid_points(grid);
        noise_fill(&seed, points, z);
        if (n >= 4)
            z[points / 3] = (double)NAN;
        for (size_t point = 0; point < points; point++)
            turned[point] = z[points - 1 - point];
        assert_true(low_modes_fill(&maps[0], NULL, &modes));
        for (size_t lag = 1; lag <= 16; lag = lag < 4 ? lag + 1 : 2 * lag) {
            struct isotropy found[2];
            for (size_t m = 0; m < 2; m++) {
                cell_differences_measure(&maps[m], &modes, lag, &differences[m]);
                isotropy_measure(&differences[m], (double)lag, &modes, 1, &found[m]);
            }
            check_close(found[1].anisotropy, found[0].anisotropy, 1e-12);
            check_close(sin(found[1].direction - found[0].direction), 0, 1e-10);
        }
    }
}

static void uniform_p_values(void **state) {
    (void)state;
    enum { TRIALS = 400 };
    uint64_t seed = seed_or(7);
    static double z[POINTS];
    for (int boundary = BOUNDARY_PERIODIC; boundary <= BOUNDARY_OPEN; boundary++) {
        int below[4] = {0};
        for (int trial = 0; trial < TRIALS; trial++) {
            struct isotropy found;
            noise_fill(&seed, POINTS, z);
            measure(z, (enum boundary)boundary, &found);
            for (int quarter = 1; quarter < 4; quarter++)
                below[quarter] += found.p_value < quarter * 0.25 ? 1 : 0;
        }
        for (int quarter = 1; quarter < 4; quarter++) {
            double share = quarter * 0.25;
            check_close((double)below[quarter] / TRIALS, share,
                        4 * sqrt(share * (1 - share) / TRIALS));
        }
    }
}

static void least_of_p_values(void **state) {
    (void)state;
    const double p_values[] = {0.3, 0.05, 0.9}, none[] = {0.3, (double)NAN};
    check_relative(least_p_value(p_values, 3), 1 - pow(0.95, 3), 1e-12);
    assert_true(isnan(least_p_value(none, 2)));
}

static void waves_by_sector(void **state) {
    (void)state;
    uint64_t seed = seed_or(8);
    static double z[POINTS];
    static const long WAVES[][2] = {{6, 8}, {10, 0}, {0, 10}, {8, -6}};
    for (size_t n = 0; n < 4; n++) {
        struct map_spectrum *spectrum = NULL;
        struct angular_spectrum angular;
        noise_fill(&seed, POINTS, z);
        for (size_t point = 0; point < POINTS; point++)
            z[point] += 2 * cos(2 * M_PI / SIDE *
                                (double)(WAVES[n][0] * (long)(point % SIDE) +
                                         WAVES[n][1] * (long)(point / SIDE)));
        const struct measured_map map = {&GRID, z, n % 2 ? BOUNDARY_OPEN : BOUNDARY_PERIODIC};
        assert_int_equal(map_spectrum_create(&spectrum, &map, NULL), 0);
        angular_spectrum_measure(spectrum, &angular);
        map_spectrum_destroy(&spectrum);
        double off =
            angular_spectrum_peak(&angular) - atan2((double)WAVES[n][1], (double)WAVES[n][0]);
        check_close(fabs(sin(off)), 0, sin(2.6 * DEGREE));
    }
    /* noise alone: nine in ten sectors and more within two errors of 1 */
    int within = 0;
    struct map_spectrum *spectrum = NULL;
    struct angular_spectrum angular;
    const struct measured_map map = {&GRID, z, BOUNDARY_OPEN};
    noise_fill(&seed, POINTS, z);
    assert_int_equal(map_spectrum_create(&spectrum, &map, NULL), 0);
    angular_spectrum_measure(spectrum, &angular);
    map_spectrum_destroy(&spectrum);
    for (size_t s = 0; s < ANGULAR_SECTORS; s++)
        for (int kind = 0; kind < ANGULAR_KINDS; kind++)
            within += fabs(angular.power[kind][s] - 1) <= 2 * angular.error[kind][s] ? 1 : 0;
    assert_true(within >= 2 * ANGULAR_SECTORS * 4 / 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_waves), cmocka_unit_test(turned_maps_are_alike),
        cmocka_unit_test(uniform_p_values), cmocka_unit_test(least_of_p_values),
        cmocka_unit_test(waves_by_sector)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
