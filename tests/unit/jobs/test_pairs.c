/* Differences of two cases by pairs of realisations: estimates computed by hand, and of contact and
 * statistics those that the realisations themselves give, however they were split into blocks. */
#include "jobs/estimate.h"
#include "jobs/pairs.h"
#include "jobs/realisations.h"
#include "jobs/runner.h"
#include "schema/result/total.h"
#include "tests/support/check.h"
#include "tests/support/scalar_of.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- by hand --- */

static void plain_pairs(void **state) {
    (void)state;
    static const double a[] = {1, NAN, 2, 4, 9}, b[] = {0, 5, 1, 1, NAN};
    const struct estimate_column one = {a, NULL}, other = {b, NULL};
    /* of 1, 1, 3 */
    struct pair_estimate estimate = estimate_pairs(5, &one, &other);
    assert_int_equal(estimate.pairs, 3);
    check_close(estimate.value, 5.0 / 3, 1e-15);
    check_close(estimate.standard_error, 2.0 / 3, 1e-15);
    check_close(estimate.deviation, 2 / sqrt(3), 1e-15);
    assert_true(isnan(estimate_pairs(1, &one, &other).standard_error));
    assert_true(isnan(estimate_pairs(0, &one, &other).value));
}

/* Student's quantiles of 97.5 % by tables: 12.7062 with one degree of freedom, 4.30265 with two;
 * the normal one is 1.959964. */
static void few_values_have_wider_errors(void **state) {
    (void)state;
    const struct estimate mean = {3, 0.1};
    check_close(estimate_of_few(mean, 2).standard_error, 0.1 * 12.7062 / 1.959964, 1e-5);
    check_close(estimate_of_few(mean, 3).standard_error, 0.1 * 4.30265 / 1.959964, 1e-5);
    check_close(estimate_of_few(mean, 100000).standard_error, 0.1, 1e-5);
    assert_true(estimate_of_few(mean, 2).value == 3);
    assert_true(isnan(estimate_of_few(mean, 1).value));
    assert_true(isnan(estimate_of_few(mean, 0).standard_error));
}

/* Means 14/4 and 3/2; their linear parts -3/4, 3/4 and -1/2, 1/2 differ by -1/4, 1/4. */
static void weighed_pairs(void **state) {
    (void)state;
    static const double a[] = {2, 7, 4}, weight[] = {1, 0, 3}, b[] = {1, 9, 2};
    const struct estimate_column one = {a, weight}, other = {b, NULL};
    struct pair_estimate estimate = estimate_pairs(3, &one, &other);
    assert_int_equal(estimate.pairs, 2);
    check_close(estimate.value, 2, 1e-15);
    check_close(estimate.standard_error, 0.25, 1e-15);
}

/* Ratios 8/4 and 6/8, mean things 4/3 and 8/3: residuals (-1, 2, -1)/(4/3) and (3/2, -3/4,
 * -3/4)/(8/3) differ by -21/16, 57/32 and -15/32. The group without things in either case is none.
 */
static void pairs_of_groups(void **state) {
    (void)state;
    static const double a[] = {1, 0, 4, 3}, a_things[] = {1, 0, 1, 2};
    static const double b[] = {3, 0, 3, 0}, b_things[] = {2, 0, 5, 1};
    const struct estimate_groups one = {a, a_things}, other = {b, b_things};
    struct pair_estimate estimate = estimate_group_pairs(4, &one, &other);
    assert_int_equal(estimate.pairs, 3);
    check_close(estimate.value, 2 - 0.75, 1e-15);
    double squares = pow(21.0 / 16, 2) + pow(57.0 / 32, 2) + pow(15.0 / 32, 2);
    check_close(estimate.standard_error, sqrt(squares / 2 / 3), 1e-14);
    assert_true(isnan(estimate_group_pairs(2, &one, &other).standard_error));
}

/* --- by realisations --- */

enum { REALISATIONS = 9, SEED = 5 };
#define CONTACT(hurst, loads)                                                                      \
    "{\"surface\": {\"dimension\": 1, \"hurst\": " hurst ", \"wavelength_ratio\": 4,"              \
    " \"length_ratio\": 2, \"rms_slope\": 0.1}, \"contact\": {\"model\": [\"layered\","            \
    " \"halfspace\"], \"levels\": [4, 8], \"cell_error\": \"none\", \"pressures\": "               \
    "{\"values\": " loads "},"                                                                     \
    " \"pressure_pdf\": {\"at\": [0.1], \"bins\": [0, 1, 4]}}}"
