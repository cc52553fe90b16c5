/* Protects: curves and scalars of statistics, with their errors, are those that the realisations
 * themselves give, and stand beside the theories that apply. */
#include "schema/study/fault.h"
#include "tests/support/statistics_study.h"

/* A histogram is the counts over all realisations, and its error that of the ratio, from the
 * realisations one by one. 1e-12: rounding. */
static void curves_against_brute_force(void **state) {
    (void)state;
    struct job_runner *runner = runner_of(GAUSSIAN);
    struct job_merger *merger = merger_of(GAUSSIAN);
    double n[REALISATIONS], share[REALISATIONS], total = 0, sum = 0, squares = 0;
    const int bin = 4; /* [0.8, 1): well filled */
    for (uint64_t r = 0; r < REALISATIONS; r++) {
        struct job_merger *single = merger_of(GAUSSIAN);
        struct block_result result = run(runner, r, 1);
        merge(single, &result);
        merge(merger, &result);
        cJSON *document = curves_of(single);
        n[r] = 2 * scalar(document, "summits", "value"); /* Gaussian: with pits, half of both */
        share[r] = at(curve_of(document, "summit_height_pdf"), "/y", bin) * 0.2;
        assert_true(isnan(at(curve_of(document, "summit_height_pdf"), "/standard_error", bin)));
        cJSON_Delete(document);
        block_result_clear(&result);
        merger_destroy(&single);
        total += n[r];
        sum += n[r] * share[r];
    }
    for (size_t r = 0; r < REALISATIONS; r++)
        squares += pow(n[r] * share[r] - sum / total * n[r], 2);
    double m = REALISATIONS;
    cJSON *document = curves_of(merger);
    const cJSON *pdf = curve_of(document, "summit_height_pdf");
    assert_true(fabs(at(pdf, "/y", bin) - sum / total / 0.2) <= 1e-12);
    assert_true(fabs(at(pdf, "/standard_error", bin) - sqrt(m / (m - 1) * squares) / total / 0.2) <=
                1e-12);
    assert_true(fabs(scalar(document, "summits", "value") - total / m / 2) <= 1e-12 * total);
    cJSON_Delete(document);
    merger_destroy(&merger);
    runner_destroy(&runner);
}

/* Densities and what fell outside add up to one; the joint density has the marginals. */
static void normalisation(void **state) {
    (void)state;
    struct job_runner *runner = runner_of(GAUSSIAN);
    struct job_merger *merger = merger_of(GAUSSIAN);
    struct block_result result = run(runner, 0, REALISATIONS);
    merge(merger, &result);
    cJSON *document = curves_of(merger);
    const cJSON *pdf = curve_of(document, "summit_height_pdf");
    const cJSON *cdf = curve_of(document, "summit_height_cdf");
    const cJSON *joint = curve_of(document, "summit_joint_pdf");
    double summits = 2 * scalar(document, "summits", "value") * REALISATIONS, inside = 0, all = 0;
    double below = json_at(pdf, "/underflow")->valuedouble;
    double above = json_at(pdf, "/overflow")->valuedouble;
    assert_true(below > 0 && above > 0);
    for (int b = 0; b < 10; b++) {
        inside += at(pdf, "/y", b) * 0.2;
        assert_true(fabs(at(cdf, "/y", b) - inside - below / summits) <= 1e-12);
        const cJSON *row = cJSON_GetArrayItem(json_at(joint, "/y"), b);
        for (int t = 0; t < 16; t++)
            all += cJSON_GetArrayItem(row, t)->valuedouble * 0.2 * 0.5;
    }
    assert_true(fabs(inside + (below + above) / summits - 1) <= 1e-12);
    assert_true(fabs(all + json_at(joint, "/overflow")->valuedouble / summits - 1) <= 1e-12);
    const cJSON *heights = curve_of(document, "height_pdf");
    assert_true(json_at(heights, "/underflow")->valuedouble > 0);
    cJSON_Delete(document);
    block_result_clear(&result);
    merger_destroy(&merger);
    runner_destroy(&runner);
}

/* Bins that miss everything: no share, all counted outside, no NaN where there is a number. */
static void bins_that_miss(void **state) {
    (void)state;
    static const char study[] =
        "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2,"
        " \"points_per_wavelength\": 4},"
        " \"statistics\": {\"bins\": {\"height\": [50, 60, 3], \"curvature\": [1, 2, 2]}}}";
    struct job_runner *runner = runner_of(study);
    struct job_merger *merger = merger_of(study);
    struct block_result result = run(runner, 0, 3);
    merge(merger, &result);
    cJSON *document = curves_of(merger);
    const cJSON *pdf = curve_of(document, "summit_height_pdf");
    double summits = 6 * scalar(document, "summits", "value"), width = 10.0 / 3;
    assert_true(at(pdf, "/y", 1) == 0 && at(pdf, "/valueless", 1) == 3);
    assert_true(fabs(at(pdf, "/standard_error", 1) * width * summits - 1.841) <= 1e-12);
    assert_true(json_at(pdf, "/underflow")->valuedouble == summits);
    cJSON_Delete(document);
    block_result_clear(&result);
    merger_destroy(&merger);
    runner_destroy(&runner);
}

