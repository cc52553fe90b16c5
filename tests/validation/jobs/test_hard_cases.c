/* The named catalogue of hard surfaces: each ends in curves with finite roughness and densities
 * that add up to 1 where their bins hold all, or is refused with words when it is checked; never a
 * hang, a NaN or a crash. */
#include "jobs/kind.h"
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "schema/json/json.h"
#include "schema/study/fault.h"
#include "tests/support/effort.h"
#include "tests/support/result_tree.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

struct hard_case {
    const char *name, *parameters; /* quotes are single ones */
    const char *refusal;           /* words of its fault; NULL: it runs */
};
static const struct hard_case CASES[] = {
    {"H near 0", "{'surface': {'hurst': 1e-9, 'wavelength_ratio': 8}}", NULL},
    {"H = 1", "{'surface': {'hurst': 1, 'wavelength_ratio': 8}}", NULL},
    {"H = 1 profile", "{'surface': {'dimension': 1, 'hurst': 1, 'wavelength_ratio': 8}}", NULL},
    {"one ring of waves", "{'surface': {'hurst': 0.8, 'wavelength_ratio': 1}}", NULL},
    {"one ring, refined",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 1}, 'statistics': {'summits': 'refined'}}",
     NULL},
    {"one mode",
     "{'surface': {'dimension': 1, 'hurst': 0.8, 'wavelength_ratio': 1, "
     "'length_ratio': 1}}",
     NULL},
    {"one mode, Weibull",
     "{'surface': {'dimension': 1, 'hurst': 0.8, 'wavelength_ratio': 1, 'length_ratio': 1, "
     "'heights': {'distribution': 'weibull_max', 'shape': 1}}}",
     NULL},
    {"N = 2",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 1, 'length_ratio': 1, "
     "'points_per_wavelength': 2}}",
     NULL},
    {"N = 2, refined",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 1, 'length_ratio': 1, "
     "'points_per_wavelength': 2}, 'statistics': {'summits': 'refined'}}",
     NULL},
    {"N = 2 profile, Weibull",
     "{'surface': {'dimension': 1, 'hurst': 0.8, 'wavelength_ratio': 1, 'length_ratio': 1, "
     "'points_per_wavelength': 2, 'heights': {'distribution': 'weibull_min', 'shape': 2}}}",
     NULL},
    {"prime N",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 4, 'length_ratio': 1, "
     "'points_per_wavelength': 25.25}}",
     NULL},
    {"odd N, kept heights",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 5, 'length_ratio': 3, "
     "'points_per_wavelength': 5, 'heights': {'distribution': 'weibull_min', 'shape': 1.5, "
     "'keep': 'heights'}}, 'statistics': {'curvature': 'spectral'}}",
     NULL},
    {"a strip one wave wide",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 1, 'length_ratio': 16, 'length_ratio_y': 1, "
     "'points_per_wavelength': 2}}",
     NULL},
    {"a strip, refined, levels, kept heights",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 2, 'length_ratio': 1, 'length_ratio_y': 16, "
     "'heights': {'distribution': 'weibull_min', 'shape': 1.5, 'keep': 'heights'}}, "
     "'statistics': {'summits': 'refined', 'levels': [2, 4, 8]}}",
     NULL},
    {"sides of odd points in an odd ratio",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 5, 'length_ratio': 3, 'length_ratio_y': 1.4, "
     "'points_per_wavelength': 5, 'heights': {'distribution': 'weibull_min', 'shape': 1.5}}}",
     NULL},
    {"sides in no ratio",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 5, 'length_ratio_y': 3.14159}}",
     "simple ratio"},
    {"Nyquist", "{'surface': {'hurst': 0.8, 'wavelength_ratio': 8, 'points_per_wavelength': 2}}",
     NULL},
    {"shape 0.5",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 8, 'length_ratio': 4, 'heights': "
     "{'distribution': 'weibull_max', 'shape': 0.5}}}",
     NULL},
    {"shape 20",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 8, 'length_ratio': 4, 'heights': "
     "{'distribution': 'weibull_min', 'shape': 20}}}",
     NULL},
    {"tolerance 0",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 4, 'length_ratio': 4, "
     "'heights': {'distribution': 'weibull_max', 'shape': 2, 'tolerance': 0, "
     "'iteration': 'plain'}}}",
     NULL},
    {"one iteration",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 4, 'length_ratio': 4, "
     "'heights': {'distribution': 'weibull_max', 'shape': 2, "
     "'max_iterations': 1}}}",
     NULL},
    {"tiny unit", "{'surface': {'hurst': 0.8, 'wavelength_ratio': 4, 'rms_height': 1e-100}}", NULL},
    {"huge unit",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 4, 'rms_height': 1e100, "
     "'heights': {'distribution': 'weibull_max', 'shape': 2}}}",
     NULL},
    {"anisotropic",
     "{'surface': {'wavelength_ratio': 8, 'length_ratio': 4, 'spectrum': {'type': "
     "'exponential_acf', 'length': [0.1, 4]}}}",
     NULL},
    {"flat table",
     "{'surface': {'wavelength_ratio': 4, 'spectrum': {'type': 'table', "
     "'wave_number': [0.2, 6.25], 'density': [1, 1]}}}",
     NULL},
    {"plateau to the end", "{'surface': {'hurst': 0.8, 'wavelength_ratio': 8, 'rolloff_ratio': 8}}",
     NULL},
    {"alpha too small", "{'surface': {'hurst': 0.8, 'nayak_alpha': 1.4}}", "alpha"},
    {"alpha too large", "{'surface': {'hurst': 0.3, 'nayak_alpha': 1e6}}", "alpha"},
    {"no wave in the band",
     "{'surface': {'hurst': 0.8, 'wavelength_ratio': 1, 'length_ratio': 1.7}}", "no wave"},
    {"too large a grid", "{'surface': {'hurst': 0.8, 'wavelength_ratio': 1e5}}", "too large"},
};

