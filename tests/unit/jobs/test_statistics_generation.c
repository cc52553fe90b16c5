/* Protects: the error "generation" of statistics: which realisations are found again, that the
 * pairs are surfaces of the same start, and that errors of scalars and curves follow from the
 * pairs; none of it for Gaussian heights, and not known from fewer than two pairs. */
#include "jobs/kind.h"
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "jobs/statistics/statistics_generation.h"
#include "schema/result/block_result.h"
#include "tests/support/check.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SURFACE                                                                                    \
    "\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2, \"points_per_wavelength\": 8"
#define SKEWED "\"heights\": {\"distribution\": \"weibull_min\", \"shape\": 1"

/* What so many realisations of a surface gave. */
struct ran {
    struct block_result block;
    struct case_result result;
};

static struct ran run(const char *surface, uint64_t count) {
    struct ran ran = {0};
    struct job_runner *runner = NULL;
    struct job_merger *merger = NULL;
    struct error err = {0};
    char text[500];
    snprintf(text, sizeof text, "{\"surface\": {%s}}", surface);
    cJSON *parameters = cJSON_Parse(text);
    const struct job_kind *kind = kind_find("statistics");
    assert_non_null(parameters);
    if (runner_create(&runner, kind, parameters, NULL, 3, 0, &err) != 0 ||
        merger_create(&merger, kind, parameters, &err) != 0 ||
        runner_run(runner, 0, count, NULL, &ran.block, &err) != 0 ||
        merger_add(merger, &ran.block, &err) != 0 || merger_result(merger, &ran.result, &err) != 0)
        fail_msg("%s: %s", surface, err.text);
    runner_destroy(&runner);
    merger_destroy(&merger);
    cJSON_Delete(parameters);
    return ran;
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

static void pairs_are_of_one_start(void **state) {
    (void)state;
    struct ran ran = run(SURFACE ", " SKEWED ", \"iteration\": \"reflections\"}", 18);
    for (uint64_t r = 0; r < 18; r++) {
        bool paired = r % 8 == 0;
        for (size_t a = 0; a < GENERATION_COUNT; a++) {
            assert_true(isnan(value(&ran, r, SCALAR_OTHER + a)) == !paired);
            assert_true(isnan(value(&ran, r, SCALAR_LONGER + a)) == !paired);
        }
        if (!paired)
            continue;
        /* Of the same heights and start: the lowest and the number of summits are near, not equal.
         */
        double own = value(&ran, r, SCALAR_SUMMITS);
        check_close(value(&ran, r, SCALAR_OTHER_SUMMITS), own, 0.3 * own);
        check_close(value(&ran, r, SCALAR_LONGER_SUMMITS), own, 0.3 * own);
        check_close(value(&ran, r, SCALAR_OTHER_SKEWNESS), value(&ran, r, SCALAR_SKEWNESS), 0.1);
        assert_true(value(&ran, r, SCALAR_OTHER_KURTOSIS) != value(&ran, r, SCALAR_KURTOSIS));
        assert_true(value(&ran, r, SCALAR_LONGER_EPS_H) <= 1.05 * value(&ran, r, SCALAR_EPS_H));
    }
    ran_clear(&ran);
}

/* The bound of a scalar by its definition: the mean change to the other surfaces, and that to
 * longer iterations by what is left to half of eps_h. */
static void bounds_follow_from_the_pairs(void **state) {
    (void)state;
    static const size_t PAIRS[] = {0, 8, 16};
    struct ran ran = run(SURFACE ", " SKEWED "}", 18);
    double other = 0, longer = 0, halvings = 0;
    for (size_t p = 0; p < 3; p++) {
        uint64_t r = PAIRS[p];
        double own = value(&ran, r, SCALAR_SUMMIT_HEIGHT_MEAN);
        other += (value(&ran, r, SCALAR_OTHER_SUMMIT_HEIGHT_MEAN) - own) / 3;
        longer += (value(&ran, r, SCALAR_LONGER_SUMMIT_HEIGHT_MEAN) - own) / 3;
        halvings += log2(value(&ran, r, SCALAR_EPS_H) / value(&ran, r, SCALAR_LONGER_EPS_H)) / 3;
    }
    double factor = halvings > 0.25 ? 1 / halvings : 4;
    const struct scalar *mean = result_scalar(&ran.result, "summit_height_mean");
    const struct scalar_error *error = &mean->errors[ERROR_GENERATION];
    assert_true(error->applies && error->known && error->value == 0);
    check_relative(error->bound, fabs(other) + factor * fabs(longer), 1e-9);
    assert_true(error->standard_error > 0);
    const struct scalar *number = result_scalar(&ran.result, "summits");
    const struct scalar *density = result_scalar(&ran.result, "summit_density");
    check_relative(density->errors[ERROR_GENERATION].bound / density->value,
                   number->errors[ERROR_GENERATION].bound / number->value, 1e-9);
    /* the spectrum is exact */
    assert_false(result_scalar(&ran.result, "m4")->errors[ERROR_GENERATION].applies);
    assert_false(result_scalar(&ran.result, "eps_h")->errors[ERROR_GENERATION].applies);
    ran_clear(&ran);
}

/* A shift of the heights by d changes a density by its slope times d, so that the bound integrates
 * to d times the total rise and fall, at least twice the maximum; curvatures have bounds in
 * proportion. */
static void curves_are_told(void **state) {
    (void)state;
    struct ran ran = run(SURFACE ", " SKEWED "}", 18);
    for (size_t a = 0; a < ran.result.curve_count; a++) {
        const struct curve *curve = &ran.result.curves[a];
        const struct curve_error *error = &curve->errors[ERROR_GENERATION];
        bool spectrum = strcmp(curve->quantity, "psd") == 0 || strcmp(curve->quantity, "acf") == 0;
        bool joint = curve->columns > 0;
        assert_true(error->applies == !spectrum);
        assert_true((error->value != NULL) == (!spectrum && !joint));
        for (size_t k = 0; k < curve->n && error->value != NULL; k++) {
            assert_true(error->value[k] == 0);
            assert_true(error->bound[k] >= 0 || isnan(curve->y[k]));
        }
    }
    const struct curve *heights = result_curve(&ran.result, "summit_height_pdf");
    const struct curve *curvature = result_curve(&ran.result, "summit_mean_curvature");
    const struct scalar *mean = result_scalar(&ran.result, "summit_height_mean");
    const struct scalar *mean_curvature = result_scalar(&ran.result, "summit_curvature_mean");
    double area = 0, most = 0, width = heights->x[1] - heights->x[0];
    for (size_t k = 0; k < heights->n; k++) {
        area += heights->errors[ERROR_GENERATION].bound[k] * width;
        most = fmax(most, heights->y[k]);
    }
    assert_true(area >= mean->errors[ERROR_GENERATION].bound * most);
    for (size_t k = 0; k < curvature->n; k++)
        if (!isnan(curvature->y[k]))
            check_close(curvature->errors[ERROR_GENERATION].bound[k] / fabs(curvature->y[k]),
                        mean_curvature->errors[ERROR_GENERATION].bound / mean_curvature->value,
                        1e-9);
    ran_clear(&ran);
}

static void where_nothing_is_known(void **state) {
    (void)state;
    struct ran gaussian = run(SURFACE, 18), one = run(SURFACE ", " SKEWED "}", 8);
    for (size_t a = 0; a < gaussian.result.scalar_count; a++)
        assert_false(gaussian.result.scalars[a].errors[ERROR_GENERATION].applies);
    for (size_t a = 0; a < gaussian.result.curve_count; a++)
        assert_false(gaussian.result.curves[a].errors[ERROR_GENERATION].applies);
    for (size_t a = 0; a < GENERATION_COUNT; a++)
        assert_true(isnan(value(&gaussian, 0, SCALAR_OTHER + a)));
    const struct scalar *mean = result_scalar(&one.result, "summit_height_mean");
    assert_true(mean->errors[ERROR_GENERATION].applies);
    assert_false(mean->errors[ERROR_GENERATION].known);
    const struct curve *heights = result_curve(&one.result, "summit_height_pdf");
    assert_true(heights->errors[ERROR_GENERATION].applies);
    assert_null(heights->errors[ERROR_GENERATION].value);
    ran_clear(&gaussian);
    ran_clear(&one);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_are_of_one_start),
        cmocka_unit_test(bounds_follow_from_the_pairs),
        cmocka_unit_test(curves_are_told),
        cmocka_unit_test(where_nothing_is_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
