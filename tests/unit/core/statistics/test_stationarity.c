/* Protects: p-values of stationary maps are uniform, and the spread that is expected of sub-areas
 * is that of independent heights. A rougher half, a bow and a change of skewness are detected, each
 * in its parameter. */
#include "core/statistics/uncertainty/map_chance.h"
#include "core/statistics/uncertainty/stationarity.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <stdlib.h>

enum { SIDE = 64, POINTS = SIDE * SIDE };
static const struct grid SQUARE = {SIDE, SIDE, SIDE, SIDE}, LINE = {POINTS, 1, POINTS, 1};

static void measure(const struct grid *grid, const double *z, enum boundary boundary,
                    struct stationarity *out) {
    static struct cell_differences differences;
    const struct measured_map map = {grid, z, boundary};
    struct map_chance *chance = NULL;
    assert_int_equal(map_chance_create(&chance, &map, NULL), 0);
    assert_true(chance->told);
    cell_differences_measure(&map, &chance->modes, 1, &differences);
    stationarity_measure(&map, chance->heights, &differences, &chance->modes, chance->correlation,
                         out);
    map_chance_destroy(&chance);
}

static void alike_all_over(void **state) {
    (void)state;
    enum { TRIALS = 100 };
    uint64_t seed = seed_or(9);
    static double z[POINTS];
    for (int kind = 0; kind < 3; kind++) {
        int below[STATIONARY_DIVISIONS][STATIONARY_PARAMETERS] = {0};
        double rms = 0, expected = 0;
        for (int trial = 0; trial < TRIALS; trial++) {
            struct stationarity s;
            noise_fill(&seed, POINTS, z);
            measure(kind == 2 ? &LINE : &SQUARE, z, kind == 0 ? BOUNDARY_PERIODIC : BOUNDARY_OPEN,
                    &s);
            for (int d = 0; d < STATIONARY_DIVISIONS; d++)
                for (int q = 0; q < STATIONARY_PARAMETERS; q++)
                    below[d][q] += s.spread[d][q].p_value < 0.25 ? 1 : 0;
            rms += pow(s.spread[1][STATIONARY_RMS].found, 2) / TRIALS;
            expected += pow(s.spread[1][STATIONARY_RMS].expected, 2) / TRIALS;
        }
        for (int d = 0; d < STATIONARY_DIVISIONS; d++)
            for (int q = 0; q < STATIONARY_PARAMETERS; q++)
                check_close((double)below[d][q] / TRIALS, 0.25, 4 * sqrt(0.25 * 0.75 / TRIALS));
        /* RMS of 256 independent heights */
        check_relative(rms, 0.5 / 256, 0.25);
        check_relative(expected, 0.5 / 256, 0.25);
    }
}

static void changes_are_seen(void **state) {
    (void)state;
    uint64_t seed = seed_or(10);
    static double z[POINTS];
    struct stationarity s;
    noise_fill(&seed, POINTS, z);
    for (size_t point = 0; point < POINTS; point++)
        z[point] *= point % SIDE < SIDE / 2 ? 1.3 : 1;
    measure(&SQUARE, z, BOUNDARY_OPEN, &s);
    assert_true(s.spread[0][STATIONARY_RMS].p_value < 1e-4);
    assert_true(s.spread[0][STATIONARY_SLOPE].p_value < 1e-4);
    assert_true(s.spread[0][STATIONARY_MEAN].p_value > 1e-3);
    assert_true(s.p_value[0] < 1e-3 && s.p_value[1] < 1e-3);

    noise_fill(&seed, POINTS, z);
    for (size_t point = 0; point < POINTS; point++)
        z[point] += pow(((double)(point % SIDE) - 31.5) / 32, 2);
    measure(&SQUARE, z, BOUNDARY_OPEN, &s);
    assert_true(s.spread[1][STATIONARY_MEAN].p_value < 1e-4);
    assert_true(s.spread[1][STATIONARY_SLOPE].p_value > 1e-3);

    /* exponential heights of mean 0 and RMS 1, upwards in one half and downwards in the other */
    for (size_t point = 0; point < POINTS; point++)
        z[point] = (-log(noise_uniform(&seed)) - 1) * (point / SIDE < SIDE / 2 ? 1 : -1);
    measure(&SQUARE, z, BOUNDARY_PERIODIC, &s);
    assert_true(s.spread[0][STATIONARY_SKEWNESS].p_value < 1e-4);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(alike_all_over),
                                       cmocka_unit_test(changes_are_seen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
