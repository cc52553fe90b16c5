/* Protects: what levelling takes of scan lines without offsets is known from waves along them:
 * of independent heights as much as a mean of so many, of a polynomial so many terms; nothing where
 * no lines were levelled. */
#include "core/map/preparation/line_losses.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"

enum { SIDE = 64, POINTS = SIDE * SIDE, TRIALS = 100 };
static const struct grid GRID = {SIDE, SIDE, SIDE, SIDE};
static double z[POINTS];
static const struct measured_map MAP = {&GRID, z, BOUNDARY_OPEN};

/* The mean of a line of n independent heights has 1/n of their mean square; so have differences
 * from line to line of those across, which are half of all slopes, and second differences. Of the
 * square of the mean curvature, 5, lines have 6/4. 8 waves of 64 lines: each trial is known to
 * sqrt(2/512), or for differences 1.7 times that. */
static void independent_heights(void **state) {
    (void)state;
    uint64_t seed = seed_or(6);
    struct line_losses mean = {0}, lost;
    for (int trial = 0; trial < TRIALS; trial++) {
        noise_fill(&seed, POINTS, z);
        const enum scan_axis along = trial % 2 == 0 ? SCAN_ALONG_X : SCAN_ALONG_Y;
        assert_int_equal(line_losses_measure(&MAP, SCAN_LINES_MEAN, along, &lost, NULL), 0);
        mean.height += lost.height / TRIALS;
        mean.slope += lost.slope / TRIALS;
        mean.bend += lost.bend / TRIALS;
        mean.curvature += lost.curvature / TRIALS;
    }
    const double tolerance = 4 * 1.7 * sqrt(2. / (8 * SIDE) / TRIALS) + 0.01;
    check_relative(mean.height * SIDE, 1, tolerance);
    check_relative(mean.slope * SIDE, 0.5, tolerance);
    check_relative(mean.bend * SIDE, 0.5, tolerance);
    check_relative(mean.curvature * SIDE, 6. / 4 / 5, tolerance);
}

static void terms_of_a_polynomial(void **state) {
    (void)state;
    uint64_t seed = seed_or(7);
    struct line_losses one, two, none;
    noise_fill(&seed, POINTS, z);
    z[5] = NAN; /* a hole counts as the mean */
    assert_int_equal(line_losses_measure(&MAP, SCAN_LINES_MEDIAN, SCAN_ALONG_X, &one, NULL), 0);
    assert_int_equal(line_losses_measure(&MAP, SCAN_LINES_QUADRATIC, SCAN_ALONG_X, &two, NULL), 0);
    assert_int_equal(line_losses_measure(&MAP, SCAN_LINES_NONE, SCAN_ALONG_X, &none, NULL), 0);
    assert_true(one.height > 0);
    check_relative(two.height, 3 * one.height, 1e-12);
    check_relative(two.curvature, 3 * one.curvature, 1e-12);
    assert_true(none.height == 0 && none.slope == 0 && none.bend == 0 && none.curvature == 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(independent_heights),
                                       cmocka_unit_test(terms_of_a_polynomial)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
