/* Errors of statistics are held to what they claim: many small studies of one case against all of
 * them together, bin by bin, apart for bins that few, some and most realisations of a study have.
 *
 * A Gaussian error known from 20 realisations would hold in 67 % (one) and 94 % (two) of all
 * studies. Bins that most studies do not see have bounds, which hold in more. Tails of heights, to
 * which few clusters of many points add, hold in the least: measured on 400 studies 66 and 88 %. */
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

enum { STUDIES = 120, REALISATIONS = 20, CLASSES = 4, BINS_MOST = 200, SEED = 71 };

static const char *const QUANTITIES[] = {"height_pdf",           "height_cdf",
                                         "summit_height_pdf",    "summit_height_cdf",
                                         "summit_curvature_pdf", "summit_mean_curvature"};
enum { QUANTITY_COUNT = 6 };
static const char *const CLASS_NAMES[CLASSES] = {"below 0.5", "0.5 to 3", "3 to 10", "above 10"};

/* A curve of all studies. */
struct told {
    size_t n;
    double y[STUDIES][BINS_MOST], error[STUDIES][BINS_MOST];
    double truth[BINS_MOST]; /* of all studies together */
    double share[BINS_MOST]; /* realisations of a study that have the bin, on the mean */
};
static struct told told[QUANTITY_COUNT];

static struct job_merger *merger_of(const cJSON *parameters) {
    struct error err = {0};
    struct job_merger *merger = NULL;
    if (merger_create(&merger, kind_find("statistics"), parameters, &err) != 0)
        fail_msg("%s", err.text);
    return merger;
}

static void result_of(struct job_merger *merger, struct case_result *out) {
    struct error err = {0};
    *out = (struct case_result){0};
    if (merger_result(merger, out, &err) != 0)
        fail_msg("%s", err.text);
}

static void keep_study(size_t study, const struct case_result *result) {
    for (size_t q = 0; q < QUANTITY_COUNT; q++) {
        const struct curve *curve = result_curve(result, QUANTITIES[q]);
        assert_true(curve != NULL && curve->n <= BINS_MOST);
        told[q].n = curve->n;
        for (size_t b = 0; b < curve->n; b++) {
            told[q].y[study][b] = curve->y[b];
            told[q].error[study][b] = curve->standard_error[b];
        }
    }
}

static void keep_truth(const struct case_result *all) {
    for (size_t q = 0; q < QUANTITY_COUNT; q++) {
        const struct curve *curve = result_curve(all, QUANTITIES[q]);
        /* cumulative ones: by the density of the same bin */
        const struct curve *density = q > 0 && strstr(QUANTITIES[q], "_cdf") != NULL
                                          ? result_curve(all, QUANTITIES[q - 1])
                                          : curve;
        for (size_t b = 0; b < curve->n; b++) {
            told[q].truth[b] = curve->y[b];
            told[q].share[b] = REALISATIONS - density->valueless[b] / STUDIES;
        }
    }
}

static void run_studies(const char *text) {
    struct error err = {0};
    struct job_runner *runner = NULL;
    struct case_result result;
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    struct job_merger *all = merger_of(parameters);
    if (runner_create(&runner, kind_find("statistics"), parameters, NULL, SEED, 0, &err) != 0)
        fail_msg("%s", err.text);
    for (size_t s = 0; s < STUDIES; s++) {
        struct job_merger *one = merger_of(parameters);
        struct block_result block = {0};
        if (runner_run(runner, s * REALISATIONS, REALISATIONS, NULL, &block, &err) != 0 ||
            merger_add(one, &block, &err) != 0 || merger_add(all, &block, &err) != 0)
            fail_msg("%s", err.text);
        result_of(one, &result);
        keep_study(s, &result);
        result_clear(&result);
        block_result_clear(&block);
        merger_destroy(&one);
    }
    result_of(all, &result);
    keep_truth(&result);
    result_clear(&result);
    merger_destroy(&all);
    runner_destroy(&runner);
    cJSON_Delete(parameters);
}

static size_t class_of(double share) {
    return share < 0.5 ? 0 : share < 3 ? 1 : share < 10 ? 2 : 3;
}

/* Prints how often a quantity lies within its errors, and fails where that is too rarely. Bins that
 * fewer than 5 of all realisations have are known too little themselves. */
static void check_quantity(size_t q) {
    double all[CLASSES] = {0}, one[CLASSES] = {0}, two[CLASSES] = {0}, none[CLASSES] = {0};
    double squares[CLASSES] = {0};
    for (size_t b = 0; b < told[q].n; b++) {
        if (!(told[q].share[b] * STUDIES >= 5))
            continue;
        size_t c = class_of(told[q].share[b]);
        for (size_t s = 0; s < STUDIES; s++) {
            double y = told[q].y[s][b], error = told[q].error[s][b];
            if (isnan(error)) {
                none[c]++;
                continue;
            }
            assert_true(error > 0);
            double z = fabs(y - told[q].truth[b]) / error;
            all[c]++;
            one[c] += z <= 1;
            two[c] += z <= 2;
            squares[c] += z * z;
        }
    }
    for (size_t c = 0; c < CLASSES; c++) {
        printf("%-22s %-10s %8.0f  within one %.3f  two %.3f  rms %.2f  none %.3f\n", QUANTITIES[q],
               CLASS_NAMES[c], all[c], one[c] / all[c], two[c] / all[c], sqrt(squares[c] / all[c]),
               none[c] / (all[c] + none[c]));
        bool ratio = strcmp(QUANTITIES[q], "summit_mean_curvature") == 0;
        assert_true(ratio || none[c] == 0);
        assert_true(all[c] > (ratio ? 30 : 500));
        assert_true(one[c] > 0.63 * all[c] && two[c] > 0.86 * all[c]);
    }
}

static void gaussian_surfaces(void **state) {
    (void)state;
    run_studies(
        "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2,"
        " \"points_per_wavelength\": 8}, \"statistics\": {\"bins\": {\"height\": [-4, 4, 160],"
        " \"curvature\": [-12, 0, 80]}}}");
    for (size_t q = 0; q < QUANTITY_COUNT; q++)
        check_quantity(q);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gaussian_surfaces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
