/* Protects: whichever allocation fails, what crosses between worker and server is written and read
 * back as it was, or is not there at all; nothing leaks. */
#include "tests/support/check.h"

#include "tests/support/failing/each_allocation.h"
#include "worker/link/wire.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int no_memory(struct error *err) {
    return error_set(err, ERROR_MEMORY, "no memory left for a document");
}

static int claim(void *context, struct error *err) {
    static const char *const KINDS[] = {"statistics", "contact", NULL};
    (void)context;
    struct wire_claim read;
    cJSON *value =
        wire_claim(&(struct claim){.worker = "worker", .host = "host", .kinds = KINDS, .count = 3});
    int status = value != NULL ? wire_claim_read(value, &read, err) : no_memory(err);
    if (status == 0) {
        assert_string_equal(read.claim.worker, "worker");
        assert_string_equal(read.kinds[1], "contact");
        assert_int_equal(read.claim.count, 3);
    }
    cJSON_Delete(value);
    return status;
}

static int read_jobs(cJSON *value, struct error *err) {
    struct claimed_job read[2] = {{0}};
    size_t count = 0;
    int status = wire_jobs_read(value, read, 2, &count, err);
    if (status != 0)
        return status;
    assert_int_equal(count, 2);
    assert_string_equal(read[1].kind, "contact");
    assert_int_equal(cJSON_GetObjectItem(read[1].parameters, "a")->valueint, 1);
    for (size_t n = 0; n < count; n++)
        claimed_job_clear(&read[n]);
    return 0;
}

/* As both ends do it: the document crosses as text. */
static int jobs(void *context, struct error *err) {
    struct claimed_job job = {.id = 7,
                              .study = "0123",
                              .kind = (char[]){"contact"},
                              .seed = 5,
                              .count = 2,
                              .attempt = 1,
                              .token = "token",
                              .lease_ms = 30000,
                              .parameters = context};
    cJSON *value = wire_jobs((const struct claimed_job[]){job, job}, 2);
    char *text = value != NULL ? cJSON_PrintUnformatted(value) : NULL;
    cJSON_Delete(value);
    value = text != NULL ? cJSON_Parse(text) : NULL;
    free(text);
    int status = value != NULL ? read_jobs(value, err) : no_memory(err);
    cJSON_Delete(value);
    return status;
}

static int result(void *context, struct error *err) {
    static const char *const NAMES[] = {"area", "gap"};
    static double scalars[] = {0.1, NAN, 0.3, 4};
    (void)context;
    const struct block_result written = {.first = 4,
                                         .count = 2,
                                         .scalar_count = 2,
                                         .names = (const char **)NAMES,
                                         .scalars = scalars,
                                         .data = (unsigned char *)"bytes",
                                         .size = 5,
                                         .seconds = 2};
    struct block_result read = {0};
    char token[TOKEN_SIZE];
    cJSON *value = wire_result("token", &written);
    int status = value != NULL ? wire_result_read(value, token, &read, err) : no_memory(err);
    if (status == 0) {
        assert_string_equal(read.names[1], "gap");
        assert_true(read.scalars[2] == 0.3 && isnan(read.scalars[1]));
        assert_memory_equal(read.data, "bytes", 5);
        block_result_clear(&read);
    }
    cJSON_Delete(value);
    return status;
}

static int reports(void *context, struct error *err) {
    struct wire_report read;
    cJSON *documents[] = {wire_heartbeat("token", 9), wire_fail("token", "reason", true),
                          wire_release("token")};
    (void)context;
    int status = 0;
    for (size_t n = 0; n < sizeof documents / sizeof *documents; n++) {
        if (status == 0)
            status =
                documents[n] != NULL ? wire_report_read(documents[n], &read, err) : no_memory(err);
        if (status == 0) {
            assert_string_equal(read.token, "token");
            assert_int_equal(read.done, n == 0 ? 9 : 0);
            assert_string_equal(read.reason, n == 1 ? "reason" : "");
        }
        cJSON_Delete(documents[n]);
    }
    return status;
}

static void wire(void **state) {
    cJSON *parameters = cJSON_Parse("{\"a\": 1}");
    (void)state;
    assert_non_null(parameters);
    each_allocation(&(struct failing_call){.name = "claim", claim});
    each_allocation(&(struct failing_call){.name = "jobs", jobs, parameters});
    each_allocation(&(struct failing_call){.name = "result", result});
    each_allocation(&(struct failing_call){.name = "reports", reports});
    cJSON_Delete(parameters);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(wire)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