#define SKEWED(hurst)                                                                              \
    "{\"surface\": {\"hurst\": " hurst ", \"wavelength_ratio\": 4, \"length_ratio\": 2,"           \
    " \"points_per_wavelength\": 4, \"heights\": {\"distribution\": \"weibull_max\", \"shape\":"   \
    " 2}}, \"statistics\": {\"bins\": {\"height\": [-2, 4, 12], \"curvature\": [-9, -1, 8]}}}"
#define STATISTICS(hurst)                                                                          \
    "{\"surface\": {\"dimension\": 1, \"hurst\": " hurst ", \"wavelength_ratio\": 4,"              \
    " \"length_ratio\": 4}, \"statistics\": {\"bins\": {\"height\": [-4, 8, 12]}}}"

struct side {
    struct job_merger *merger;
    struct case_result result;
};

static struct job_merger *merger_of(const char *kind, const char *text) {
    struct error err = {0};
    struct job_merger *merger = NULL;
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    if (merger_create(&merger, kind_find(kind), parameters, &err) != 0)
        fail_msg("%s", err.text);
    cJSON_Delete(parameters);
    return merger;
}

static void add_block(struct job_merger *merger, const char *kind, const char *text, uint64_t first,
                      uint64_t count) {
    struct error err = {0};
    struct job_runner *runner = NULL;
    struct block_result block = {0};
    cJSON *parameters = cJSON_Parse(text);
    if (runner_create(&runner, kind_find(kind), parameters, NULL, SEED, 0, &err) != 0 ||
        runner_run(runner, first, count, NULL, &block, &err) != 0 ||
        merger_add(merger, &block, &err) != 0)
        fail_msg("%s", err.text);
    block_result_clear(&block);
    runner_destroy(&runner);
    cJSON_Delete(parameters);
}

/* first: of REALISATIONS in all, in two blocks that are merged in the wrong order. */
static struct side side_of(const char *kind, const char *text, uint64_t first, uint64_t split) {
    struct error err = {0};
    struct side side = {.merger = merger_of(kind, text)};
    add_block(side.merger, kind, text, first + split, REALISATIONS - split);
    add_block(side.merger, kind, text, first, split);
    assert_int_equal(merger_result(side.merger, &side.result, &err), 0);
    return side;
}

/* One realisation alone. */
static struct case_result single(const char *kind, const char *text, uint64_t realisation) {
    struct error err = {0};
    struct case_result result = {0};
    struct job_merger *merger = merger_of(kind, text);
    add_block(merger, kind, text, realisation, 1);
    assert_int_equal(merger_result(merger, &result, &err), 0);
    merger_destroy(&merger);
    return result;
}

static struct case_result subtract(const struct side *a, const struct side *b, bool common) {
    struct error err = {0};
    struct case_result out = {0};
    if (pairs_difference(a->merger, &a->result, b->merger, &b->result, common, &out, &err) != 0)
        fail_msg("%s", err.text);
    return out;
}

static void side_clear(struct side *side) {
    merger_destroy(&side->merger);
    result_clear(&side->result);
}

static const struct curve *curve_like(const struct case_result *result, const struct curve *like) {
    for (size_t a = 0; a < result->curve_count; a++)
        if (curve_same_series(&result->curves[a], like) &&
            same_text(result->curves[a].model, like->model) &&
            same_number(result->curves[a].level, like->level))
            return &result->curves[a];
    fail_msg("no curve %s", like->quantity);
    return NULL;
}

static const char A[] = CONTACT("0.8", "[0.02, 0.1, 0.3]");
static const char B[] = CONTACT("0.7", "[0.03, 0.1, 0.2, 0.3]");