/* How many points of a curve of ratios are empty, had by one realisation, and had by more. */
struct points_seen {
    int empty, one, more;
};

/* No error is 0: of a mean that nothing or one realisation alone has there is none; all other
 * points have one. valueless counts the realisations that have nothing. */
static void check_errors(const cJSON *curve, struct points_seen *seen) {
    bool ratio = strcmp(json_at(curve, "/quantity")->valuestring, "summit_mean_curvature") == 0;
    for (int b = 0; b < cJSON_GetArraySize(json_at(curve, "/x")); b++) {
        double y = at(curve, "/y", b), error = at(curve, "/standard_error", b);
        double had = REALISATIONS - at(curve, "/valueless", b);
        assert_true(had >= 0 && had <= REALISATIONS);
        if (ratio)
            assert_true(isnan(y) == (had == 0) && isnan(error) == (had < 2));
        else
            assert_true((y > 0) == (had > 0));
        assert_true((ratio && isnan(error)) || error > 0);
        seen->empty += had == 0;
        seen->one += had == 1;
        seen->more += had > 1;
    }
}

static void no_error_is_zero(void **state) {
    (void)state;
    static const char *const ratios[] = {"height_pdf", "summit_height_pdf", "summit_curvature_pdf",
                                         "summit_mean_curvature"};
    for (int s = 0; s < STUDY_COUNT; s++) {
        struct job_runner *runner = runner_of(STUDIES[s]);
        struct job_merger *merger = merger_of(STUDIES[s]);
        struct block_result result = run(runner, 0, REALISATIONS);
        struct points_seen seen = {0};
        const cJSON *curve;
        merge(merger, &result);
        cJSON *document = curves_of(merger);
        cJSON_ArrayForEach(curve, json_at(document, "/curves")) {
            const char *quantity = json_at(curve, "/quantity")->valuestring;
            for (size_t a = 0; a < 4; a++)
                if (strcmp(quantity, ratios[a]) == 0)
                    check_errors(curve, &seen);
            for (int b = 0;
                 strstr(quantity, "_cdf") != NULL && b < cJSON_GetArraySize(json_at(curve, "/x"));
                 b++)
                assert_true(at(curve, "/standard_error", b) > 0);
        }
        assert_true(seen.one > 0 && seen.more > 10 && (s == 0 || seen.empty > 10));
        cJSON_Delete(document);
        block_result_clear(&result);
        merger_destroy(&merger);
        runner_destroy(&runner);
    }
}

/* Scalars by what the spectrum fixes are exact: their error is 0, that of no other is. Pits are
 * reported for surfaces that are not as their mirror images. */
static void constants_and_pits(void **state) {
    (void)state;
    static const char *const constants[] = {"rms_height", "rms_slope", "rms_curvature", "m0",
                                            "nayak_alpha_finite_difference"};
    for (int s = 0; s < 2; s++) {
        struct job_runner *runner = runner_of(STUDIES[s]);
        struct job_merger *merger = merger_of(STUDIES[s]);
        struct block_result result = run(runner, 0, REALISATIONS);
        merge(merger, &result);
        cJSON *document = curves_of(merger);
        for (size_t a = 0; a < 5; a++) {
            double error = scalar(document, constants[a], "standard_error");
            double value = scalar(document, constants[a], "value");
            double theory = scalar(document, constants[a], "theory");
            assert_true(s == 0 ? error == 0 : error > 0);
            assert_true(value > 0 && (isnan(theory) || fabs(value / theory - 1) < 0.5));
        }
        double pits = scalar(document, "pits", "value"),
               summits = scalar(document, "summits", "value");
        double low = scalar(document, "pit_height_mean", "value");
        double high = scalar(document, "summit_height_mean", "value");
        assert_true(summits > 0 && scalar(document, "summits", "standard_error") > 0);
        assert_true(s == 0 ? isnan(pits) && isnan(low) : pits > 0 && low > high);
        cJSON_Delete(document);
        block_result_clear(&result);
        merger_destroy(&merger);
        runner_destroy(&runner);
    }
}

/* Within four standard errors, which are below 0.2, of theory of the grid; without a grid it is
 * another. */
static void assert_shape_of_heights(const cJSON *document) {
    static const char *const MOMENTS[] = {"summit_height_skewness", "summit_height_kurtosis"};
    for (size_t a = 0; a < 2; a++) {
        double error = scalar(document, MOMENTS[a], "standard_error");
        double expected = scalar(document, MOMENTS[a], "grid_theory");
        assert_true(error > 0 && error < 0.2);
        assert_true(fabs(scalar(document, MOMENTS[a], "value") - expected) < 4 * error);
        assert_true(fabs(scalar(document, MOMENTS[a], "theory") - expected) < 0.1);
    }
}

/* Theory of the grid stands beside that without a grid where it applies, and agrees with what is
 * constant. */
