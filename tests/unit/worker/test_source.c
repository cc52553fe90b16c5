/* What a server's answers mean to a worker: a job, none, wait, lost, or the end. */
#include "tests/unit/worker/stub_server.h"
#include "worker/link/client.h"
#include "worker/link/source.h"
#include "worker/link/wire_report.h"

#include <math.h>

static const struct wish WISH = {.count = 1, .seconds = 5, .threads = 2, .wait_s = 7};
static const char TOKEN[] = "0123456789abcdef0123456789abcdef";

/* A reply of this status line and body, into text. */
static const char *reply(char *text, size_t size, const char *status, const char *body) {
    snprintf(text, size, "HTTP/1.1 %s\r\nRugo-Version: 1\r\nContent-Length: %zu\r\n\r\n%s", status,
             strlen(body), body);
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
    size_t count = (size_t)*found;
    bool due = false;
    int code = source_claim(source, &WISH, job, &count, &due, &err);
    if (code == 0)
        *found = (int)count;
    source_destroy(&source);
    stub_stop(&stub);
    assert_non_null(strstr(stub.request, "POST /v1/jobs/claim "));
    assert_non_null(strstr(stub.request, "Prefer: wait=7\r\n"));
    assert_non_null(strstr(stub.request, "\"seconds\":5,\"threads\":2"));
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
    size_t count = 9;
    bool due = false;
    struct stub stub = {.manner = ANSWER,
                        .answer = "HTTP/1.1 204 No Content\r\nRugo-Version: 1\r\n\r\n"};
    stub_start(&stub);
    struct source *source = source_of(&stub);
    assert_int_equal(source_claim(source, &WISH, &job, &count, &due, &err), 0);
    assert_true(count == 0 && !due);
    source_destroy(&source);
    stub_stop(&stub);
}

static int at_once(void *context) {
    (void)context;
    return 1;
}

/* A claim that waits at the server ends when the worker is to end. */
static void waiting_claims_can_be_stopped(void **state) {
    (void)state;
    struct error err = {0};
    struct claimed_job job = {0};
    size_t count = 0;
    bool due = false;
    struct wish wish = WISH;
    wish.stop = at_once;
    struct stub stub = {.manner = SILENT};
    stub_start(&stub);
    struct source *source = source_of(&stub);
    assert_int_equal(source_claim(source, &wish, &job, &count, &due, &err), ERROR_STOPPED);
    source_destroy(&source);
    stub_stop(&stub);
}

/* Lost is what another worker took, what was cancelled, and what a new database never had: each
 * report has its own answer. */
static void lost_leases_are_told_apart(void **state) {
    (void)state;
    static const char answers[] =
        "{\"reports\":[{\"job\":7,\"status\":200},{\"job\":8,\"status\":409,\"detail\":\"the "
        "lease of job 8 is lost\"},{\"job\":9,\"status\":404},{\"job\":10,\"status\":503},{\"job\""
        ":11,\"status\":422,\"detail\":\"no\"}]}";
    static const int codes[] = {0, ERROR_STATE, ERROR_STATE, ERROR_SYSTEM, ERROR_INPUT};
    struct claimed_job jobs[5] = {{0}};
    struct report reports[5];
    char text[512];
    struct error err = {0};
    bool due = false;
    for (size_t n = 0; n < 5; n++) {
        jobs[n].id = 7 + (int64_t)n;
        memcpy(jobs[n].token, TOKEN, sizeof TOKEN);
        reports[n] = (struct report){.verb = n == 0   ? REPORT_HEARTBEAT
                                             : n == 1 ? REPORT_FAIL
                                                      : REPORT_RELEASE,
                                     .job = &jobs[n],
                                     .done = 3.25,
                                     .reason = "no convergence",
                                     .permanent = true};
    }
    struct stub stub = {.manner = ANSWER, .answer = reply(text, sizeof text, "200 OK", answers)};
    stub_start(&stub);
    struct source *source = source_of(&stub);
    assert_int_equal(source_report(source, reports, 5, &due, &err), 0);
    source_destroy(&source);
    stub_stop(&stub);
    for (size_t n = 0; n < 5; n++)
        assert_int_equal(reports[n].status, codes[n]);
    assert_string_equal(reports[1].err.text, "the lease of job 8 is lost");
    assert_int_equal(stub.requests, 1);
    assert_non_null(strstr(stub.request, "POST /v1/jobs/report "));
    assert_non_null(
        strstr(stub.request, "\"done\":3,\"part\":0.25,\"verb\":\"heartbeat\",\"job\":7"));
    assert_non_null(strstr(stub.request, "\"reason\":\"no convergence\",\"permanent\":true"));
    assert_non_null(strstr(stub.request, "\"verb\":\"release\",\"job\":11"));
}

