/* What a server's answers mean to a worker: a job, none, wait, lost, or the end. */
#include "tests/unit/worker/stub_server.h"
#include "worker/client.h"
#include "worker/source.h"
#include "worker/wire.h"

#include <math.h>

static const char TOKEN[] = "0123456789abcdef0123456789abcdef";

/* A reply of this status line and body, into text. */
static const char *reply(char *text, size_t size, const char *status, const char *body) {
    snprintf(text, size, "HTTP/1.1 %s\r\nContent-Length: %zu\r\n\r\n%s", status, strlen(body),
             body);
    return text;
}

static struct source *source_of(struct stub *stub) {
    struct source_options options = {.url = stub->url, .token = "t", .worker = "w-0", .host = "h"};
    struct source *source = NULL;
    struct error err = {0};
    if (source_create(&source, &options, &err) != 0) {
        fail_msg("%s", err.text);
    }
    return source;
}

/* Claims from a server that answers with this; gives the status. */
static int claim(const char *status, const char *body, struct claimed_job *job, int *found) {
    char text[1024];
    struct error err = {0};
    struct stub stub = {.manner = ANSWER, .answer = reply(text, sizeof text, status, body)};
    stub_start(&stub);
    struct source *source = source_of(&stub);
    int code = source_claim(source, job, found, &err);
    source_destroy(&source);
    stub_stop(&stub);
    assert_non_null(strstr(stub.request, "POST /v1/jobs/claim "));
    assert_non_null(strstr(stub.request, "\"worker\":\"w-0\""));
    assert_non_null(strstr(stub.request, "\"kinds\":[\"")); /* those that this program knows */
    return code;
}

static void claims_mean_what_they_say(void **state) {
    (void)state;
    static const char job_text[] =
        "{\"jobs\":[{\"id\":7,\"study\":\"0123456789abcdef\",\"kind\":\"statistics\",\"case\":2,"
        "\"seed\":\"18446744073709551615\",\"first\":10,\"count\":5,\"attempt\":1,"
        "\"token\":\"0123456789abcdef0123456789abcdef\",\"lease_seconds\":60,"
        "\"parameters\":{\"a\":1}}]}";
    struct claimed_job job = {0};
    int found = -1;
    assert_int_equal(claim("200 OK", job_text, &job, &found), 0);
    assert_int_equal(found, 1);
    assert_true(job.id == 7 && job.seed == UINT64_MAX && job.lease_ms == 60000);
    claimed_job_clear(&job);
    assert_int_equal(claim("200 OK", "{\"jobs\":[]}", &job, &found), 0);
    assert_int_equal(found, 0);
    found = -1;
    assert_int_equal(claim("503 Service Unavailable", "", &job, &found), ERROR_SYSTEM);
    assert_int_equal(claim("409 Conflict", "", &job, &found), ERROR_SYSTEM);
    assert_int_equal(claim("200 OK", "{\"jobs\":[{}]}", &job, &found), ERROR_SYSTEM);
    assert_int_equal(claim("200 OK", "<html>", &job, &found), ERROR_SYSTEM);
    /* waiting does not help: the token is wrong, or this is no Rugo server */
    assert_int_equal(claim("401 Unauthorized", "", &job, &found), ERROR_INPUT);
    assert_int_equal(claim("404 Not Found", "", &job, &found), ERROR_ABSENT);
    assert_int_equal(found, -1);
}

/* A 204 has no body and no length; it is the answer of an empty queue. */
static void no_content_is_no_job(void **state) {
    (void)state;
    struct error err = {0};
    struct claimed_job job = {0};
    int found = -1;
    struct stub stub = {.manner = ANSWER, .answer = "HTTP/1.1 204 No Content\r\n\r\n"};
    stub_start(&stub);
    struct source *source = source_of(&stub);
    assert_int_equal(source_claim(source, &job, &found, &err), 0);
    assert_int_equal(found, 0);
    source_destroy(&source);
    stub_stop(&stub);
}

/* Lost is what another worker took, what was cancelled, and what a new database never had. */
static void lost_leases_are_told_apart(void **state) {
    (void)state;
    static const struct {
        const char *status;
        int code;
    } table[] = {
        {"200 OK", 0},
        {"409 Conflict", ERROR_STATE},
        {"404 Not Found", ERROR_STATE},
        {"500 Internal Server Error", ERROR_SYSTEM},
        {"403 Forbidden", ERROR_INPUT},
    };
    struct claimed_job job = {.id = 7};
    memcpy(job.token, TOKEN, sizeof TOKEN);
    for (size_t n = 0; n < sizeof table / sizeof table[0]; n++) {
        char text[256];
        struct error err = {0};
        struct stub stub = {.manner = ANSWER,
                            .answer = reply(text, sizeof text, table[n].status, "{}")};
        stub_start(&stub);
        struct source *source = source_of(&stub);
        assert_int_equal(source_heartbeat(source, &job, 3, &err), table[n].code);
        assert_int_equal(source_release(source, &job, &err), table[n].code);
        assert_int_equal(source_fail(source, &job, "no convergence", 1, &err), table[n].code);
        source_destroy(&source);
        stub_stop(&stub);
        assert_int_equal(stub.connections, 1);
        assert_non_null(strstr(stub.request, "POST /v1/jobs/7/fail "));
        assert_non_null(strstr(stub.request, "\"reason\":\"no convergence\""));
        assert_non_null(strstr(stub.request, "\"permanent\":true"));
    }
}

