/* Protects: cost is what a thread computed, not how long it took while others had the processor; a
 * block that cannot be is refused with what is wrong of it. */
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

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(waiting_costs_no_processor_time),
                                       cmocka_unit_test(blocks_that_cannot_be_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
