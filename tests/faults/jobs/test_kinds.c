/* Protects: whichever allocation fails, a kind of job checks, runs, merges and makes curves, or
 * says that memory is short; nothing leaks, and the next attempt gives the same partial result. */
#include "tests/support/check.h"

#include "jobs/merger.h"
#include "jobs/runner.h"
#include "tests/support/failing/each_allocation.h"
#include <stdlib.h>
#include <string.h>

/* A late realisation that every subset has. Side solves are drawn once there, and hundreds of times
 * in the first realisations. */
static const uint64_t LATE = UINT64_C(1) << 20;

struct work {
    const char *kind, *text;
    uint64_t first, count; /* of realisations */
    struct block_result expected;
};

static const char PROFILE[] =
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.6, \"wavelength_ratio\": 4, \"length_ratio\": 2,"
    " \"points_per_wavelength\": 4}, \"statistics\": {\"summits\": \"refined\",\"bins\": "
    "{\"height\": [-4, 8, 24], \"curvature\": [-16, 0, 16]}}}";
static const char WEIBULL[] =
    "{\"surface\": {\"hurst\": 0.4, \"wavelength_ratio\": 2, \"length_ratio\": 2,"
    " \"points_per_wavelength\": 4, \"heights\": {\"distribution\": \"weibull_max\", \"shape\": "
    "2}},"
    " \"statistics\": {\"bins\": {\"height\": [0, 2, 10], \"curvature\": [-9, -1, 16]}}}";
static const char TRANSLATED[] =
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 2, \"length_ratio\": 2,"
    " \"points_per_wavelength\": 8, \"amplitudes\": \"random\", \"heights\": {\"distribution\":"
    " \"weibull_max\", \"shape\": 3, \"law\": \"translation\"}}, \"statistics\": {\"curvature\":"
    " \"spectral\", \"levels\": [4], \"bins\": {\"height\": [0, 2, 10], \"curvature\": [-9, -1, "
    "16]}}}";
static const char LINEAR[] =
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 2, \"length_ratio\": 1,"
    " \"points_per_wavelength\": 4, \"heights\": {\"distribution\": \"weibull_min\", \"shape\": "
    "2}},"
    " \"contact\": {\"model\": [\"layered\", \"halfspace\"],"
    " \"levels\": [2, 4], \"block_height\": {\"lengths\": 1}, \"pressures\": {\"values\": [0.1]},"
    " \"pressure_pdf\": {\"at\": [0.1], \"bins\": [0.2, 1, 4], \"pairs\": \"counted\"}}}";
static const char TWO_FACES[] =
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 2, \"length_ratio\": 1,"
    " \"points_per_wavelength\": 4}, \"counter_surface\": {\"spectrum\": {\"type\": \"table\","
    " \"wave_number\": [3, 6], \"density\": [1, 2]}}, \"contact\": {\"pressures\": {\"values\": "
    "[0.1]}}}";
static const char FULL[] =
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 2, \"length_ratio\": 1,"
    " \"points_per_wavelength\": 4, \"rms_slope\": 0.3}, \"contact\": {\"model\": [\"halfspace\", "
    "\"full\"],"
    " \"friction\": 0.3, \"slip\": {\"to\": [0.3], \"steps\": 2}, \"levels\": [4], "
    "\"block_height\": {\"lengths\": 1}, \"pressures\": {\"values\": [0.05]}}}";

/* What a kind says of a case, with its faults. */
static int check_case(void *context, struct error *err) {
    const struct work *work = context;
    struct fault_list faults = {0};
    struct study_cost cost = {0};
    cJSON *parameters = cJSON_Parse(work->text);
    int status = parameters != NULL
                     ? kind_check(&kind_find(work->kind)->study, parameters, 0, &faults, &cost, err)
                     : error_memory(err, strlen(work->text), "parameters");
    assert_int_equal(faults.count, 0);
    if (status == 0)
        assert_true(cost.seconds > 0 && isfinite(cost.memory_bytes));
    fault_list_clear(&faults);
    cJSON_Delete(parameters);
    return status;
}

static int run_block(const struct work *work, const cJSON *parameters, struct block_result *result,
                     struct error *err) {
    const struct job_kind *kind = kind_find(work->kind);
    struct job_shared *shared = NULL;
    struct job_runner *runner = NULL;
    int status = job_shared_create(&shared, kind, parameters, err);
    if (status == 0)
        status = runner_create(&runner, kind, parameters, shared, 5, 2, err);
    if (status == 0)
        status = runner_run(runner, work->first, work->count, NULL, result, err);
    runner_destroy(&runner);
    job_shared_destroy(&shared);
    return status;
}

static int run_case(void *context, struct error *err) {
    struct work *work = context;
    struct block_result result = {0};
    cJSON *parameters = cJSON_Parse(work->text);
    int status = parameters != NULL ? run_block(work, parameters, &result, err)
                                    : error_memory(err, strlen(work->text), "parameters");
    cJSON_Delete(parameters);
    if (status == 0 && work->expected.data == NULL) {
        work->expected = result;
        return 0;
    }
    if (status == 0) {
        assert_int_equal(result.size, work->expected.size);
        assert_memory_equal(result.data, work->expected.data, result.size);
    }
    block_result_clear(&result);
    return status;
}

static int merge_case(void *context, struct error *err) {
    const struct work *work = context;
    const struct job_kind *kind = kind_find(work->kind);
    struct job_merger *merger = NULL;
    struct case_result result = {0};
    cJSON *parameters = cJSON_Parse(work->text);
    int status = parameters != NULL ? merger_create(&merger, kind, parameters, err)
                                    : error_memory(err, strlen(work->text), "parameters");
    if (status == 0)
        status = merger_fits(merger, &work->expected, err);
    if (status == 0)
        status = merger_add(merger, &work->expected, err);
    if (status == 0)
        status = merger_result(merger, &result, err);
    if (status == 0)
        status = merger_complete(kind, parameters, &result, err);
    result_clear(&result);
    merger_destroy(&merger);
    cJSON_Delete(parameters);
    return status;
}

/* What is merged is of the first realisations, of which most is known. */
static void each_step(struct work work) {
    struct error err = {0};
    each_allocation(&(struct failing_call){.name = "check", check_case, &work, .may_succeed = 1});
    work.first = LATE;
    each_allocation(&(struct failing_call){.name = "run", run_case, &work});
    block_result_clear(&work.expected);
    work.first = 0;
    if (run_case(&work, &err) != 0)
        fail_msg("%s", err.text);
    each_allocation(&(struct failing_call){.name = "merge", merge_case, &work});
    block_result_clear(&work.expected);
}

static void statistics(void **state) {
    (void)state;
    each_step((struct work){.kind = "statistics", .text = PROFILE, .count = 2});
    each_step((struct work){.kind = "statistics", .text = WEIBULL, .count = 2});
    each_step((struct work){.kind = "statistics", .text = TRANSLATED, .count = 2});
}

static void contact(void **state) {
    (void)state;
    each_step((struct work){.kind = "contact", .text = LINEAR, .count = 2});
    each_step((struct work){.kind = "contact", .text = TWO_FACES, .count = 2});
    each_step((struct work){.kind = "contact", .text = FULL, .count = 1});
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statistics),
        cmocka_unit_test(contact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
