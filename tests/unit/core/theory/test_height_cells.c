/* Heights that are spread over bins, beside sums written out: on bins whose edges lie on a lattice
 * of parts of a cell, and on others. */
#include "core/theory/height_cells.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

enum { MEANS = 3, BINS_MOST = 300 };
static const double MEAN[MEANS] = {-1.3, 0.21, 2.5}, WEIGHT[MEANS] = {0.5, 2, 1e-12};
static const double VARIANCE = 0.3, RISE = 0.4;

/* Means are counted in the two cells beside them, which adds 0 to 1/4 of the cell's width squared
 * to the variance of each; 1/6 is taken off. What is left is worth half of it, 2e-5, times the
 * second derivative by the mean of what is summed, 7 at most here. A cell too far is worth 1e-2. */
static const double COUNTING = 1.5e-4;

static void spread_is_the_sum(const struct bins *bins) {
    double cells[HEIGHT_CELLS] = {0}, moments[HEIGHT_CELLS] = {0};
    double below[BINS_MOST], above[BINS_MOST], below_moment[BINS_MOST], above_moment[BINS_MOST];
    const struct height_edges out = {below, above, below_moment, above_moment, NULL};
    for (int m = 0; m < MEANS; m++) {
        height_cells_add(cells, MEAN[m], WEIGHT[m]);
        height_cells_add(moments, MEAN[m], 3 * WEIGHT[m]);
    }
    assert_int_equal(height_cells_spread(cells, moments, VARIANCE, RISE, bins, &out, NULL), 0);
    for (size_t b = 0; b <= bins->count; b++) {
        double edge = bins->low + (double)b * bins_width(bins), sum[4] = {0};
        for (int m = 0; m < MEANS; m++) {
            double a = (edge - MEAN[m]) / sqrt(VARIANCE);
            double lower = erfc(-a / M_SQRT2) / 2, upper = erfc(a / M_SQRT2) / 2;
            double slant =
                RISE * WEIGHT[m] * sqrt(VARIANCE) * exp(-a * a / 2) / sqrt(2 * 3.14159265358979);
            sum[0] += WEIGHT[m] * lower;
            sum[1] += WEIGHT[m] * upper;
            sum[2] += 3 * WEIGHT[m] * lower - slant;
            sum[3] += 3 * WEIGHT[m] * upper + slant;
        }
        check_close(below[b], sum[0], COUNTING);
        check_close(above[b], sum[1], COUNTING);
        check_close(below_moment[b], sum[2], COUNTING);
        check_close(above_moment[b], sum[3], COUNTING);
    }
}

static void spread_adds_up_on_any_bins(void **state) {
    (void)state;
    static const struct bins BINS[] = {{-4, 8, 240}, {-4, 6, 100}, {-4, 8, 293}, {-1.7, 5.3, 90}};
    for (size_t a = 0; a < sizeof BINS / sizeof *BINS; a++)
        spread_is_the_sum(&BINS[a]);
}

/* The same edges, on and off the lattice: both give the same shares of a bin, in tails of 1e-40,
 * too. */
static void a_lattice_changes_nothing(void **state) {
    (void)state;
    const struct bins on = {-4, 8, 240}, off = {-4, 8.0 + 1e-8, 240};
    double cells[HEIGHT_CELLS] = {0}, one[2 * BINS_MOST], other[2 * BINS_MOST];
    for (int m = 0; m < MEANS - 1; m++)
        height_cells_add(cells, MEAN[m], WEIGHT[m]);
    const struct height_edges first = {.below = one, .above = one + BINS_MOST};
    const struct height_edges second = {.below = other, .above = other + BINS_MOST};
    assert_int_equal(height_cells_spread(cells, NULL, VARIANCE, 0, &on, &first, NULL), 0);
    assert_int_equal(height_cells_spread(cells, NULL, VARIANCE, 0, &off, &second, NULL), 0);
    for (size_t b = 0; b <= on.count; b++) {
        /* the edge moves by up to 1e-8, at most 14 deviations from a mean: 3e-7 of a share */
        check_relative(one[b], other[b], 1e-6);
        check_relative(one[BINS_MOST + b], other[BINS_MOST + b], 1e-6);
    }
    assert_true(one[BINS_MOST + 240] > 0 && one[BINS_MOST + 240] < 1e-40);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spread_adds_up_on_any_bins),
        cmocka_unit_test(a_lattice_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
