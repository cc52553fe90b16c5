/* Jobs and results cross the network unchanged, bit for bit, and nothing malformed gets in. */
#include "schema/json/field.h"
#include "tests/support/seed.h"
#include "tests/unit/worker/crossing.h"
#include "worker/link/wire.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char STUDY[] = "0123456789abcdef";

static const char PARAMETERS[] = "{\"surface\":{\"hurst\":0.1,\"list\":[1,2.5e-300,null]}}";

/* cJSON_Delete its parameters. */
static struct claimed_job some_job(void) {
    struct claimed_job job = {
        .id = 9007199254740991, /* 2^53 - 1 */
        .kind = (char *)"statistics",
        .parameters = cJSON_Parse(PARAMETERS),
        .seed = UINT64_MAX,
        .sequence = 12,
        .case_number = 9999,
        .first = 4294967296,
        .count = 7,
        .attempt = 3,
        .lease_ms = 61234,
    };
    memcpy(job.study, STUDY, sizeof STUDY);
    memcpy(job.token, TOKEN, sizeof TOKEN);
    return job;
}

/* Protects the seed (beyond 2^53), the fence and the block against loss between server and
 * worker. */
static void job_crosses_unchanged(void **state) {
    (void)state;
    struct claimed_job sent = some_job(), got = {0};
    struct error err = {0};
    size_t count = 0;
    cJSON *value = cross(wire_jobs(&sent, 1));
    assert_int_equal(wire_jobs_read(value, &got, 1, &count, &err), 0);
    assert_int_equal(count, 1);
    assert_true(got.id == sent.id && got.seed == sent.seed && got.lease_ms == sent.lease_ms);
    assert_true(got.case_number == sent.case_number && got.attempt == sent.attempt);
    assert_true(got.sequence == sent.sequence);
    assert_true(got.first == sent.first && got.count == sent.count);
    assert_string_equal(got.study, STUDY);
    assert_string_equal(got.token, TOKEN);
    assert_string_equal(got.kind, "statistics");
    char *parameters = json_print(got.parameters);
    assert_string_equal(parameters, PARAMETERS);
    free(parameters);
    claimed_job_clear(&got);
    cJSON_Delete(value);
    cJSON_Delete(sent.parameters);
}

/* A job of a server that knows no sequence is drawn by the number of its case, as it wants it; a
 * worker that knows none says nothing of it in its claim, and must get no other job. */
static void sequences_are_by_case_for_older_ends(void **state) {
    (void)state;
    struct claimed_job sent = some_job(), got = {0};
    struct claim claim = {.worker = "w", .count = 1};
    struct wire_claim read;
    struct error err = {0};
    size_t count = 0;
    cJSON *value = cross(wire_jobs(&sent, 1));
    cJSON_DeleteItemFromObject(cJSON_GetObjectItem(value, "jobs")->child, "sequence");
    assert_int_equal(wire_jobs_read(value, &got, 1, &count, &err), 0);
    assert_int_equal(got.sequence, sent.case_number);
    claimed_job_clear(&got);
    cJSON_Delete(value);
    cJSON_Delete(sent.parameters);
    value = cross(wire_claim(&claim));
    assert_int_equal(wire_claim_read(value, &read, &err), 0);
    assert_false(read.claim.independent_only);
    cJSON_DeleteItemFromObject(value, "sequence");
    assert_int_equal(wire_claim_read(value, &read, &err), 0);
    assert_true(read.claim.independent_only);
    cJSON_AddNumberToObject(value, "sequence", 1);
    assert_int_equal(wire_claim_read(value, &read, &err), ERROR_INPUT);
    assert_string_equal(err.text, "/sequence: 1 is not true or false");
    cJSON_Delete(value);
}

static void no_jobs_cross(void **state) {
    (void)state;
    struct claimed_job got = {0};
    struct error err = {0};
    size_t count = 9;
    cJSON *value = cross(wire_jobs(NULL, 0));
    assert_int_equal(wire_jobs_read(value, &got, 1, &count, &err), 0);
    assert_int_equal(count, 0);
    cJSON_Delete(value);
}