static void theory_of_the_grid(void **state) {
    (void)state;
    static const char *const OF_SUMMITS[] = {"summit_height_pdf", "summit_height_cdf",
                                             "summit_mean_curvature", "summit_curvature_pdf",
                                             "summit_joint_pdf"};
    for (int s = 0; s < STUDY_COUNT; s++) {
        struct job_runner *runner = runner_of(STUDIES[s]);
        struct job_merger *merger = merger_of(STUDIES[s]);
        struct block_result result = run(runner, 0, REALISATIONS);
        merge(merger, &result);
        cJSON *document = curves_of(merger);
        bool grid = STUDIES[s] == GAUSSIAN || STUDIES[s] == LEVELS, exact = STUDIES[s] != WEIBULL;
        for (size_t q = 0; q < sizeof OF_SUMMITS / sizeof *OF_SUMMITS; q++)
            assert_int_equal(json_at(curve_of(document, OF_SUMMITS[q]), "/theory/grid") != NULL,
                             grid && strcmp(OF_SUMMITS[q], "summit_joint_pdf") != 0);
        if (exact) {
            double slope = scalar(document, "rms_slope", "value");
            assert_true(fabs(scalar(document, "rms_slope", "grid_theory") - slope) < 1e-12 * slope);
            assert_true(scalar(document, "rms_slope", "theory") > 1.001 * slope);
        }
        if (grid) {
            double error = scalar(document, "summit_density", "standard_error");
            double density = scalar(document, "summit_density", "value");
            double expected = scalar(document, "summit_density", "grid_theory");
            assert_true(fabs(density - expected) < 4 * error);
            assert_true(scalar(document, "kurtosis", "grid_theory") < 2.95);
            assert_shape_of_heights(document);
        } else {
            assert_true(isnan(scalar(document, "summit_density", "grid_theory")));
        }
        cJSON_Delete(document);
        block_result_clear(&result);
        merger_destroy(&merger);
        runner_destroy(&runner);
    }
}

/* Random amplitudes are estimated to cost a little more, as they do: 1.2 to 1.3 of fixed ones at 8
 * points a shortest wave. */
static void random_amplitudes_cost_little(void **state) {
    (void)state;
    static const char *const AMPLITUDES[] = {"fixed", "random"};
    struct study_cost cost[2];
    for (size_t a = 0; a < 2; a++) {
        char text[300];
        struct fault_list faults = {0};
        snprintf(text, sizeof text,
                 "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 8, \"length_ratio\": 8,"
                 " \"points_per_wavelength\": 8, \"amplitudes\": \"%s\"}}",
                 AMPLITUDES[a]);
        cJSON *parameters = parse(text);
        assert_int_equal(
            kind_check(&statistics_kind()->study, parameters, 0, &faults, &cost[a], NULL), 0);
        assert_int_equal(faults.count, 0);
        cJSON_Delete(parameters);
    }
    assert_true(cost[1].seconds > 1.1 * cost[0].seconds && cost[1].seconds < 1.4 * cost[0].seconds);
    assert_true(cost[1].memory_bytes > cost[0].memory_bytes);
}

/* Faults of a statistics case come with those of its surface. */
static void checking(void **state) {
    (void)state;
    struct fault_list faults = {0};
    struct study_cost estimate;
    cJSON *parameters = parse(GAUSSIAN);
    assert_int_equal(kind_check(&statistics_kind()->study, parameters, 0, &faults, &estimate, NULL),
                     0);
    assert_true(estimate.case_seconds > 0); /* publishing costs something, whatever it is of */
    assert_int_equal(faults.count, 0);
    assert_int_equal(estimate.nx, 32);
    assert_true(estimate.memory_bytes > 1e5 && estimate.memory_bytes < 1e8);
    assert_true(estimate.seconds > 0 && estimate.relative_error > 0 &&
                estimate.relative_error < 10);
    cJSON_Delete(parameters);
    parameters = parse("{\"surface\": {\"hurst\": 0.8}, \"statistics\": {\"bins\":"
                       " {\"height\": [3, 3, 5], \"curvature\": [0, 1, 0.5]}}}");
    assert_int_equal(kind_check(&statistics_kind()->study, parameters, 0, &faults, &estimate, NULL),
                     0);
    assert_int_equal(faults.count, 3);
    assert_string_equal(faults.faults[1].pointer, "/statistics/bins/height");
    assert_non_null(strstr(faults.faults[1].detail, "below high"));
    assert_string_equal(faults.faults[2].pointer, "/statistics/bins/curvature");
    fault_list_clear(&faults);
    cJSON_Delete(parameters);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(curves_against_brute_force),
        cmocka_unit_test(normalisation),
        cmocka_unit_test(bins_that_miss),
        cmocka_unit_test(no_error_is_zero),
        cmocka_unit_test(constants_and_pits),
        cmocka_unit_test(theory_of_the_grid),
        cmocka_unit_test(random_amplitudes_cost_little),
        cmocka_unit_test(checking),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