static cJSON *parameters_of(const struct hard_case *hard) {
    char text[1000];
    snprintf(text, sizeof text, "%s", hard->parameters);
    for (char *at = text; *at != '\0'; at++)
        if (*at == '\'')
            *at = '"';
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    return parameters;
}

static void assert_finite(const struct hard_case *hard, const cJSON *document,
                          const char *pointer) {
    const cJSON *value = json_at(document, pointer);
    if (!cJSON_IsNumber(value) || !isfinite(value->valuedouble))
        fail_msg("%s: no number at %s", hard->name, pointer);
}

/* No number anywhere is NaN or infinite: what cannot be had is null. */
static void assert_numbers(const struct hard_case *hard, const cJSON *value) {
    if (value == NULL)
        return;
    if (cJSON_IsNumber(value) && !isfinite(value->valuedouble))
        fail_msg("%s: a number is not finite", hard->name);
    for (const cJSON *child = value->child; child != NULL; child = child->next)
        assert_numbers(hard, child);
}

/* The share of what was counted that lies in the bins of a density is 1 at most, and 1 where
 * nothing lies outside of them. A density of no summits has no values. */
static void assert_share(const struct hard_case *hard, const cJSON *curve) {
    const cJSON *x = json_at(curve, "/x"), *y = json_at(curve, "/y");
    const double width = cJSON_GetNumberValue(cJSON_GetArrayItem(x, 1)) -
                         cJSON_GetNumberValue(cJSON_GetArrayItem(x, 0));
    const double outside =
        json_at(curve, "/underflow")->valuedouble + json_at(curve, "/overflow")->valuedouble;
    double share = 0;
    if (isnan(cJSON_GetNumberValue(cJSON_GetArrayItem(y, 0))))
        return;
    for (int b = 0; b < cJSON_GetArraySize(y); b++)
        share += width * cJSON_GetNumberValue(cJSON_GetArrayItem(y, b));
    if (!(share <= 1 + 1e-9) || (outside < 0.5 && !(share >= 1 - 1e-9)))
        fail_msg("%s: %s adds up to %.17g, and %g are outside", hard->name,
                 json_at(curve, "/quantity")->valuestring, share, outside);
}

/* Of densities over one variable; that of heights is one of them. */
static void assert_densities(const struct hard_case *hard, const cJSON *document) {
    const cJSON *curve;
    bool heights = false;
    cJSON_ArrayForEach(curve, json_at(document, "/curves")) {
        const char *quantity = json_at(curve, "/quantity")->valuestring;
        const char *end = strstr(quantity, "_pdf");
        if (end == NULL || end[4] != '\0' || json_at(curve, "/x2") != NULL)
            continue;
        assert_share(hard, curve);
        heights =
            heights || (strcmp(quantity, "height_pdf") == 0 &&
                        !isnan(cJSON_GetNumberValue(cJSON_GetArrayItem(json_at(curve, "/y"), 0))));
    }
    if (!heights)
        fail_msg("%s: no density of heights", hard->name);
}

