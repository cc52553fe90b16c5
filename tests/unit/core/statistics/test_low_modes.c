/* Protects: the slow waves that estimate the variance of a mean are independent of each other and
 * of the mean. They estimate the variance of the mean of independent numbers, and heights are
 * counted in cells as they are. */
#include "core/map/preparation/detrend.h"
#include "core/statistics/uncertainty/cell_heights.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <stdlib.h>

static const struct grid SQUARE = {64, 64, 1, 1}, OBLONG = {128, 32, 4, 1}, LINE = {256, 1, 1, 1};

static void waves_are_orthonormal(void **state) {
    (void)state;
    const struct grid *const grids[] = {&SQUARE, &OBLONG, &LINE};
    const size_t counts[2][3] = {{20, 20, 10}, {19, 19, 10}};
    static struct low_modes modes;
    for (int boundary = BOUNDARY_PERIODIC; boundary <= BOUNDARY_OPEN; boundary++)
        for (size_t g = 0; g < 3; g++) {
            const struct measured_map map = {grids[g], NULL, (enum boundary)boundary};
            assert_true(low_modes_fill(&map, NULL, &modes));
            assert_int_equal(modes.count, counts[boundary][g]);
            size_t cells = modes.cells_x * modes.cells_y;
            for (size_t m = 0; m < modes.count; m++) {
                double ones[LOW_CELLS_MOST];
                for (size_t cell = 0; cell < cells; cell++)
                    ones[cell] = 1;
                check_close(low_mode_amplitude(&modes, m, ones), 0, 1e-9);
                for (size_t a = 0; a < modes.count; a++)
                    check_close(low_mode_amplitude(&modes, m, modes.value[a]) / (double)cells,
                                a == m ? 1 : 0, 1e-9);
            }
        }
    const struct grid small = {15, 64, 1, 1};
    const struct measured_map map = {&small, NULL, BOUNDARY_OPEN};
    assert_false(low_modes_fill(&map, NULL, &modes));
}

/* The mean of n independent numbers, uniform in (0, 1), has the variance 1/(12 n). */
static void variance_of_a_mean(void **state) {
    (void)state;
    uint64_t seed = seed_or(3);
    static struct low_modes modes;
    const struct measured_map map = {&SQUARE, NULL, BOUNDARY_PERIODIC};
    assert_true(low_modes_fill(&map, NULL, &modes));
    double mean = 0;
    enum { TRIALS = 400, EACH = 16 };
    for (int trial = 0; trial < TRIALS; trial++) {
        double sums[LOW_CELLS_MOST] = {0};
        for (size_t cell = 0; cell < LOW_CELLS_MOST; cell++)
            for (int n = 0; n < EACH; n++)
                sums[cell] += (double)(next_word(&seed) >> 11) * 0x1p-53 - 0.5;
        mean += low_modes_variance(&modes, sums, LOW_CELLS_MOST * EACH) / TRIALS;
    }
    /* each trial has 20 degrees of freedom: a standard error of sqrt(2/20)/20 */
    check_relative(mean * 12 * LOW_CELLS_MOST * EACH, 1, 4 * sqrt(0.1 / TRIALS));
    check_close(low_modes_factor(10), 2.2281, 1e-4);
}

/* Of independent numbers in a part of the map alone, waves weighed by their variance over this part
 * estimate the variance of the mean over it. */
static void variance_within_a_part(void **state) {
    (void)state;
    uint64_t seed = seed_or(4);
    static struct low_modes modes;
    const struct measured_map map = {&SQUARE, NULL, BOUNDARY_OPEN};
    double counts[LOW_CELLS_MOST], all[LOW_CELLS_MOST], mean = 0, n = 0;
    enum { TRIALS = 400, EACH = 16 };
    assert_true(low_modes_fill(&map, NULL, &modes));
    for (size_t cell = 0; cell < LOW_CELLS_MOST; cell++) {
        const size_t x = cell % modes.cells_x, y = cell / modes.cells_x;
        counts[cell] = x >= 2 && x < 14 && y >= 2 && y < 14 ? EACH : 0;
        all[cell] = EACH;
        n += counts[cell];
    }
    for (size_t m = 0; m < modes.count; m++)
        check_close(low_mode_weight(&modes, m, all), 1, 1e-9);
    for (int trial = 0; trial < TRIALS; trial++) {
        double sums[LOW_CELLS_MOST] = {0}, total = 0;
        for (size_t cell = 0; cell < LOW_CELLS_MOST; cell++)
            for (int k = 0; k < counts[cell]; k++) {
                const double value = (double)(next_word(&seed) >> 11) * 0x1p-53 - 0.5;
                sums[cell] += value;
                total += value;
            }
        for (size_t cell = 0; cell < LOW_CELLS_MOST; cell++)
            sums[cell] -= total * counts[cell] / n;
        mean += low_modes_variance_within(&modes, sums, counts, n) / TRIALS;
    }
    /* 19 waves, which are nearly independent over three quarters of the sides */
    check_relative(mean * 12 * n, 1, 5 * sqrt(2. / 19 / TRIALS));
}

