/* Protects: the law difference of statistics: that the surfaces of pairs are those of a study of
 * the other law with the same random numbers, that differences of scalars and curves follow from
 * the pairs, with their sign, and that there are none for Gaussian heights and from one pair. */
#include "jobs/kind.h"
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "jobs/statistics/statistics_law.h"
#include "schema/result/block_result.h"
#include "tests/support/check.h"
#include <gsl/gsl_cdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SURFACE                                                                                    \
    "\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2, \"points_per_wavelength\": 8"
#define SKEWED                                                                                     \
    "\"amplitudes\": \"random\", \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 1.5"

/* What so many realisations of a surface gave. */
struct ran {
    struct block_result block;
    struct case_result result;
};

/* Runs and merges those of the first realisations that `some` names; NULL: all, in one block. */
static struct ran run_some(const char *surface, const char *statistics, uint64_t count,
                           const bool *some) {
    struct ran ran = {0};
    struct job_runner *runner = NULL;
    struct job_merger *merger = NULL;
    struct error err = {0};
    char text[500];
    snprintf(text, sizeof text, "{\"surface\": {%s}, \"statistics\": {%s}}", surface, statistics);
    cJSON *parameters = cJSON_Parse(text);
    const struct job_kind *kind = kind_find("statistics");
    assert_non_null(parameters);
    if (runner_create(&runner, kind, parameters, NULL, 3, 0, &err) != 0 ||
        merger_create(&merger, kind, parameters, &err) != 0)
        fail_msg("%s: %s", surface, err.text);
    for (uint64_t r = 0; r < (some != NULL ? count : 1); r++) {
        if (some != NULL && !some[r])
            continue;
        block_result_clear(&ran.block);
        if (runner_run(runner, r, some != NULL ? 1 : count, NULL, &ran.block, &err) != 0 ||
            merger_add(merger, &ran.block, &err) != 0)
            fail_msg("%s: %s", surface, err.text);
    }
    if (merger_result(merger, &ran.result, &err) != 0)
        fail_msg("%s: %s", surface, err.text);
    runner_destroy(&runner);
    merger_destroy(&merger);
    cJSON_Delete(parameters);
    return ran;
}

static struct ran run_with(const char *surface, const char *statistics, uint64_t count) {
    return run_some(surface, statistics, count, NULL);
}

static struct ran run(const char *surface, uint64_t count) {
    return run_with(surface, "", count);
}

static void ran_clear(struct ran *ran) {
    block_result_clear(&ran->block);
    result_clear(&ran->result);
}

static double value(const struct ran *ran, uint64_t realisation, size_t scalar) {
    if (ran->block.scalars == NULL)
        return (double)NAN;
    return ran->block.scalars[realisation * ran->block.scalar_count + scalar];
}

/* Realisation by realisation the scalars of the other law are the own ones of a study of it. */
static void check_places(const struct ran *one, const struct ran *other) {
    size_t pairs = 0;
    for (uint64_t r = 0; r < 18; r++)
        for (size_t a = 0; a < LAW_COUNT; a++) {
            double found = value(one, r, SCALAR_LAW + a);
            pairs += a == 0 && !isnan(found);
            if (!isnan(found) && LAW_OWN[a] != SCALAR_LOWEST && LAW_OWN[a] != SCALAR_HIGHEST)
                check_relative(found, value(other, r, LAW_OWN[a]), 1e-6);
        }
    assert_true(pairs >= 3);
}

static void laws_change_places(void **state) {
    (void)state;
    /* summits of a grid, and those that are found by the spectrum of a surface or of its field */
    static const char *const STATISTICS[] = {"", "\"summits\": \"refined\"",
                                             "\"curvature\": \"spectral\""};
    for (size_t a = 0; a < sizeof STATISTICS / sizeof *STATISTICS; a++) {
        struct ran iterated = run_with(SURFACE ", " SKEWED "}", STATISTICS[a], 18);
        struct ran translated =
            run_with(SURFACE ", " SKEWED ", \"law\": \"translation\"}", STATISTICS[a], 18);
        check_places(&iterated, &translated);
        check_places(&translated, &iterated);
        ran_clear(&iterated);
        ran_clear(&translated);
    }
}

