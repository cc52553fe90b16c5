/* The total interval of a value: its ends by hand, what it names as not known, and how often a
 * truth that lies within the stated errors lies in it. */
#include "schema/result/difference.h"
#include "schema/result/total.h"
#include "tests/support/check.h"
#include "tests/support/sample_result.h"
#include "tests/support/seed.h"

enum { DRAWS = 20000 };

static struct scalar_error known(double value, double bound) {
    return (struct scalar_error){.applies = true, .known = true, .value = value, .bound = bound};
}

/* Sources add up with their signs: of 3 +- 1 and -1 +- 2 the sum is -1 to 5. */
static void ends_are_those_of_the_sums(void **state) {
    (void)state;
    struct scalar_error errors[ERROR_SOURCES] = {
        [ERROR_CELL] = known(3, 1), [ERROR_MODEL] = known(-1, 2)};
    struct total total = total_of(10, 0.5, 0, errors);
    check_close(total.low, 10 - 5 - 0.98, 1e-14);
    check_close(total.high, 10 + 1 + 0.98, 1e-14);
    errors[ERROR_MODEL] = known(0, 0); /* 2 to 4: the truth is mostly below */
    total = total_of(10, 0.5, 0, errors);
    check_close(total.low, 10 - 4 - 0.98, 1e-14);
    check_close(total.high, 10 + 0.98, 1e-14);
}

/* What bears on a value and is not known is named, and leaves the rest as it is. */
static void unknown_sources_are_named(void **state) {
    (void)state;
    struct scalar_error errors[ERROR_SOURCES] = {
        [ERROR_BLOCK] = {.applies = true},
        [ERROR_CELL] = known(NAN, 1),
        [ERROR_MODEL] = known(2, NAN), /* its value counts, how far it holds is not known */
        [ERROR_SOLVER] = known(0, 1)};
    struct total total = total_of(10, NAN, 0, errors);
    check_close(total.low, 7, 0);
    check_close(total.high, 10, 0);
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        assert_int_equal(total.unknown[s], s == ERROR_BLOCK || s == ERROR_CELL || s == ERROR_MODEL);
    errors[ERROR_MODEL] = errors[ERROR_SOLVER] = (struct scalar_error){.applies = true};
    total = total_of(10, NAN, 0, errors);
    assert_true(isnan(total.low) && isnan(total.high) && total.unknown[ERROR_SOLVER]);
    total = total_of(10, 0, 0, errors);
    check_close(total.low, 10, 0); /* as far as is known */
    total = total_of(NAN, 1, 0, errors);
    assert_true(isnan(total.low) && isnan(total.high));
}

/* Returns a number of 0 to 1, without the ends. */
static double uniform(uint64_t *seed) {
    return ((double)(next_word(seed) >> 11) + 0.5) * 0x1p-53;
}

/* Box and Muller (1958). */
static double normal(uint64_t *seed) {
    double radius = sqrt(-2 * log(uniform(seed)));
    return radius * cos(6.283185307179586 * uniform(seed));
}

/* Each source errs by its value and a part of its bound: anything between the bounds, or, at the
 * worst, one end of all bounds. */
static double drawn_error(const struct scalar_error *error, double at, uint64_t *seed) {
    double part = isnan(at) ? 2 * uniform(seed) - 1 : at;
    return error->applies ? error->value + part * error->bound : 0;
}

/* Realisations of one number: the interval is Student's, for 95 % of the truths whatever their
 * number, where 1.96 standard errors hold 70 % of two realisations and 93.5 % of twenty. */
static void few_realisations_cover(void **state) {
    (void)state;
    const struct scalar_error none[ERROR_SOURCES] = {{.applies = false}};
    static const size_t NUMBERS[] = {2, 3, 8, 20};
    const double far = 5 * sqrt(0.95 * 0.05 / DRAWS);
    uint64_t seed = seed_or(1908);
    for (size_t n = 0; n < sizeof NUMBERS / sizeof *NUMBERS; n++) {
        size_t inside = 0;
        for (size_t draw = 0; draw < DRAWS; draw++) {
            double sum = 0, squares = 0;
            const double count = (double)NUMBERS[n];
            for (size_t k = 0; k < NUMBERS[n]; k++) {
                double value = 3 + normal(&seed);
                sum += value;
                squares += value * value;
            }
            double variance = (squares - sum * sum / count) / (count - 1);
            const struct total total = total_of(sum / count, sqrt(variance / count), count, none);
            inside += total.low <= 3 && 3 <= total.high;
        }
        check_close((double)inside / DRAWS, 0.95, far);
    }
    check_close(total_deviations(1e9), 1.96, 1e-4);
    check_close(total_deviations(0), 1.96, 0);
}

/* Adds the mean of `count` draws of a scatter; returns its variance, of the mean. */
static double add_mean(size_t count, double scatter, double *sum, uint64_t *seed) {
    double values = 0, squares = 0;
    const double n = (double)count;
    for (size_t k = 0; k < count; k++) {
        double value = scatter * normal(seed);
        values += value;
        squares += value * value;
    }
    *sum += values / n;
    return (squares - values * values / n) / (n - 1) / n;
}