/* What refuses the request as a whole, or answers other reports, answers none. */
static void whole_requests_fail(void **state) {
    (void)state;
    static const struct {
        const char *status, *body;
        int code;
    } table[] = {
        {"500 Internal Server Error", "{}", ERROR_SYSTEM},
        {"403 Forbidden", "{}", ERROR_INPUT},
        {"200 OK", "{}", ERROR_SYSTEM},
        {"200 OK", "{\"reports\":[]}", ERROR_SYSTEM},
        {"200 OK", "{\"reports\":[{\"job\":8,\"status\":200}]}", ERROR_SYSTEM},
        {"200 OK", "{\"reports\":[{\"job\":7}]}", ERROR_SYSTEM},
    };
    struct claimed_job job = {.id = 7};
    memcpy(job.token, TOKEN, sizeof TOKEN);
    for (size_t n = 0; n < sizeof table / sizeof table[0]; n++) {
        struct report one = {.verb = REPORT_RELEASE, .job = &job};
        char text[256];
        struct error err = {0};
        bool due = false;
        struct stub stub = {.manner = ANSWER,
                            .answer = reply(text, sizeof text, table[n].status, table[n].body)};
        stub_start(&stub);
        struct source *source = source_of(&stub);
        assert_int_equal(source_report(source, &one, 1, &due, &err), table[n].code);
        source_destroy(&source);
        stub_stop(&stub);
    }
}

/* A server that knows single reports alone is asked about many once. Here it does not know the job
 * either. */
static void older_servers_get_reports_alone(void **state) {
    (void)state;
    struct claimed_job jobs[2] = {{.id = 7}, {.id = 8}};
    struct report reports[2];
    char text[256];
    struct error err = {0};
    bool due = false;
    for (size_t n = 0; n < 2; n++) {
        memcpy(jobs[n].token, TOKEN, sizeof TOKEN);
        reports[n] = (struct report){
            .verb = n == 0 ? REPORT_RELEASE : REPORT_HEARTBEAT, .job = &jobs[n], .done = 3};
    }
    struct stub stub = {.manner = ANSWER,
                        .answer = reply(text, sizeof text, "404 Not Found", "{}")};
    stub_start(&stub);
    struct source *source = source_of(&stub);
    assert_int_equal(source_report(source, reports, 2, &due, &err), 0);
    assert_int_equal(reports[0].status, ERROR_STATE);
    assert_int_equal(reports[1].status, ERROR_STATE);
    assert_int_equal(source_report(source, reports, 2, &due, &err), 0);
    source_destroy(&source);
    stub_stop(&stub);
    assert_int_equal(stub.requests, 1 + 2 + 2);
    assert_non_null(strstr(stub.request, "POST /v1/jobs/8/heartbeat "));
    assert_non_null(strstr(stub.request, "\"done\":3"));
    assert_null(strstr(stub.request, "verb"));
}

static void names_have_no_control_characters(void **state) {
    (void)state;
    static const char *const names[] = {"a\x1b[31m", "a\nb", "a\x7f", "a\xc2\x9b"};
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        struct source_options options = {.url = "http://127.0.0.1:1", .worker = names[n]};
        struct source *source = NULL;
        struct error err = {0};
        assert_int_equal(source_create(&source, &options, &err), ERROR_INPUT);
        assert_non_null(strstr(err.text, "control character"));
        assert_null(strchr(err.text, '\x1b'));
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
    bool due = false;
    struct report one = {.verb = REPORT_COMPLETE, .job = &job, .result = &result};
    struct stub stub = {.manner = ANSWER,
                        .answer = reply(text, sizeof text, "200 OK",
                                        "{\"reports\":[{\"job\":9000000000,\"status\":200}]}")};
    stub_start(&stub);
    struct source *source = source_of(&stub);
    assert_int_equal(source_report(source, &one, 1, &due, &err), 0);
    assert_int_equal(one.status, 0);
    source_destroy(&source);
    stub_stop(&stub);
    const char *body = strstr(stub.request, "\r\n\r\n") + 4;
    cJSON *value = NULL;
    struct wire_item *item = NULL;
    size_t count = 0;
    assert_int_equal(json_parse(body, strlen(body), NULL, &value, &err), 0);
    assert_int_equal(wire_reports_read(value, &item, &count, &err), 0);
    assert_true(count == 1 && item->verb == REPORT_COMPLETE && item->status == 0);
    assert_true(item->job == 9000000000);
    assert_string_equal(item->report.token, TOKEN);
    struct block_result got = item->block;
    assert_int_equal(got.scalar_count, result.scalar_count);
    assert_true(isnan(got.scalars[0]));
    assert_true(got.scalars[1] == scalars[1]);
    assert_string_equal(got.names[1], kind->scalar(1));
    assert_memory_equal(got.data, data, sizeof data);
    wire_items_free(item, count);
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
        bool due = false;
        assert_int_equal(source_left(source, &left, &due, &err), table[n].code);
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
        cmocka_unit_test(claims_mean_what_they_say),
        cmocka_unit_test(no_content_is_no_job),
        cmocka_unit_test(waiting_claims_can_be_stopped),
        cmocka_unit_test(lost_leases_are_told_apart),
        cmocka_unit_test(whole_requests_fail),
        cmocka_unit_test(older_servers_get_reports_alone),
        cmocka_unit_test(names_have_no_control_characters),
        cmocka_unit_test(result_arrives),
        cmocka_unit_test(studies_with_jobs_are_left),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
