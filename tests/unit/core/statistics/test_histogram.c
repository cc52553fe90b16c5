/* Protects: no value is lost at a bin's edge, outside the bins or as NaN; exact sums have the same
 * bits in any order. */
#include "core/statistics/heights/histogram.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdlib.h>

static const struct bins BINS = {-1, 1, 4};

static void edges_belong_above(void **state) {
    (void)state;
    assert_int_equal(bins_find(&BINS, -1), 1);
    assert_int_equal(bins_find(&BINS, -0.5), 2);
    assert_int_equal(bins_find(&BINS, 0), 3);
    assert_int_equal(bins_find(&BINS, 1), 4);
}

static void outside_is_counted(void **state) {
    (void)state;
    const double values[] = {-2, -INFINITY, nextafter(-1, -2), 5, INFINITY, NAN, nextafter(1, 2)};
    uint64_t counts[6] = {0};
    histogram_add(&BINS, 7, values, 1, counts);
    const uint64_t expected[6] = {3, 0, 0, 0, 0, 4};
    assert_memory_equal(counts, expected, sizeof counts);
}

static void values_are_scaled(void **state) {
    (void)state;
    const double values[] = {1.5, 7};
    uint64_t counts[6] = {0};
    histogram_add(&BINS, 2, values, 0.5, counts);
    assert_int_equal(counts[4], 1);
    assert_int_equal(counts[5], 1);
}

/* A deterministic generator: the test needs spread, not quality. */
static double spread(uint64_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return ldexp((double)(int64_t)*seed, -63 + (int)(*seed >> 5 & 15));
}

enum { VALUES = 1000000 };

static void sum_is_the_same_in_any_order(void **state) {
    (void)state;
    double *values = malloc(VALUES * sizeof *values);
    assert_non_null(values);
    uint64_t seed = seed_or(42);
    for (size_t i = 0; i < VALUES; i++)
        values[i] = spread(&seed);
    struct exact_sum forward = {0}, backward = {0}, parts[7] = {{0}}, merged = {0};
    for (size_t i = 0; i < VALUES; i++) {
        exact_sum_add(&forward, values[i]);
        exact_sum_add(&backward, values[VALUES - 1 - i]);
        exact_sum_add(&parts[i * i % 7], values[i]);
    }
    for (size_t p = 7; p-- > 0;)
        exact_sum_merge(&merged, &parts[p]);
    assert_true(forward.total == backward.total && forward.total == merged.total);
    assert_int_equal(merged.lost, 0);
    free(values);
}

static void a_million_additions_lose_nothing(void **state) {
    (void)state;
    struct exact_sum sum = {0};
    for (size_t i = 0; i < VALUES; i++)
        exact_sum_add(&sum, 0.1);
    /* each term is rounded to 2^-60, half a unit at most: a million of them to 5e-13 */
    check_close(exact_sum_value(&sum), 0.1 * VALUES, 5e-13 + 1e-11);
}

/* Small values take a shorter conversion: both round to the nearest unit, halves to even. */
static void small_values_have_the_units_of_large_ones(void **state) {
    (void)state;
    static const double VALUES_ABOUT[] = {
        0,  0x1p-61, 0x1.8p-60, 0x1.4p-59, 0.1, M_PI, 0x1.fffffffffffffp1, 4, 0x1.0000000000001p2,
        1e9};
    for (size_t a = 0; a < sizeof VALUES_ABOUT / sizeof *VALUES_ABOUT; a++)
        for (int sign = -1; sign <= 1; sign += 2) {
            struct exact_sum sum = {0};
            double value = sign * VALUES_ABOUT[a];
            exact_sum_add(&sum, value);
            assert_true(sum.lost == 0 && sum.total == (fixed_point)rint(value * 0x1p60));
        }
}

static void what_does_not_fit_is_told(void **state) {
    (void)state;
    struct exact_sum sum = {0};
    exact_sum_add(&sum, NAN);
    exact_sum_add(&sum, INFINITY);
    exact_sum_add(&sum, 0x1p60);
    assert_int_equal(sum.lost, 3);
    for (int i = 0; i < 300; i++)
        exact_sum_add(&sum, 0x1.8p59);
    assert_true(sum.lost > 3);
    assert_true(exact_sum_value(&sum) > 0); /* no wrap-around */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edges_belong_above),
        cmocka_unit_test(outside_is_counted),
        cmocka_unit_test(values_are_scaled),
        cmocka_unit_test(sum_is_the_same_in_any_order),
        cmocka_unit_test(a_million_additions_lose_nothing),
        cmocka_unit_test(small_values_have_the_units_of_large_ones),
        cmocka_unit_test(what_does_not_fit_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