static void run_case(const struct hard_case *hard) {
    const struct job_kind *kind = kind_find("statistics");
    struct fault_list faults = {0};
    struct study_cost estimate;
    struct job_runner *runner = NULL;
    struct job_merger *merger = NULL;
    struct block_result result = {0};
    struct error err = {0};
    cJSON *parameters = parameters_of(hard), *document = NULL;
    assert_int_equal(kind_check(&kind->study, parameters, 0, &faults, &estimate, &err), 0);
    if (hard->refusal != NULL) {
        if (faults.count == 0 || strstr(faults.faults[0].detail, hard->refusal) == NULL)
            fail_msg("%s: not refused as it should be: %s", hard->name,
                     faults.count > 0 ? faults.faults[0].detail : "no fault");
        fault_list_clear(&faults);
        cJSON_Delete(parameters);
        return;
    }
    if (faults.count > 0)
        fail_msg("%s: %s: %s", hard->name, faults.faults[0].pointer, faults.faults[0].detail);
    assert_true(estimate.seconds > 0 && estimate.memory_bytes > 0 && estimate.relative_error > 0 &&
                isfinite(estimate.relative_error));
    if (runner_create(&runner, kind, parameters, NULL, 7, 0, &err) != 0 ||
        runner_run(runner, 0, 3, NULL, &result, &err) != 0 ||
        merger_create(&merger, kind, parameters, &err) != 0 ||
        merger_add(merger, &result, &err) != 0 ||
        merger_tree(merger, kind, parameters, &document, &err) != 0)
        fail_msg("%s: %s", hard->name, err.text);
    assert_finite(hard, document, "/scalars/rms_height/value");
    assert_finite(hard, document, "/scalars/nayak_alpha/value");
    assert_finite(hard, document, "/scalars/summits/value");
    assert_numbers(hard, document);
    assert_densities(hard, document);
    cJSON_Delete(document);
    block_result_clear(&result);
    runner_destroy(&runner);
    merger_destroy(&merger);
    cJSON_Delete(parameters);
}

static double scalar_of(const char *scale, const char *name) {
    const struct job_kind *kind = kind_find("statistics");
    struct job_runner *runner = NULL;
    struct block_result result = {0};
    struct error err = {0};
    char text[200];
    snprintf(text, sizeof text, "{'surface': {'hurst': 0.6, 'wavelength_ratio': 8, %s}}", scale);
    cJSON *parameters = parameters_of(&(struct hard_case){"units", text, NULL});
    if (runner_create(&runner, kind, parameters, NULL, 7, 0, &err) != 0 ||
        runner_run(runner, 0, 1, NULL, &result, &err) != 0)
        fail_msg("%s: %s", scale, err.text);
    size_t at = 0;
    while (strcmp(kind->scalar(at), name) != 0)
        at++;
    double value = result.scalars != NULL ? result.scalars[at] : NAN;
    block_result_clear(&result);
    runner_destroy(&runner);
    cJSON_Delete(parameters);
    return value;
}

/* The unit of heights leaves what has none the same, to rounding (1e-10). */
static void units(void **state) {
    (void)state;
    static const char *const scales[] = {"'rms_height': 1e-12", "'rms_height': 1e15",
                                         "'rms_slope': 1e-9", "'rms_slope': 1e6"};
    static const char *const names[] = {"skewness", "kurtosis",           "nayak_alpha",
                                        "summits",  "summit_height_mean", "summit_curvature_mean"};
    for (size_t a = 0; a < sizeof names / sizeof *names; a++) {
        double expected = scalar_of("'rms_height': 1", names[a]);
        for (size_t b = 0; b < sizeof scales / sizeof *scales; b++) {
            double got = scalar_of(scales[b], names[a]);
            if (!(fabs(got - expected) <= 1e-10 * fmax(1, fabs(expected))))
                fail_msg("%s with %s: %.17g, not %.17g", names[a], scales[b], got, expected);
        }
    }
}

static void catalogue(void **state) {
    (void)state;
    for (size_t a = 0; a < sizeof CASES / sizeof *CASES; a += case_step()) {
        printf("%s\n", CASES[a].name);
        run_case(&CASES[a]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(catalogue), cmocka_unit_test(units)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