/* Over the seven realisations that both have, at the two loads that both have. */
static void contact_by_its_realisations(void **state) {
    (void)state;
    enum { COMMON = 7 };
    struct side a = side_of("contact", A, 0, 4), b = side_of("contact", B, 2, 5);
    struct case_result out = subtract(&a, &b, true), one[COMMON], other[COMMON];
    size_t paired = 0;
    for (uint64_t r = 0; r < COMMON; r++) {
        one[r] = single("contact", A, r + 2);
        other[r] = single("contact", B, r + 2);
    }
    assert_int_equal(out.realisations, COMMON);
    for (size_t c = 0; c < out.curve_count; c++) {
        const struct curve *curve = &out.curves[c];
        if (!curve->paired)
            continue;
        paired++;
        assert_int_equal(curve->n, 2);
        check_close(curve->x[0], 0.1, 1e-12);
        for (size_t k = 0; k < 2; k++) {
            double difference[COMMON];
            for (size_t r = 0; r < COMMON; r++)
                difference[r] = curve_like(&one[r], curve)->y[k + 1] -
                                curve_like(&other[r], curve)->y[2 * k + 1];
            struct estimate mean = estimate_mean(COMMON, difference);
            check_close(curve->y[k], mean.value, 1e-12);
            check_close(curve->standard_error[k], mean.standard_error, 1e-12);
            assert_true(mean.standard_error > 0);
        }
    }
    assert_int_equal(paired, 2 * 5); /* areas by edges, edges_stretched and nodes, gap, stiffness */
    for (size_t r = 0; r < COMMON; r++) {
        result_clear(&one[r]);
        result_clear(&other[r]);
    }
    result_clear(&out);
    side_clear(&a);
    side_clear(&b);
}

/* Over the same realisations a difference is that of the cases' values, with a smaller error. */
static void scalars_are_those_told(void **state) {
    (void)state;
    static const struct {
        const char *kind, *a, *b, *names[7];
    } CASES[] = {{"contact", A, B, {"kappa", "power_law_b", "contact_area_last", "kurtosis", NULL}},
                 {"statistics",
                  STATISTICS("0.8"),
                  STATISTICS("0.7"),
                  {"lowest", "summit_height_mean", "summit_height_variance",
                   "summit_height_skewness", "summit_height_kurtosis", "summits", NULL}}};
    for (size_t c = 0; c < 2; c++) {
        struct side a = side_of(CASES[c].kind, CASES[c].a, 0, 4);
        struct side b = side_of(CASES[c].kind, CASES[c].b, 0, 2);
        struct case_result pairs = subtract(&a, &b, true), apart = subtract(&a, &b, false);
        for (size_t s = 0; CASES[c].names[s] != NULL; s++) {
            const char *name = CASES[c].names[s];
            const struct scalar *scalar = scalar_of(&pairs, name), *other = scalar_of(&apart, name);
            double told = scalar_of(&a.result, name)->value - scalar_of(&b.result, name)->value;
            assert_true(scalar->difference && scalar->paired && !other->paired);
            check_close(scalar->value, told, 1e-12);
            check_close(other->value, told, 0);
            check_close(other->standard_error,
                        hypot(scalar_of(&a.result, name)->standard_error,
                              scalar_of(&b.result, name)->standard_error),
                        0);
            assert_true(scalar->standard_error < other->standard_error);
        }
        result_clear(&pairs);
        result_clear(&apart);
        side_clear(&a);
        side_clear(&b);
    }
}

/* Up to 32 realisations are groups of their own: a density's error is that of the differences of
 * single realisations, less than that of the two cases apart. Bins in which fewer than ten of them
 * have a value have the latter. */
static void densities_by_groups(void **state) {
    (void)state;
    enum { ALL = 30 };
    static const char one[] = STATISTICS("0.8"), other[] = STATISTICS("0.7");
    struct error err = {0};
    struct side a = {.merger = merger_of("statistics", one)};
    struct side b = {.merger = merger_of("statistics", other)};
    struct case_result singles[2][ALL];
    add_block(a.merger, "statistics", one, 0, ALL);
    add_block(b.merger, "statistics", other, 7, ALL - 7);
    add_block(b.merger, "statistics", other, 0, 7);
    assert_int_equal(merger_result(a.merger, &a.result, &err), 0);
    assert_int_equal(merger_result(b.merger, &b.result, &err), 0);
    struct case_result out = subtract(&a, &b, true);
    for (uint64_t r = 0; r < ALL; r++) {
        singles[0][r] = single("statistics", one, r);
        singles[1][r] = single("statistics", other, r);
    }
    const char *name = "summit_height_pdf";
    const struct curve *curve = result_curve(&out, name);
    const struct curve *told = result_curve(&a.result, name), *less = result_curve(&b.result, name);
    size_t by_pairs = 0, apart = 0;
    assert_true(curve != NULL && curve->paired && curve->n == 12);
    for (size_t k = 0; k < curve->n; k++) {
        double counts[2][ALL], things[2][ALL];
        size_t telling[2] = {0, 0};
        for (size_t c = 0; c < 2; c++)
            for (size_t r = 0; r < ALL; r++) {
                things[c][r] = 2 * scalar_of(&singles[c][r], "summits")->value;
                counts[c][r] = result_curve(&singles[c][r], name)->y[k] * things[c][r];
                telling[c] += counts[c][r] > 0;
            }
        const struct estimate_groups left = {counts[0], things[0]}, right = {counts[1], things[1]};
        double expected = estimate_group_pairs(ALL, &left, &right).standard_error;
        double both = hypot(told->standard_error[k], less->standard_error[k]);
        bool few = telling[0] < 10 || telling[1] < 10;
        check_close(curve->y[k], told->y[k] - less->y[k], 1e-12);
        check_close(curve->standard_error[k], few ? both : expected, 1e-12);
        assert_true(curve->standard_error[k] > 0);
        by_pairs += !few && expected < both;
        apart += few;
    }
    assert_true(by_pairs >= 3 && apart >= 3);
    for (size_t r = 0; r < ALL; r++) {
        result_clear(&singles[0][r]);
        result_clear(&singles[1][r]);
    }
    result_clear(&out);
    side_clear(&a);
    side_clear(&b);
}