/* One change to a good job at a time: each is refused with the field's name, nothing leaks. */
static void malformed_jobs_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *key, *json; /* NULL: left out */
    } table[] = {
        {"id", "\"1\""},
        {"id", "1.5"},
        {"id", "-1"},
        {"id", "1e17"},
        {"study", "\"\""},
        {"study", "\"0123456789abcdef0\""},
        {"kind", NULL},
        {"case", "null"},
        {"seed", "12"},
        {"sequence", "-1"},
        {"sequence", "\"common\""},
        {"seed", "\"\""},
        {"seed", "\"-1\""},
        {"seed", "\"18446744073709551616\""},
        {"seed", "\" 1\""},
        {"first", "[]"},
        {"count", "0"},
        {"count", NULL},
        {"attempt", "true"},
        {"token", NULL},
        {"token", "{}"},
        {"lease_seconds", "-1"},
        {"lease_seconds", "\"60\""},
        {"parameters", "[]"},
        {"parameters", NULL},
    };
    struct claimed_job job = some_job();
    for (size_t n = 0; n < sizeof table / sizeof table[0]; n++) {
        cJSON *value = cross(wire_jobs(&job, 1));
        cJSON *first = cJSON_GetObjectItem(value, "jobs")->child;
        cJSON_DeleteItemFromObjectCaseSensitive(first, table[n].key);
        if (table[n].json) {
            cJSON_AddItemToObject(first, table[n].key, cJSON_Parse(table[n].json));
        }
        struct claimed_job got = {0};
        struct error err = {0};
        size_t count = 9;
        assert_int_equal(wire_jobs_read(value, &got, 1, &count, &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, table[n].key));
        assert_int_equal(count, 9);
        assert_null(got.kind);
        cJSON_Delete(value);
    }
    cJSON_Delete(job.parameters);
}

static void more_jobs_than_room_are_refused(void **state) {
    (void)state;
    struct claimed_job jobs[2] = {some_job(), some_job()}, got[1] = {{0}};
    struct error err = {0};
    size_t count = 0;
    cJSON *value = cross(wire_jobs(jobs, 2));
    assert_int_equal(wire_jobs_read(value, got, 1, &count, &err), ERROR_INPUT);
    cJSON_Delete(value);
    cJSON_Delete(jobs[0].parameters);
    cJSON_Delete(jobs[1].parameters);
}

static void claim_crosses(void **state) {
    (void)state;
    const char *const kinds[] = {"statistics", "contact", NULL};
    struct claim claim = {.worker = "host-1-0",
                          .host = "host",
                          .kinds = kinds,
                          .count = 3,
                          .program = "0.0.1+c0ffee"};
    struct wire_claim got;
    struct error err = {0};
    cJSON *value = cross(wire_claim(&claim));
    assert_int_equal(wire_claim_read(value, &got, &err), 0);
    assert_string_equal(got.claim.worker, "host-1-0");
    assert_string_equal(got.claim.host, "host");
    assert_string_equal(got.claim.program, "0.0.1+c0ffee");
    assert_int_equal(got.claim.count, 3);
    assert_string_equal(got.claim.kinds[1], "contact");
    assert_null(got.claim.kinds[2]);
    cJSON_Delete(value);
}

static void a_kind_counts_once(void **state) {
    (void)state;
    struct wire_claim got;
    struct error err = {0};
    cJSON *value = cJSON_Parse("{\"worker\":\"w\",\"host\":\"h\",\"count\":1,"
                               "\"kinds\":[\"contact\",\"statistics\",\"contact\"]}");
    assert_non_null(value);
    assert_int_equal(wire_claim_read(value, &got, &err), 0);
    assert_string_equal(got.claim.kinds[1], "statistics");
    assert_null(got.claim.kinds[2]);
    cJSON_Delete(value);
}

/* A worker whose program makes results of a kind in another form must get no jobs of it; one that
 * names no form may have any, as workers of older versions. */
