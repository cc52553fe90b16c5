/* Protects: the quantiles of a map's heights, which a study takes as heights of one's own: that
 * they are those of its heights, without its holes, and as many as the map determines. */
#include "core/statistics/heights/height_quantiles.h"
#include "core/surface/heights.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <math.h>
#include <stdlib.h>

enum { NX = 50, NY = 40, POINTS = NX * NY, HOLES = 500, HEIGHTS = POINTS - HOLES };

/* The quantiles of a Weibull distribution, scattered over a map of which a quarter is holes. */
static void fill(double z[POINTS], const struct heights *heights) {
    struct height_moments moments;
    assert_int_equal(heights_moments(heights, &moments, NULL), 0);
    size_t taken = 0;
    for (size_t i = 0; i < POINTS; i++) {
        size_t place = i * 1999 % POINTS; /* 1999 is prime: every index once */
        z[place] = (double)NAN;
        if (place % 4 == 3)
            continue;
        z[place] = heights_quantile(heights, &moments, ((double)taken + 0.5) / HEIGHTS);
        taken++;
    }
    assert_int_equal(taken, HEIGHTS);
}

static void quantiles_are_those_of_the_heights(void **state) {
    (void)state;
    static double z[POINTS];
    double probability[200], quantile[200];
    const struct grid grid = {NX, NY, NX, NY};
    const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    const struct heights heights = {.type = HEIGHTS_WEIBULL_MAX, .shape = 1.5};
    size_t count = height_quantiles_count(HEIGHTS);
    fill(z, &heights);
    assert_int_equal(count, 49); /* scores up to 2.4: 10 of 1500 lie beyond 2.475 */
    assert_int_equal(height_quantiles_measure(&map, HEIGHTS, probability, quantile, NULL), 0);
    struct height_moments moments;
    assert_int_equal(heights_moments(&heights, &moments, NULL), 0);
    for (size_t a = 0; a < count; a++)
        check_close(quantile[a], heights_quantile(&heights, &moments, probability[a]), 1e-3);
    check_close(probability[count / 2], 0.5, 1e-15);
    assert_true(probability[0] * HEIGHTS >= 10 && probability[0] * HEIGHTS < 14);
    check_close(probability[0] + probability[count - 1], 1, 1e-15);
    /* Taken as a distribution they are the one that the heights are of. */
    struct height_table *table = NULL;
    struct height_moments again;
    assert_int_equal(height_table_of_quantiles(&table, count, probability, quantile, NULL), 0);
    height_table_moments(table, &again);
    check_close(again.skewness, moments.skewness, 0.05); /* ten heights beyond: not known */
    check_close(again.kurtosis, moments.kurtosis, 0.3);
    height_table_destroy(&table);
}

static int by_value(const void *a, const void *b) {
    double one = *(const double *)a, other = *(const double *)b;
    return (one > other) - (one < other);
}

/* Quantiles lie between two heights in order, of any number of heights, equal ones too. */
static void they_lie_between_heights_in_order(void **state) {
    (void)state;
    uint64_t words = seed_of_now();
    for (size_t n = 50; n < POINTS; n += n < 70 ? 1 : n / 3) {
        double z[POINTS], sorted[POINTS], probability[200], quantile[200];
        const struct grid grid = {n, 1, (double)n, 1};
        const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
        for (size_t i = 0; i < n; i++)
            sorted[i] = z[i] = (double)(next_word(&words) % 1000);
        qsort(sorted, n, sizeof *sorted, by_value);
        assert_int_equal(height_quantiles_measure(&map, n, probability, quantile, NULL), 0);
        for (size_t a = 0; a < height_quantiles_count(n); a++) {
            double position = probability[a] * (double)n - 0.5;
            const double *below = sorted + (size_t)position;
            double part = position - floor(position);
            check_close(quantile[a], below[0] + part * (below[1] - below[0]), 1e-12);
        }
    }
}

static void few_heights_have_none(void **state) {
    (void)state;
    assert_int_equal(height_quantiles_count(0), 0);
    assert_int_equal(height_quantiles_count(49), 0);
    assert_int_equal(height_quantiles_count(50), 17);
    assert_int_equal(height_quantiles_count((size_t)1 << 31), 115);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantiles_are_those_of_the_heights),
        cmocka_unit_test(they_lie_between_heights_in_order),
        cmocka_unit_test(few_heights_have_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