/* Fills a map with the sums of independent numbers over squares. */
static void squares_fill(uint64_t *seed, double *z) {
    enum { SIDE = 64, SQUARE_SIDE = 4, WHOLE = SIDE + SQUARE_SIDE };
    static double noise[WHOLE * WHOLE];
    noise_fill(seed, (size_t)WHOLE * WHOLE, noise);
    for (size_t j = 0; j < SIDE; j++)
        for (size_t i = 0; i < SIDE; i++) {
            z[j * SIDE + i] = 0;
            for (size_t b = 0; b < SQUARE_SIDE; b++)
                for (size_t a = 0; a < SQUARE_SIDE; a++)
                    z[j * SIDE + i] += noise[(j + b) * WHOLE + i + a];
        }
}

/* Fills the sums over cells of what squared differences over a lag are more than their mean, over
 * that mean. */
static void deviations_fill(const struct cell_differences *d, double *out) {
    double n = 0, mean = 0;
    for (size_t cell = 0; cell < LOW_CELLS_MOST; cell++) {
        n += d->count[cell];
        mean += d->slope[cell];
    }
    for (size_t cell = 0; cell < LOW_CELLS_MOST; cell++)
        out[cell] = (d->slope[cell] - d->count[cell] * mean / n) / mean;
}

/* Differences over an eighth of the side are known in a part of the map, and alike over much of it:
 * of 19 waves far fewer are independent. Their variance scatters from map to map as one of the
 * degrees of freedom that are stated. */
static void freedom_over_a_lag(void **state) {
    (void)state;
    enum { TRIALS = 240, LAG = 8, LOOKS = 10 };
    uint64_t seed = seed_or(8);
    static struct low_modes modes;
    static struct cell_differences differences;
    static double z[64 * 64];
    const struct grid grid = {64, 64, 64, 64};
    const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    double sum = 0, square = 0, freedom = 0, nearest = 0;
    assert_true(low_modes_fill(&map, NULL, &modes));
    for (int trial = 0; trial < TRIALS; trial++) {
        double deviations[LOW_CELLS_MOST];
        struct correlation *correlation = NULL;
        squares_fill(&seed, z);
        cell_differences_measure(&map, &modes, LAG, &differences);
        deviations_fill(&differences, deviations);
        const double variance = low_modes_variance_within(&modes, deviations, differences.count, 1);
        sum += variance;
        square += variance * variance;
        if (trial >= LOOKS)
            continue;
        assert_int_equal(correlation_create(&correlation, &map, NULL), 0);
        freedom += low_modes_freedom_slopes(&modes, correlation, &grid, LAG, differences.count);
        cell_differences_measure(&map, &modes, 1, &differences);
        nearest += low_modes_freedom_slopes(&modes, correlation, &grid, 1, differences.count);
        correlation_destroy(&correlation);
    }
    freedom /= LOOKS;
    nearest /= LOOKS;
    const double mean = sum / TRIALS, found = 2 / (square / TRIALS / (mean * mean) - 1);
    print_message("stated %.1f, of neighbours %.1f, found %.1f\n", freedom, nearest, found);
    assert_true(nearest > 17 && nearest <= 19 && freedom < 14);
    /* squares of differences scatter a little more than a Gaussian field */
    check_relative(found, freedom, 4 * sqrt((2 + 12 / freedom) / TRIALS));
    check_relative(low_modes_factor_over(&modes, 10), 2.2281 / low_modes_factor(19), 1e-4);
}

static void heights_by_cell(void **state) {
    (void)state;
    uint64_t seed = seed_or(4);
    const struct grid grid = {70, 33, 1, 1};
    double z[70 * 33], sum[LOW_CELLS_MOST] = {0}, below[LOW_CELLS_MOST] = {0};
    for (size_t point = 0; point < 70 * 33; point++)
        z[point] = point % 50 == 0 ? (double)NAN : 3 + (double)(next_word(&seed) >> 11) * 0x1p-53;
    const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    static struct low_modes modes;
    struct cell_heights *heights = NULL;
    assert_true(low_modes_fill(&map, NULL, &modes));
    assert_int_equal(cell_heights_create(&heights, &map, &modes, NULL), 0);
    assert_int_equal(heights->levels, HEIGHT_LEVELS);
    check_close(heights->mean, 3.5, 0.03);
    check_relative(heights->rms, sqrt(1.0 / 12), 0.05);
    size_t l = 40;
    double count = 0;
    for (size_t point = 0; point < 70 * 33; point++) {
        size_t cell = point / 70 * 16 / 33 * 16 + point % 70 * 16 / 70;
        if (isnan(z[point]))
            continue;
        sum[cell] += pow(z[point] - heights->mean, 3);
        below[cell] += z[point] < heights->level[l] ? 1 : 0;
        count += z[point] < heights->level[l] ? 1 : 0;
    }
    check_close(heights->share[l], count / heights->count, 1e-12);
    check_close(heights->share[l], 41.0 / 128, 2e-3);
    for (size_t cell = 0; cell < LOW_CELLS_MOST; cell++) {
        check_close(heights->power[3][cell], sum[cell], 1e-9);
        check_close(heights->below[cell * heights->levels + l], below[cell], 0);
    }
    assert_false(heights->untilted);
    cell_heights_destroy(&heights);
    struct trend trend;
    assert_int_equal(detrend(&grid, z, DETREND_PLANE, &trend, NULL), 0);
    assert_int_equal(cell_heights_create(&heights, &map, &modes, NULL), 0);
    assert_true(heights->untilted);
    cell_heights_destroy(&heights);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waves_are_orthonormal), cmocka_unit_test(variance_of_a_mean),
        cmocka_unit_test(variance_within_a_part), cmocka_unit_test(freedom_over_a_lag),
        cmocka_unit_test(heights_by_cell)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