static void kinds_of_other_forms_are_left_out(void **state) {
    (void)state;
    const char *const kinds[] = {"contact", "rolling", "statistics", NULL};
    struct claim claim = {.worker = "w", .kinds = kinds, .count = 1};
    struct wire_claim got;
    struct error err = {0};
    cJSON *value = cross(wire_claim(&claim)), *forms = cJSON_GetObjectItem(value, "forms");
    assert_int_equal(wire_claim_read(value, &got, &err), 0);
    assert_string_equal(got.claim.kinds[2], "statistics");
    assert_string_equal(got.other_forms, "");
    cJSON *form = cJSON_GetObjectItem(forms, "contact");
    assert_true(form->valuedouble > 0);
    cJSON_SetNumberValue(form, form->valuedouble + 1);
    assert_int_equal(wire_claim_read(value, &got, &err), 0);
    assert_string_equal(got.claim.kinds[0], "rolling");
    assert_string_equal(got.claim.kinds[1], "statistics");
    assert_null(got.claim.kinds[2]);
    assert_string_equal(got.other_forms, "contact");
    form = cJSON_GetObjectItem(forms, "statistics");
    cJSON_SetNumberValue(form, 0);
    assert_int_equal(wire_claim_read(value, &got, &err), 0);
    assert_string_equal(got.claim.kinds[0], "rolling");
    assert_null(got.claim.kinds[1]);
    assert_string_equal(got.other_forms, "contact, statistics");
    cJSON_SetNumberValue(form, 0.5);
    assert_int_equal(wire_claim_read(value, &got, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "/forms: {"));
    assert_non_null(strstr(err.text, " is not an object of whole numbers by kinds"));
    cJSON_DeleteItemFromObject(value, "forms");
    assert_int_equal(wire_claim_read(value, &got, &err), 0);
    assert_string_equal(got.claim.kinds[2], "statistics");
    cJSON_Delete(value);
}

/* Names of peers are shown and stored: 255 bytes of each are taken. */
static void names_of_hosts_are_bounded(void **state) {
    (void)state;
    for (size_t length = 255; length <= 256; length++) {
        char host[257] = "";
        struct wire_claim got;
        struct error err = {0};
        memset(host, 'h', length);
        const struct claim claim = {.worker = "w", .host = host};
        cJSON *value = cross(wire_claim(&claim));
        assert_int_equal(wire_claim_read(value, &got, &err), length == 255 ? 0 : ERROR_INPUT);
        cJSON_Delete(value);
    }
}

static void claims_are_bounded(void **state) {
    (void)state;
    struct wire_claim got;
    struct error err = {0};
    static const struct {
        const char *json;
        int status;
    } table[] = {
        {"{\"worker\":\"w\"}", 0},
        {"{\"worker\":\"w\",\"count\":1e9,\"new\":[{}]}", 0},
        {"{\"worker\":\"\"}", ERROR_INPUT},
        {"{\"worker\":\"w\",\"host\":1}", ERROR_INPUT},
        {"{\"worker\":\"w\",\"kinds\":\"statistics\"}", ERROR_INPUT},
        {"{\"worker\":\"w\",\"kinds\":[1]}", ERROR_INPUT},
        {"{\"worker\":\"w\",\"count\":-1}", ERROR_INPUT},
        {"{\"worker\":\"w\",\"forms\":[1]}", ERROR_INPUT},
        {"[]", ERROR_INPUT},
        {"null", ERROR_INPUT},
    };
    for (size_t n = 0; n < sizeof table / sizeof table[0]; n++) {
        cJSON *value = cJSON_Parse(table[n].json);
        assert_int_equal(wire_claim_read(value, &got, &err), table[n].status);
        if (table[n].status == 0) {
            assert_true(got.claim.count <= WIRE_JOBS_MOST);
            assert_null(got.claim.kinds);
        }
        cJSON_Delete(value);
    }
}

/* Bit patterns that printing is apt to lose, and random ones (any bits that are a finite number).
 */
enum { EXTREMES = 12, RANDOM = 4000, WIDTH = 4 };
static void fill(double *values, size_t n) {
    static const double extremes[EXTREMES] = {0.0,      -0.0,         DBL_MIN,
                                              -DBL_MAX, DBL_TRUE_MIN, DBL_EPSILON,
                                              0.1,      1.0 / 3.0,    9007199254740993.0,
                                              1e23,     4.9e-322,     123456789012345680.0};
    uint64_t seed = seed_or(8);
    for (size_t i = 0; i < n; i++) {
        if (i < EXTREMES) {
            values[i] = extremes[i];
            continue;
        }
        do {
            uint64_t word = next_word(&seed);
            memcpy(&values[i], &word, sizeof word);
        } while (!isfinite(values[i]));
    }
}