/* Curves of pits are known by pairs as those of summits are, with errors that add up to less than
 * those of two cases apart. They are as certain as 32 groups are, of the 40 realisations; cases
 * apart have the freedom of both. */
static void pits_go_by_pairs(void **state) {
    (void)state;
    static const char one[] = SKEWED("0.8"), other[] = SKEWED("0.75");
    static const char *const QUANTITIES[] = {"summit_height_pdf", "summit_height_cdf",
                                             "summit_mean_curvature", "summit_curvature_pdf"};
    struct error err = {0};
    struct side a = {.merger = merger_of("statistics", one)};
    struct side b = {.merger = merger_of("statistics", other)};
    add_block(a.merger, "statistics", one, 0, 40);
    add_block(b.merger, "statistics", other, 0, 40);
    assert_int_equal(merger_result(a.merger, &a.result, &err), 0);
    assert_int_equal(merger_result(b.merger, &b.result, &err), 0);
    struct case_result out = subtract(&a, &b, true), apart = subtract(&a, &b, false);
    size_t paired = 0;
    for (size_t c = 0; c < out.curve_count; c++) {
        const struct curve *curve = &out.curves[c];
        double by_pairs = 0, not_by_pairs = 0, most = 0, most_apart = 0;
        if (strcmp(curve->series, "pits") != 0)
            continue;
        assert_true(curve->paired && !curve_like(&apart, curve)->paired);
        for (size_t q = 0; q < sizeof QUANTITIES / sizeof *QUANTITIES; q++)
            paired += strcmp(curve->quantity, QUANTITIES[q]) == 0;
        for (size_t k = 0; k < curve->n; k++) {
            double error = curve->standard_error[k];
            by_pairs += isnan(error) ? 0 : error;
            not_by_pairs += isnan(error) ? 0 : curve_like(&apart, curve)->standard_error[k];
            most = fmax(most, curve->effective[k]);
            most_apart = fmax(most_apart, curve_sampled_at(curve_like(&apart, curve), k));
        }
        assert_true(by_pairs > 0 && by_pairs < not_by_pairs);
        check_close(most, 32, 0);
        assert_true(most_apart > 60 && most_apart <= 2 * 40 - 1);
    }
    assert_int_equal(paired, 4);
    assert_true(scalar_of(&out, "pit_height_skewness")->paired);
    result_clear(&out);
    result_clear(&apart);
    side_clear(&a);
    side_clear(&b);
}

static void cases_without_a_pair_are_refused(void **state) {
    (void)state;
    struct error err = {0};
    struct case_result out = {0};
    struct side a = side_of("contact", A, 0, 4), b = side_of("contact", B, REALISATIONS, 4);
    assert_int_equal(pairs_difference(a.merger, &a.result, b.merger, &b.result, true, &out, &err),
                     ERROR_INPUT);
    assert_non_null(strstr(err.text, "no realisation in common"));
    side_clear(&a);
    side_clear(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(few_values_have_wider_errors),
        cmocka_unit_test(plain_pairs),
        cmocka_unit_test(weighed_pairs),
        cmocka_unit_test(pairs_of_groups),
        cmocka_unit_test(contact_by_its_realisations),
        cmocka_unit_test(densities_by_groups),
        cmocka_unit_test(scalars_are_those_told),
        cmocka_unit_test(pits_go_by_pairs),
        cmocka_unit_test(cases_without_a_pair_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