/* A sum of means, such as the answer of a target, is as certain as those of few realisations in it
 * are: by 57 realisations, 1.96 errors would hold 88 % of the truths. Welch's freedom is estimated,
 * so that the share is 0.95 to about 0.01. */
static void sums_of_means_cover(void **state) {
    (void)state;
    static const double REALISATIONS[] = {6, 50};
    const struct scalar_error none[ERROR_SOURCES] = {{.applies = false}};
    uint64_t seed = seed_or(1947);
    size_t inside = 0, by_all = 0;
    for (size_t draw = 0; draw < DRAWS; draw++) {
        double sum = 0, variances[2];
        variances[0] = add_mean(6, 3, &sum, &seed);
        variances[1] = add_mean(50, 1, &sum, &seed);
        const double effective = total_freedom(2, variances, REALISATIONS) + 1;
        const double error = sqrt(variances[0] + variances[1]);
        const struct total total = total_of(sum, error, effective, none);
        const struct total plain = total_of(sum, error, 6 + 50, none);
        inside += total.low <= 0 && 0 <= total.high;
        by_all += plain.low <= 0 && 0 <= plain.high;
    }
    check_close((double)inside / DRAWS, 0.95, 0.015);
    assert_true((double)by_all / DRAWS < 0.91);
    static const double ALIKE[] = {1, 1}, EXACT[] = {1, 0}, FEW[] = {3, 1};
    check_close(total_freedom(2, ALIKE, REALISATIONS), 4 / (1.0 / 5 + 1.0 / 49), 1e-14);
    check_close(total_freedom(2, EXACT, FEW), 2, 0); /* what is exact needs no realisations */
}

/* One realisation shows no scatter: what is known of other errors stands, and the rest is named. */
static void one_realisation_is_not_enough(void **state) {
    (void)state;
    const struct scalar_error errors[ERROR_SOURCES] = {[ERROR_CELL] = known(0, 1)};
    char names[TOTAL_NAMES_SIZE];
    const struct total total = total_of(10, NAN, 1, errors);
    check_close(total.high, 11, 0);
    assert_true(total_is_partial(&total));
    total_unknown_names(&total, names);
    assert_string_equal(names, "statistical");
    const struct total map = total_of(10, NAN, 0, errors), exact = total_of(10, 0, 1, errors);
    assert_false(total_is_partial(&map) || total_is_partial(&exact));
}

static double coverage(const struct scalar_error errors[ERROR_SOURCES], double at, uint64_t *seed) {
    static const double TRUTH = 3, ERROR = 0.25;
    size_t inside = 0;
    for (size_t draw = 0; draw < DRAWS; draw++) {
        double reported = TRUTH + ERROR * normal(seed);
        for (size_t s = 0; s < ERROR_SOURCES; s++)
            reported += drawn_error(&errors[s], at, seed);
        const struct total total = total_of(reported, ERROR, 0, errors);
        assert_true(total.low <= reported && reported <= total.high);
        inside += total.low <= TRUTH && TRUTH <= total.high;
    }
    return (double)inside / DRAWS;
}

/* The tolerance is five standard errors of a share of 0.95 among so many draws. */
static void truths_lie_within(void **state) {
    (void)state;
    const double least = 0.95 - 5 * sqrt(0.95 * 0.05 / DRAWS);
    static const double PLACES[] = {NAN, -1, 0, 1};
    uint64_t seed = seed_or(1959);
    for (size_t n = 0; n < 40; n++) {
        struct scalar_error errors[ERROR_SOURCES] = {{.applies = false}};
        for (size_t s = 0; s < n % (ERROR_SOURCES + 1); s++)
            errors[s] = known(2 * normal(&seed) * uniform(&seed), uniform(&seed));
        for (size_t p = 0; p < sizeof PLACES / sizeof *PLACES; p++) {
            double share = coverage(errors, PLACES[p], &seed);
            if (!(share >= least))
                fail_msg("errors %zu at %g: %g of the truths lie within", n, PLACES[p], share);
        }
    }
}