static uint64_t bits(double number) {
    uint64_t word;
    memcpy(&word, &number, sizeof word);
    return word;
}

/* Protects the promise that workers over HTTP give the same bits as local ones. */
static void result_crosses_bit_for_bit(void **state) {
    (void)state;
    static double scalars[RANDOM * WIDTH];
    static unsigned char data[1000];
    const char *const names[] = {"m0", "eps_h", "a", "b"};
    fill(scalars, RANDOM * WIDTH);
    scalars[17] = (double)NAN;
    for (size_t n = 0; n < sizeof data; n++) {
        data[n] = (unsigned char)(n * 37);
    }
    struct block_result sent = {.first = 12,
                                .count = RANDOM,
                                .scalar_count = WIDTH,
                                .names = names,
                                .scalars = scalars,
                                .data = data,
                                .size = sizeof data,
                                .seconds = 0.1,
                                .cpu_seconds = 0.07};
    struct block_result block;
    char token[TOKEN_SIZE];
    struct error err = {0};
    cJSON *value = cross(wire_result(TOKEN, &sent));
    assert_int_equal(wire_result_read(value, token, &block, &err), 0);
    assert_string_equal(token, TOKEN);
    assert_true(block.first == 12 && block.count == RANDOM && block.scalar_count == WIDTH);
    assert_string_equal(block.names[3], "b");
    assert_true(isnan(block.scalars[17]));
    for (size_t n = 0; n < RANDOM * WIDTH; n++) {
        if (n != 17 && bits(scalars[n]) != bits(block.scalars[n])) {
            fail_msg("scalar %zu: %a became %a", n, scalars[n], block.scalars[n]);
        }
    }
    assert_int_equal(block.size, sizeof data);
    assert_memory_equal(block.data, data, sizeof data);
    assert_true(block.seconds == 0.1 && block.cpu_seconds == 0.07);
    block_result_clear(&block);
    cJSON_DeleteItemFromObject(value, "cpu_seconds"); /* as a worker of an older program */
    assert_int_equal(wire_result_read(value, token, &block, &err), 0);
    assert_true(block.seconds == 0.1 && isnan(block.cpu_seconds));
    block_result_clear(&block);
    cJSON_Delete(value);
}

static void malformed_results_are_refused(void **state) {
    (void)state;
    static const char *const table[] = {
        "{}",
        "[]",
        "{\"token\":\"t\",\"seconds\":1,\"first\":0,\"count\":1,\"data\":\"\"}",
        "{\"token\":\"t\",\"seconds\":1,\"first\":0,\"count\":2,\"data\":\"\","
        "\"scalars\":{\"names\":[\"a\"],\"rows\":[[1]]}}",
        "{\"token\":\"t\",\"seconds\":1,\"first\":0,\"count\":9e15,\"data\":\"\","
        "\"scalars\":{\"names\":[\"a\"],\"rows\":[[1]]}}",
        "{\"token\":\"t\",\"seconds\":1,\"first\":0,\"count\":1,\"data\":\"\","
        "\"scalars\":{\"names\":[\"a\"],\"rows\":[[1,2]]}}",
        "{\"token\":\"t\",\"seconds\":1,\"first\":0,\"count\":1,\"data\":\"\","
        "\"scalars\":{\"names\":[\"a\",\"b\"],\"rows\":[[1]]}}",
        "{\"token\":\"t\",\"seconds\":1,\"first\":0,\"count\":1,\"data\":\"\","
        "\"scalars\":{\"names\":[\"a\"],\"rows\":[[\"1\"]]}}",
        "{\"token\":\"t\",\"seconds\":1,\"first\":0,\"count\":1,\"data\":\"\","
        "\"scalars\":{\"names\":[1],\"rows\":[[1]]}}",
        "{\"token\":\"t\",\"seconds\":1,\"first\":0,\"count\":1,\"data\":\"*\","
        "\"scalars\":{\"names\":[\"a\"],\"rows\":[[1]]}}",
        "{\"token\":\"t\",\"seconds\":1,\"first\":0,\"count\":1,"
        "\"scalars\":{\"names\":[\"a\"],\"rows\":[[1]]}}",
        "{\"token\":\"t\",\"seconds\":-1,\"first\":0,\"count\":1,\"data\":\"\","
        "\"scalars\":{\"names\":[\"a\"],\"rows\":[[1]]}}",
        "{\"token\":\"t\",\"seconds\":1,\"first\":0,\"count\":1,\"data\":\"\","
        "\"scalars\":{\"names\":[\"a\"],\"rows\":[3]}}",
        "{\"token\":\"t\",\"seconds\":1,\"cpu_seconds\":-1,\"first\":0,\"count\":1,\"data\":"
        "\"\",\"scalars\":{\"names\":[\"a\"],\"rows\":[[1]]}}",
    };
    for (size_t n = 0; n < sizeof table / sizeof table[0]; n++) {
        struct block_result got;
        char token[TOKEN_SIZE];
        struct error err = {0};
        cJSON *value = cJSON_Parse(table[n]);
        assert_non_null(value);
        assert_int_equal(wire_result_read(value, token, &got, &err), ERROR_INPUT);
        assert_true(err.text[0] != '\0');
        cJSON_Delete(value);
    }
}