/* The mean of the differences of pairs, by its definition; densities go with the numbers. */
static void differences_follow_from_the_pairs(void **state) {
    (void)state;
    struct ran ran = run(SURFACE ", " SKEWED "}", 18);
    double sum = 0, squares = 0, n = 0;
    for (uint64_t r = 0; r < 18; r++) {
        double difference = value(&ran, r, SCALAR_LAW_SUMMIT_HEIGHT_MEAN) -
                            value(&ran, r, SCALAR_SUMMIT_HEIGHT_MEAN);
        if (isnan(difference))
            continue;
        sum += difference;
        squares += difference * difference;
        n++;
    }
    const struct scalar *mean = result_scalar(&ran.result, "summit_height_mean");
    const struct scalar *number = result_scalar(&ran.result, "summits");
    const struct scalar *density = result_scalar(&ran.result, "summit_density");
    check_relative(mean->law_difference, sum / n, 1e-9);
    const double error = sqrt((squares - sum * sum / n) / (n - 1) / n);
    check_relative(mean->law_standard_error,
                   error * gsl_cdf_tdist_Pinv(0.975, n - 1) / gsl_cdf_ugaussian_Pinv(0.975), 1e-6);
    check_relative(density->law_difference / density->value, number->law_difference / number->value,
                   1e-9);
    /* what is not measured again, and what all surfaces share */
    assert_true(isnan(result_scalar(&ran.result, "m4")->law_difference));
    assert_true(isnan(result_scalar(&ran.result, "eps_h")->law_difference));
    ran_clear(&ran);
}

/* The curves of the pairs alone, as studies of each law have them. */
static void check_curves(const struct ran *ran, const struct ran *own, const struct ran *other) {
    size_t compared = 0;
    for (size_t a = 0; a < ran->result.curve_count; a++) {
        const struct curve *curve = &ran->result.curves[a];
        if (curve->law_difference == NULL) { /* pits of few pairs show no mean curvature */
            assert_true(curve->columns > 0 || strstr(curve->quantity, "df") == NULL);
            continue;
        }
        for (size_t k = 0; k < curve->n; k++) {
            if (isnan(curve->law_difference[k]))
                continue;
            double change = other->result.curves[a].y[k] - own->result.curves[a].y[k];
            assert_true(fabs(curve->law_difference[k] - change) <= 1e-9 * (1 + fabs(change)));
            assert_true(curve->law_standard_error[k] > 0 || change == 0);
            compared++;
        }
    }
    assert_true(compared > 200);
}

static void curves_follow_from_the_pairs(void **state) {
    (void)state;
    enum { COUNT = 20 };
    static const char *const LAWS[] = {SURFACE ", " SKEWED "}",
                                       SURFACE ", " SKEWED ", \"law\": \"translation\"}"};
    for (size_t law = 0; law < 2; law++) {
        struct ran ran = run(LAWS[law], COUNT);
        bool paired[COUNT];
        for (uint64_t r = 0; r < COUNT; r++)
            paired[r] = !isnan(value(&ran, r, SCALAR_LAW));
        struct ran own = run_some(LAWS[law], "", COUNT, paired);
        struct ran other = run_some(LAWS[1 - law], "", COUNT, paired);
        check_curves(&ran, &own, &other);
        ran_clear(&ran);
        ran_clear(&own);
        ran_clear(&other);
    }
}

static void where_nothing_is_known(void **state) {
    (void)state;
    struct ran gaussian = run(SURFACE, 18), one = run(SURFACE ", " SKEWED "}", 1);
    for (size_t a = 0; a < gaussian.result.scalar_count; a++)
        assert_true(isnan(gaussian.result.scalars[a].law_difference));
    for (size_t a = 0; a < gaussian.result.curve_count; a++)
        assert_null(gaussian.result.curves[a].law_difference);
    for (size_t a = 0; a < one.result.curve_count; a++)
        assert_null(one.result.curves[a].law_difference);
    for (size_t a = 0; a < LAW_COUNT; a++)
        assert_true(isnan(value(&gaussian, 0, SCALAR_LAW + a)));
    assert_true(!isnan(value(&one, 0, SCALAR_LAW)));
    assert_true(isnan(result_scalar(&one.result, "summit_height_mean")->law_difference));
    ran_clear(&gaussian);
    ran_clear(&one);
}

/* `rugo check` says what few realisations take: one of four of the first 32 has a surface of the
 * other law, whose iterations take most of the time. */
static void pairs_are_in_the_estimate(void **state) {
    (void)state;
    const char *laws[] = {"", ", " SKEWED ", \"law\": \"translation\"}"};
    struct study_cost cost[2];
    for (size_t a = 0; a < 2; a++) {
        struct fault_list faults = {0};
        char text[500];
        snprintf(text, sizeof text, "{\"surface\": {%s%s}}", SURFACE, laws[a]);
        cJSON *parameters = cJSON_Parse(text);
        const struct study_kind *kind = &kind_find("statistics")->study;
        assert_int_equal(kind_check(kind, parameters, 0, &faults, &cost[a], NULL), 0);
        assert_int_equal(faults.count, 0);
        cJSON_Delete(parameters);
    }
    for (size_t r = 0; r < STUDY_EARLY; r++) {
        assert_true(cost[0].early_seconds[r] <= 0);
        assert_int_equal(cost[1].early_seconds[r] > 2 * cost[1].seconds, r % 4 == 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(laws_change_places),
        cmocka_unit_test(differences_follow_from_the_pairs),
        cmocka_unit_test(curves_follow_from_the_pairs),
        cmocka_unit_test(where_nothing_is_known),
        cmocka_unit_test(pairs_are_in_the_estimate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