static void curves_and_scalars_have_totals(void **state) {
    (void)state;
    struct case_result sample;
    bool unknown[UNKNOWN_SOURCES];
    const double student = total_deviations(24);
    check_close(student, 2.068658, 1e-6); /* of 23 degrees of freedom (Student 1908) */
    sample_result(&sample);
    const struct curve *plain = &sample.curves[0], *matrix = &sample.curves[1];
    const struct curve *area = &sample.curves[2];
    check_close(curve_total(plain, 0).low, 3 - 0.1 * student, 1e-15);
    assert_true(isnan(curve_total(plain, 1).high));
    curve_unknown(plain, unknown);
    assert_true(unknown[ERROR_DISCRETISATION] && !unknown[ERROR_CELL]);
    check_close(curve_total(matrix, 0).low, 2 - 0.25 * student - 0.25, 1e-15); /* -0.5 +- 0.75 */
    check_close(curve_total(matrix, 0).high, 2 + 0.25 * student + 1.25, 1e-15);
    check_close(curve_total(matrix, 1).low, 6 - student - 1, 1e-15); /* 1 +- 0 */
    check_close(curve_total(matrix, 1).high, 6 + student, 1e-15);
    curve_unknown(matrix, unknown);
    assert_false(unknown[ERROR_DISCRETISATION]);
    check_close(curve_total(area, 0).low, -0.375, 1e-15); /* of the mesh alone */
    assert_true(curve_total(area, 0).unknown[ERROR_MODEL]);
    curve_unknown(area, unknown);
    assert_true(unknown[ERROR_BLOCK] && unknown[ERROR_MODEL] && !unknown[ERROR_DISCRETISATION]);
    check_close(curve_sampled_at(area, 0), 6.5, 0);
    const struct total m0 = scalar_total(&sample.scalars[0]);
    const double few = total_deviations(5.25); /* of 24 realisations this value has so many */
    check_close(m0.low, 1 - 0.5 * few, 1e-15); /* -0.5 +- 0.25 */
    check_close(m0.high, 1 + 0.5 * few + 0.75, 1e-15);
    assert_true(m0.unknown[ERROR_CELL]);
    result_clear(&sample);
}

/* 1 +- 0.5 less -2 +- 0.25 is 3 +- 0.75. Where one of the two is not known, neither is the
 * difference's. */
static void differences_have_totals(void **state) {
    (void)state;
    static const double X[] = {1}, Y[] = {20}, ERROR[] = {3}, OTHER[] = {4};
    static const double VALUE[] = {1}, BOUND[] = {0.5}, LESS[] = {-2}, LESS_BOUND[] = {0.25};
    struct case_result a = {.case_number = 1}, b = {0}, out = {0};
    struct curve curve = curve_named("area", "load", "A/A0");
    curve_set_points(&curve, 1, X, Y, ERROR);
    curve.errors[ERROR_CELL] = (struct curve_error){true, VALUE, BOUND, VALUE, NAN, false};
    assert_int_equal(result_add_curve(&a, &curve, NULL), 0);
    curve.standard_error = OTHER;
    curve.errors[ERROR_CELL] = (struct curve_error){true, LESS, LESS_BOUND, VALUE, NAN, false};
    curve.errors[ERROR_BLOCK].applies = true;
    assert_int_equal(result_add_curve(&b, &curve, NULL), 0);
    assert_int_equal(difference_make(&a, &b, NULL, &out, NULL), 0);
    const struct total total = curve_total(&out.curves[0], 0);
    check_close(total.low, 0 - 1.96 * 5 - 3.75, 1e-14);
    check_close(total.high, 0 + 1.96 * 5, 1e-14);
    assert_true(total.unknown[ERROR_BLOCK] && !total.unknown[ERROR_CELL]);
    result_clear(&a);
    result_clear(&b);
    result_clear(&out);
}

/* Independent cases of 3 and of 40 realisations, of which 37 have no value, are as certain as five
 * are; one without an error leaves the other its own. So it is with scalars. */
static void differences_have_their_freedom(void **state) {
    (void)state;
    static const double X[] = {1, 2}, Y[] = {20, 20}, ERROR[] = {3, 3}, OTHER[] = {3, 0};
    static const double LACKING[] = {37, 37};
    struct case_result a = {.case_number = 1}, b = {0}, out = {0};
    struct curve curve = curve_named("area", "load", "A/A0");
    struct scalar scalar = scalar_named("kappa", 2, 3, NAN);
    curve_set_points(&curve, 2, X, Y, ERROR);
    assert_int_equal(result_add_curve(&a, &curve, NULL), 0);
    assert_int_equal(result_add_scalar(&a, &scalar, NULL), 0);
    curve.standard_error = OTHER;
    curve.valueless = LACKING;
    scalar.effective = 3;
    assert_int_equal(result_add_curve(&b, &curve, NULL), 0);
    assert_int_equal(result_add_scalar(&b, &scalar, NULL), 0);
    result_sampled(&a, 3);
    result_sampled(&b, 40);
    assert_int_equal(difference_make(&a, &b, NULL, &out, NULL), 0);
    check_close(curve_sampled_at(&out.curves[0], 0), 1 + 4, 1e-14);
    check_close(curve_sampled_at(&out.curves[0], 1), 1 + 2, 1e-14);
    check_close(scalar_sampled(&out.scalars[0]), 1 + 4, 1e-14);
    result_clear(&a);
    result_clear(&b);
    result_clear(&out);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(ends_are_those_of_the_sums),
                                       cmocka_unit_test(unknown_sources_are_named),
                                       cmocka_unit_test(truths_lie_within),
                                       cmocka_unit_test(few_realisations_cover),
                                       cmocka_unit_test(sums_of_means_cover),
                                       cmocka_unit_test(one_realisation_is_not_enough),
                                       cmocka_unit_test(curves_and_scalars_have_totals),
                                       cmocka_unit_test(differences_have_totals),
                                       cmocka_unit_test(differences_have_their_freedom)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