static void reports_cross(void **state) {
    (void)state;
    struct wire_report got;
    struct error err = {0};
    cJSON *value = cross(wire_heartbeat(TOKEN, 41));
    assert_int_equal(wire_report_read(value, &got, &err), 0);
    assert_true(got.done == 41 && !got.permanent && got.reason[0] == '\0');
    cJSON_Delete(value);
    value = cross(wire_heartbeat(TOKEN, 41.25));
    assert_int_equal(wire_report_read(value, &got, &err), 0);
    assert_true(got.done == 41.25);
    assert_true(field_number(value, "done") == 41); /* which older servers read */
    cJSON_SetNumberValue(cJSON_GetObjectItem(value, "part"), 1);
    assert_int_equal(wire_report_read(value, &got, &err), ERROR_INPUT);
    cJSON_DeleteItemFromObject(value, "part"); /* of an older worker */
    assert_int_equal(wire_report_read(value, &got, &err), 0);
    assert_true(got.done == 41);
    cJSON_Delete(value);
    value = cross(wire_fail(TOKEN, "no \"convergence\"\n", true));
    assert_int_equal(wire_report_read(value, &got, &err), 0);
    assert_true(got.permanent);
    assert_string_equal(got.reason, "no \"convergence\"\n");
    assert_string_equal(got.token, TOKEN);
    cJSON_Delete(value);
    value = cross(wire_release(""));
    assert_int_equal(wire_report_read(value, &got, &err), ERROR_INPUT);
    cJSON_Delete(value);
}

/* A cut in the middle of a character would make the stored reason no UTF-8. */
static void long_reason_is_cut_between_characters(void **state) {
    (void)state;
    char reason[2 * WIRE_REASON_MOST + 2];
    for (size_t n = 0; n < WIRE_REASON_MOST; n++) {
        memcpy(reason + 1 + 2 * n, "\xc3\xa9", 2);
    }
    reason[0] = 'x';
    reason[sizeof reason - 1] = '\0';
    struct wire_report got;
    struct error err = {0};
    cJSON *value = cross(wire_fail(TOKEN, reason, false));
    assert_int_equal(wire_report_read(value, &got, &err), 0);
    assert_int_equal(strlen(got.reason), WIRE_REASON_MOST - 1);
    cJSON_Delete(value);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(job_crosses_unchanged),
        cmocka_unit_test(sequences_are_by_case_for_older_ends),
        cmocka_unit_test(no_jobs_cross),
        cmocka_unit_test(malformed_jobs_are_refused),
        cmocka_unit_test(more_jobs_than_room_are_refused),
        cmocka_unit_test(claim_crosses),
        cmocka_unit_test(a_kind_counts_once),
        cmocka_unit_test(kinds_of_other_forms_are_left_out),
        cmocka_unit_test(names_of_hosts_are_bounded),
        cmocka_unit_test(claims_are_bounded),
        cmocka_unit_test(result_crosses_bit_for_bit),
        cmocka_unit_test(malformed_results_are_refused),
        cmocka_unit_test(reports_cross),
        cmocka_unit_test(long_reason_is_cut_between_characters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
