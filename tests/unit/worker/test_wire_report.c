/* Many reports in one request: each has its own answer, and nothing malformed gets in. */
#include "tests/unit/worker/crossing.h"
#include "worker/link/wire_report.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void reports_and_answers_cross(void **state) {
    (void)state;
    struct claimed_job jobs[4] = {{0}};
    const double scalars[] = {0.1, (double)NAN};
    const char *names[] = {"a", "b"};
    unsigned char data[] = {0, 255, 7};
    struct block_result result = {.first = 5,
                                  .count = 1,
                                  .seconds = 0.25,
                                  .cpu_seconds = 0.125,
                                  .scalar_count = 2,
                                  .names = names,
                                  .scalars = scalars,
                                  .data = data,
                                  .size = sizeof data};
    struct report reports[4];
    for (size_t n = 0; n < 4; n++) {
        jobs[n].id = 9007199254740991 - (int64_t)n; /* 2^53 - 1 - n */
        memcpy(jobs[n].token, TOKEN, sizeof TOKEN);
        reports[n] = (struct report){.verb = (enum report_verb)n,
                                     .job = &jobs[n],
                                     .done = 77,
                                     .result = &result,
                                     .reason = "no convergence",
                                     .permanent = true};
    }
    cJSON *value = cross(wire_reports(reports, 4));
    struct wire_item *items = NULL;
    struct error err = {0};
    size_t count = 0;
    assert_int_equal(wire_reports_read(value, &items, &count, &err), 0);
    assert_int_equal(count, 4);
    for (size_t n = 0; n < 4; n++) {
        assert_int_equal(items[n].status, 0);
        assert_int_equal(items[n].verb, reports[n].verb);
        assert_true(items[n].job == jobs[n].id);
        assert_string_equal(items[n].report.token, TOKEN);
    }
    assert_true(items[0].report.done == 77 && items[2].report.permanent);
    assert_string_equal(items[2].report.reason, "no convergence");
    assert_true(items[1].block.first == 5 && items[1].block.size == sizeof data);
    assert_true(isnan(items[1].block.scalars[1]));
    items[1].case_done = true;
    items[2].status = error_set(&items[2].err, ERROR_STATE, "the lease is lost");
    items[3].status = error_set(&items[3].err, ERROR_ABSENT, "there is no job");
    cJSON *answers = cross(wire_answers(items, count));
    assert_int_equal(wire_answers_read(answers, reports, 4, &err), 0);
    assert_true(reports[0].status == 0 && reports[1].status == 0);
    assert_int_equal(reports[2].status, ERROR_STATE);
    assert_string_equal(reports[2].err.text, "the lease is lost");
    assert_int_equal(reports[3].status, ERROR_ABSENT);
    wire_items_free(items, count);
    cJSON_Delete(answers);
    cJSON_Delete(value);
}

/* Without verb or job the whole is refused, else the one report alone. */
static void malformed_reports_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *text;
        int whole, one;
    } table[] = {
        {"{}", ERROR_INPUT, 0},
        {"[]", ERROR_INPUT, 0},
        {"{\"reports\":[]}", ERROR_INPUT, 0},
        {"{\"reports\":[7]}", ERROR_INPUT, 0},
        {"{\"reports\":[{\"verb\":\"dance\",\"job\":1,\"token\":\"t\"}]}", ERROR_INPUT, 0},
        {"{\"reports\":[{\"verb\":\"release\",\"token\":\"t\"}]}", ERROR_INPUT, 0},
        {"{\"reports\":[{\"verb\":\"release\",\"job\":-1,\"token\":\"t\"}]}", ERROR_INPUT, 0},
        {"{\"reports\":[{\"verb\":\"release\",\"job\":1}]}", 0, ERROR_INPUT},
        {"{\"reports\":[{\"verb\":\"heartbeat\",\"job\":1,\"token\":\"t\",\"done\":-1}]}", 0,
         ERROR_INPUT},
        {"{\"reports\":[{\"verb\":\"complete\",\"job\":1,\"token\":\"t\",\"first\":0}]}", 0,
         ERROR_INPUT},
        {"{\"reports\":[{\"verb\":\"fail\",\"job\":1,\"token\":\"t\"}]}", 0, 0},
    };
    for (size_t n = 0; n < sizeof table / sizeof *table; n++) {
        struct error err = {0};
        cJSON *value = NULL;
        struct wire_item *items = NULL;
        size_t count = 0;
        assert_int_equal(json_parse(table[n].text, strlen(table[n].text), NULL, &value, &err), 0);
        assert_int_equal(wire_reports_read(value, &items, &count, &err), table[n].whole);
        if (table[n].whole == 0) {
            assert_int_equal(items[0].status, table[n].one);
            assert_true(strlen(items[0].report.reason) > 0);
        }
        wire_items_free(items, count);
        cJSON_Delete(value);
    }
}

static void too_many_reports_are_refused(void **state) {
    (void)state;
    struct claimed_job job = {.id = 1};
    memcpy(job.token, TOKEN, sizeof TOKEN);
    struct report *reports = calloc(WIRE_REPORTS_MOST + 1, sizeof *reports);
    assert_non_null(reports);
    for (size_t n = 0; n <= WIRE_REPORTS_MOST; n++)
        reports[n] = (struct report){.verb = REPORT_RELEASE, .job = &job};
    for (size_t most = WIRE_REPORTS_MOST; most <= WIRE_REPORTS_MOST + 1; most++) {
        struct error err = {0};
        struct wire_item *items = NULL;
        size_t count = 0;
        cJSON *value = cross(wire_reports(reports, most));
        assert_int_equal(wire_reports_read(value, &items, &count, &err),
                         most > WIRE_REPORTS_MOST ? ERROR_INPUT : 0);
        wire_items_free(items, count);
        cJSON_Delete(value);
    }
    free(reports);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reports_and_answers_cross),
        cmocka_unit_test(malformed_reports_are_refused),
        cmocka_unit_test(too_many_reports_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
