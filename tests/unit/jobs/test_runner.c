/* Protects: cost is what a thread computed, not how long it took while others had the processor; a
 * block that cannot be is refused with what is wrong of it; a block is stopped while a surface is
 * iterated, and has the realisations before it. */
#include "jobs/runner.h"
#include "schema/json/json.h"
#include "tests/support/check.h"
#include <string.h>
#include <time.h>

enum { PAUSE_MS = 20, REALISATIONS = 10 };

/* Keeps the thread waiting, as a busy machine does. */
static int wait_a_while(void *context, double done) {
    const struct timespec pause = {0, PAUSE_MS * 1000000L};
    (void)context, (void)done;
    nanosleep(&pause, NULL);
    return 0;
}

static const char STUDY[] = "{\"surface\":{\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,"
                            "\"length_ratio\":2},\"statistics\":{\"summits\":\"refined\"}}";

static void waiting_costs_no_processor_time(void **state) {
    (void)state;
    const struct job_control control = {.poll = wait_a_while};
    struct job_runner *runner = NULL;
    struct block_result result = {0};
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(STUDY);
    assert_non_null(parameters);
    if (runner_create(&runner, kind_find("statistics"), parameters, NULL, 1, 0, &err) != 0 ||
        runner_run(runner, 0, REALISATIONS, &control, &result, &err) != 0)
        fail_msg("%s", err.text);
    assert_true(result.seconds >= 1e-3 * PAUSE_MS * REALISATIONS);
    /* ten profiles of 64 points take less than a millisecond */
    assert_true(result.cpu_seconds > 0 && result.cpu_seconds < result.seconds / 2);
    block_result_clear(&result);
    runner_destroy(&runner);
    cJSON_Delete(parameters);
}

static void blocks_that_cannot_be_are_refused(void **state) {
    (void)state;
    static const struct {
        uint64_t first, count;
        const char *said;
    } BLOCKS[] = {
        {0, 0, "a block needs at least one realisation"},
        {UINT64_MAX - 1, 2,
         "a block of 2 realisations from number 18446744073709551614 on: numbers are below "
         "2^64 - 1"}};
    struct job_runner *runner = NULL;
    cJSON *parameters = cJSON_Parse(STUDY);
    assert_int_equal(runner_create(&runner, kind_find("statistics"), parameters, NULL, 1, 0, NULL),
                     0);
    for (size_t b = 0; b < sizeof BLOCKS / sizeof *BLOCKS; b++) {
        struct block_result result = {0};
        struct error err = {0};
        assert_int_equal(runner_run(runner, BLOCKS[b].first, BLOCKS[b].count, NULL, &result, &err),
                         ERROR_INPUT);
        assert_string_equal(err.text, BLOCKS[b].said);
    }
    runner_destroy(&runner);
    cJSON_Delete(parameters);
}

static int stop_at_last(void *context, double done) {
    size_t *left = context;
    bool last = *left == 0;
    (void)done;
    *left -= last ? 0 : 1;
    return last;
}

/* Runs two realisations that are asked `polls` times before the answer is to stop. */
static int run_for(const char *study, size_t polls, struct block_result *result) {
    const struct job_control control = {.poll = stop_at_last, .context = &polls};
    struct job_runner *runner = NULL;
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(study);
    assert_non_null(parameters);
    if (runner_create(&runner, kind_find("statistics"), parameters, NULL, 1, 0, &err) != 0)
        fail_msg("%s", err.text);
    int status = runner_run(runner, 0, 2, &control, result, &err);
    runner_destroy(&runner);
    cJSON_Delete(parameters);
    return status;
}

#define WEIBULL(more)                                                                              \
    "{\"surface\":{\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":2,"       \
    "\"heights\":{\"distribution\":\"weibull_min\",\"shape\":2.5," more                            \
    "},\"statistics\":{\"summits\":\"refined\"}}"

/* A run asks once before each of at most 50 iterations, and the runner once before each
 * realisation: 20 askings end within the first surface. */
static void surfaces_are_stopped_while_they_are_iterated(void **state) {
    (void)state;
    static const char ITERATED[] = WEIBULL(
        "\"tolerance\":0,\"stall_gain\":0,\"stall_iterations\":1000,\"max_iterations\":50}");
    struct block_result result = {0};
    assert_int_equal(run_for(ITERATED, 20, &result), ERROR_STOPPED);
    assert_int_equal(run_for(ITERATED, 70, &result), 0);
    assert_int_equal(result.count, 1);
    /* the surface of the other law is iterated while the first realisation is measured */
    assert_int_equal(
        run_for(WEIBULL("\"law\":\"translation\"},\"amplitudes\":\"random\""), 3, &result),
        ERROR_STOPPED);
    block_result_clear(&result);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waiting_costs_no_processor_time),
        cmocka_unit_test(blocks_that_cannot_be_are_refused),
        cmocka_unit_test(surfaces_are_stopped_while_they_are_iterated)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