/* The other end reads from the request what was sent. */
static void result_arrives(void **state) {
    (void)state;
    const struct job_kind *kind = kind_of(JOB_KINDS[0]);
    double scalars[256];
    unsigned char data[3] = {0, 255, 7};
    struct block_result result = {.first = 10,
                                  .count = 1,

                                  .scalars = scalars,
                                  .data = data,
                                  .size = sizeof data};
    const char *names[256];
    result.names = names;
    while (kind->scalar(result.scalar_count) != NULL) {
        names[result.scalar_count] = kind->scalar(result.scalar_count);
        scalars[result.scalar_count] = 1.0 / (double)(result.scalar_count + 3);
        result.scalar_count++;
    }
    scalars[0] = (double)NAN;
    struct claimed_job job = {.id = 9000000000, .first = 10, .count = 1};
    memcpy(job.token, TOKEN, sizeof TOKEN);
    char text[256];
    struct error err = {0};
    struct stub stub = {.manner = ANSWER,
                        .answer = reply(text, sizeof text, "200 OK", "{\"case_done\":true}")};
    stub_start(&stub);
    struct source *source = source_of(&stub);
    assert_int_equal(source_complete(source, &job, &result, &err), 0);
    source_destroy(&source);
    stub_stop(&stub);
    assert_non_null(strstr(stub.request, "POST /v1/jobs/9000000000/complete "));
    const char *body = strstr(stub.request, "\r\n\r\n") + 4;
    cJSON *value = NULL;
    struct block_result got;
    char token[TOKEN_SIZE];
    assert_int_equal(json_parse(body, strlen(body), NULL, &value, &err), 0);
    assert_int_equal(wire_result_read(value, token, &got, &err), 0);
    assert_string_equal(token, TOKEN);
    assert_int_equal(got.scalar_count, result.scalar_count);
    assert_true(isnan(got.scalars[0]));
    assert_true(got.scalars[1] == scalars[1]);
    assert_string_equal(got.names[1], kind->scalar(1));
    assert_memory_equal(got.data, data, sizeof data);
    block_result_clear(&got);
    cJSON_Delete(value);
}

/* Whether more jobs may come: as far as the token may see. */
#define STUDY(id, waiting, running)                                                                \
    "{\"studies\":[{\"id\":\"" id "\",\"state\":\"running\",\"jobs\":{\"waiting\":" #waiting       \
    ",\"running\":" #running "}}]}"

static void studies_with_jobs_are_left(void **state) {
    (void)state;
    static const struct {
        const char *status, *body;
        int code, left;
    } table[] = {
        {"200 OK", "{\"studies\":[]}", 0, 0},
        {"200 OK", "{\"studies\":[{\"id\":\"a\",\"state\":\"done\"}]}", 0, 0},
        {"200 OK", STUDY("a", 0, 0), 0, 0}, /* being published, which is the server's */
        {"200 OK", STUDY("a", 1, 0), 0, 1},
        {"200 OK", STUDY("a", 0, 1), 0, 1},
        {"403 Forbidden", "{}", 0, 0},
        {"500 Internal Server Error", "{}", ERROR_SYSTEM, -1},
    };
    for (size_t n = 0; n < sizeof table / sizeof table[0]; n++) {
        char text[512];
        int left = -1;
        struct error err = {0};
        struct stub stub = {.manner = ANSWER,
                            .answer = reply(text, sizeof text, table[n].status, table[n].body)};
        stub_start(&stub);
        struct source *source = source_of(&stub);
        assert_int_equal(source_left(source, &left, &err), table[n].code);
        assert_int_equal(left, table[n].left);
        source_destroy(&source);
        stub_stop(&stub);
    }
}

static int set_up(void **state) {
    (void)state;
    struct error err = {0};
    return client_global_init(&err);
}

static int tear_down(void **state) {
    (void)state;
    client_global_cleanup();
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(claims_mean_what_they_say),  cmocka_unit_test(no_content_is_no_job),
        cmocka_unit_test(lost_leases_are_told_apart), cmocka_unit_test(result_arrives),
        cmocka_unit_test(studies_with_jobs_are_left),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
