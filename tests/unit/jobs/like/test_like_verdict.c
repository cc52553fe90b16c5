/* Protects: the p-value of a measured surface that is one of its sub-maps is uniform on its steps;
 * one that is not has the least p-value, and the quantity in which it is not differs most; missing
 * and constant values count for nothing. */
#include "jobs/like/like_verdict.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <math.h>

enum { Q = PATCH_QUANTITY_COUNT, OTHERS = 19, STEPS = OTHERS + 1, DRAWS = 2000 };

static double uniform(uint64_t *seed) {
    return (double)(next_word(seed) >> 11) * 0x1p-53;
}

/* A patch: quantities with a common part, some of which have long tails. */
static void draw_patch(uint64_t *seed, double patch[Q]) {
    double common = uniform(seed);
    for (size_t q = 0; q < Q; q++) {
        double own = uniform(seed);
        patch[q] = q % 3 == 0 ? -log(1 - own) * 5 : common + own;
    }
}

static void draw_others(uint64_t *seed, double values[Q * OTHERS]) {
    for (size_t r = 0; r < OTHERS; r++) {
        double patch[Q];
        draw_patch(seed, patch);
        for (size_t q = 0; q < Q; q++)
            values[q * OTHERS + r] = patch[q];
    }
}

/* Each of the steps 1/20, 2/20, ... is as frequent: chi squared of 19 degrees of freedom is above
 * 43.8 once in a thousand times. */
static void one_of_them_is_uniform(void **state) {
    (void)state;
    uint64_t seed = seed_or(3);
    double found[STEPS] = {0}, square = 0;
    for (size_t d = 0; d < DRAWS; d++) {
        double values[Q * OTHERS], measured[Q];
        struct like_verdict verdict;
        draw_patch(&seed, measured);
        draw_others(&seed, values);
        assert_int_equal(like_verdict_measure(OTHERS, values, measured, &verdict, NULL), 0);
        found[lround(verdict.p_value * STEPS) - 1]++;
    }
    for (size_t s = 0; s < STEPS; s++)
        square += pow(found[s] - (double)DRAWS / STEPS, 2) / ((double)DRAWS / STEPS);
    print_message("chi squared %.1f of %d degrees of freedom\n", square, STEPS - 1);
    assert_true(square < 43.8);
}

static void another_is_found(void **state) {
    (void)state;
    uint64_t seed = seed_or(4);
    double values[Q * OTHERS], measured[Q];
    struct like_verdict verdict;
    draw_patch(&seed, measured);
    draw_others(&seed, values);
    measured[PATCH_SKEWNESS] = 80;
    assert_int_equal(like_verdict_measure(OTHERS, values, measured, &verdict, NULL), 0);
    check_close(verdict.p_value, 1. / STEPS, 1e-15);
    check_close(verdict.standard_error, sqrt(0.05 * 0.95 / OTHERS), 1e-15);
    for (size_t q = 0; q < Q; q++)
        assert_true(q == PATCH_SKEWNESS ||
                    fabs(verdict.difference[q]) < verdict.difference[PATCH_SKEWNESS]);
    /* of 20 values 19 of which are equal, the other one is sqrt(19) deviations away */
    for (size_t r = 0; r < OTHERS; r++)
        values[PATCH_SKEWNESS * OTHERS + r] = 1;
    assert_int_equal(like_verdict_measure(OTHERS, values, measured, &verdict, NULL), 0);
    check_close(verdict.difference[PATCH_SKEWNESS], sqrt(OTHERS), 1e-12);
}

static void what_is_missing_does_not_count(void **state) {
    (void)state;
    uint64_t seed = seed_or(5);
    double values[Q * OTHERS], measured[Q];
    struct like_verdict verdict, without;
    draw_patch(&seed, measured);
    draw_others(&seed, values);
    measured[PATCH_TEXTURE] = NAN;
    assert_int_equal(like_verdict_measure(OTHERS, values, measured, &without, NULL), 0);
    assert_true(isnan(without.difference[PATCH_TEXTURE]));
    measured[PATCH_TEXTURE] = 0.5; /* as in all others that have it */
    for (size_t r = 0; r < OTHERS; r++)
        values[PATCH_TEXTURE * OTHERS + r] = r % 2 == 0 ? 0.5 : NAN;
    assert_int_equal(like_verdict_measure(OTHERS, values, measured, &verdict, NULL), 0);
    assert_true(isnan(verdict.difference[PATCH_TEXTURE]));
    check_close(verdict.p_value, without.p_value, 0);
    assert_int_equal(like_verdict_measure(0, values, measured, &verdict, NULL), 0);
    assert_true(isnan(verdict.p_value) && isnan(verdict.standard_error));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_of_them_is_uniform),
        cmocka_unit_test(another_is_found),
        cmocka_unit_test(what_is_missing_does_not_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
