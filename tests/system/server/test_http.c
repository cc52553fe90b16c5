/* Protects: the HTTP contract, request by request, against the real server: what each request gets,
 * what wrong ones are told, and that nobody's slowness or strangeness holds the server up. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define JSON "Content-Type: application/json\r\n"

static struct process server;
static unsigned port;

static int start(void **state) {
    (void)state;
    port = serve_start(&server,
                       (const char *[]){"--deadline", "2", "--allow-host", "rugo.example", NULL});
    return 0;
}

static int stop(void **state) {
    (void)state;
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 15), 0);
    assert_true(contains(server.err, "msg=ended"));
    return 0;
}

static int ask(const char *method, const char *path, const char *body, char **answer) {
    return http_exchange(port, method, path, body ? JSON : NULL, body, answer);
}

static void check_answer(const char *method, const char *path, const char *body, int status,
                         const char *text) {
    char *answer;
    int got = ask(method, path, body, &answer);
    if (got != status || !strstr(answer, text)) {
        print_error("%s %s %.100s: %d %.300s\n   expected %d with %s\n", method, path,
                    body ? body : "", got, answer, status, text);
        fail();
    }
    free(answer);
}

/* The id in a submission's answer. */
static void submit(const char *study, char id[17]) {
    char *answer;
    assert_int_equal(ask("POST", "/v1/studies", study, &answer), 201);
    assert_int_equal(sscanf(answer, "{\"id\":\"%16[0-9a-f]\"", id), 1);
    free(answer);
}

static void path_of(char *path, size_t size, const char *id, const char *rest) {
    snprintf(path, size, "/v1/studies/%s%s", id, rest);
}

/* --- a study's life --- */

static void a_study_from_submission_to_curves(void **state) {
    (void)state;
    char id[17], path[96], url[64], *answer;
    submit(ONE_CASE, id);
    path_of(path, sizeof path, id, "");
    check_answer("GET", path, NULL, 200, "\"state\":\"queued\"");
    check_answer("GET", "/v1/studies", NULL, 200, id);
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    assert_int_equal(run_rugo("work", (const char *[]){"work", "--server", url, "--drain",
                                                       "--workers", "1", NULL}),
                     0);
    check_answer("GET", path, NULL, 200, "\"state\":\"done\"");
    path_of(path, sizeof path, id, "/curves?quantity=summit_height_pdf");
    check_answer("GET", path, NULL, 200, "\"quantity\":\"summit_height_pdf\"");
    path_of(path, sizeof path, id, "/curves?case=1");
    check_answer("GET", path, NULL, 404, "has no case 1");
    path_of(path, sizeof path, id, "/curves?quantity=colour");
    check_answer("GET", path, NULL, 422, "colour");
    path_of(path, sizeof path, id, "/curves?case=x");
    check_answer("GET", path, NULL, 422, "?case");
    path_of(path, sizeof path, id, "/report");
    check_answer("GET", path, NULL, 200, "\"statistical_error\"");
    path_of(path, sizeof path, id, "/events");
    check_answer("GET", path, NULL, 200, "event: progress");
    path_of(path, sizeof path, id, "/curves");
    assert_int_equal(http_exchange(port, "GET", path, "Accept: text/csv\r\n", NULL, &answer), 200);
    assert_memory_equal(answer, "case,", 5);
    free(answer);
    path_of(path, sizeof path, id, "");
    check_answer("DELETE", path, NULL, 409, "already ended");
    path_of(path, sizeof path, id, "/retry");
    check_answer("POST", path, NULL, 200, "\"retried\":0");
}

static void unchanged_curves_are_not_sent_again(void **state) {
    (void)state;
    char id[17], path[96], request[300], *reply, *tag;
    submit(ONE_CASE, id);
    path_of(path, sizeof path, id, "/curves");
    snprintf(request, sizeof request,
             "GET %s HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n", path);
    reply = http_raw(port, request, strlen(request));
    assert_non_null(tag = strstr(reply, "ETag: "));
    tag[strcspn(tag, "\r")] = 0;
    char header[128];
    snprintf(header, sizeof header, "If-None-Match: %s\r\n", tag + 6);
    assert_int_equal(http_exchange(port, "GET", path, header, NULL, NULL), 304);
    free(reply);
    path_of(path, sizeof path, id, "");
    check_answer("DELETE", path, NULL, 200, "\"state\":\"cancelled\"");
    path_of(path, sizeof path, id, "/curves");
    assert_int_equal(http_exchange(port, "GET", path, header, NULL, NULL), 200);
    path_of(path, sizeof path, id, "/retry");
    check_answer("POST", path, NULL, 200, "\"retried\":1");
    path_of(path, sizeof path, id, "");
    check_answer("DELETE", path, NULL, 200, "cancelled");
}

static void a_key_makes_submission_safe_to_repeat(void **state) {
    (void)state;
    char *first, *second;
    const char *key = JSON "Idempotency-Key: monday\r\n";
    assert_int_equal(http_exchange(port, "POST", "/v1/studies", key, ONE_CASE, &first), 201);
    assert_int_equal(http_exchange(port, "POST", "/v1/studies", key, ONE_CASE, &second), 200);
    assert_string_equal(first, second);
    assert_int_equal(http_exchange(port, "POST", "/v1/studies", key, SEVERAL_BLOCKS, NULL), 409);
    char id[17], path[96];
    sscanf(first, "{\"id\":\"%16[0-9a-f]", id);
    path_of(path, sizeof path, id, "");
    check_answer("DELETE", path, NULL, 200, "cancelled");
    free(first);
    free(second);
}

/* --- the queue --- */

static void a_lease_is_needed_to_report(void **state) {
    (void)state;
    char id[17], path[96], *answer, token[40], body[200];
    long job;
    submit(ONE_CASE, id);
    assert_int_equal(ask("POST", "/v1/jobs/claim",
                         "{\"worker\":\"w\",\"host\":\"h\",\"kinds\":[\"statistics\"],\"count\":1}",
                         &answer),
                     200);
    assert_int_equal(sscanf(strstr(answer, "\"id\":"), "\"id\":%ld", &job), 1);
    assert_int_equal(sscanf(strstr(answer, "\"token\":"), "\"token\":\"%32[0-9a-f]", token), 1);
    free(answer);
    snprintf(path, sizeof path, "/v1/jobs/%ld/heartbeat", job);
    snprintf(body, sizeof body, "{\"token\":\"%s\",\"done\":2}", token);
    check_answer("POST", path, body, 200, "{}");
    check_answer("POST", path, "{\"token\":\"0123456789abcdef0123456789abcdef\",\"done\":2}", 409,
                 "lost");
    snprintf(path, sizeof path, "/v1/jobs/%ld/complete", job);
    snprintf(body, sizeof body,
             "{\"token\":\"%s\",\"seconds\":1,\"first\":0,\"count\":5,\"scalars\":{\"names\":["
             "\"a\"],\"rows\":[[1],[1],[1],[1],[1]]},\"data\":\"AAAA\"}",
             token);
    check_answer("POST", path, body, 422, "scalars");
    snprintf(path, sizeof path, "/v1/jobs/%ld/fail", job);
    snprintf(body, sizeof body, "{\"token\":\"%s\",\"reason\":\"no luck\",\"permanent\":true}",
             token);
    check_answer("POST", path, body, 200, "{}");
    check_answer("POST", path, body, 409, "lost");
    path_of(path, sizeof path, id, "");
    check_answer("GET", path, NULL, 200, "\"reason\":\"no luck\"");
    check_answer("POST", "/v1/jobs/claim", "{\"worker\":\"w\",\"kinds\":[\"other\"]}", 204, "");
}

/* --- wrong requests --- */

static void wrong_requests_are_told_what_is_wrong(void **state) {
    (void)state;
#define STUDY(rest) "{\"name\":\"n\",\"kind\":\"statistics\"," rest "}"
    static const struct {
        const char *method, *path, *body;
        int status;
        const char *text;
    } WRONG[] = {
        {"GET", "/nowhere", NULL, 404, "there is nothing at /nowhere"},
        {"GET", "/v1/studies/0123456789abcdef", NULL, 404, "there is no study"},
        {"GET", "/v1/studies/0123456789abcdef/curves", NULL, 404, "there is no study"},
        {"GET", "/v1/studies/0123456789abcdef/report", NULL, 404, "there is no study"},
        {"GET", "/v1/studies/0123456789abcdef/events", NULL, 404, "there is no study"},
        {"DELETE", "/v1/studies/0123456789abcdef", NULL, 404, "there is no study"},
        {"POST", "/v1/studies/0123456789abcdef/retry", NULL, 404, "there is no study"},
        {"GET", "/v1/studies?limit=0", NULL, 422, "0 is not in [1, 1000]"},
        {"GET", "/v1/studies?limit=many", NULL, 422, "\"?limit\""},
        {"GET", "/v1/studies?after=xyz", NULL, 404, "there is no study"},
        {"PUT", "/v1/studies", NULL, 405, "allowed: POST, GET, HEAD"},
        {"DELETE", "/healthz", NULL, 405, "allowed: GET, HEAD"},
        {"POST", "/v1/studies", NULL, 400, "a JSON body is needed"},
        {"POST", "/v1/studies", "{", 400, "line 1, column 2"},
        {"POST", "/v1/studies", "{\"a\":1,\"a\":2}", 400, "given twice"},
        {"POST", "/v1/studies", "{\"a\":01}", 400, "malformed"},
        {"POST", "/v1/studies", "{\"a\":1e999}", 400, "beyond the range"},
        {"POST", "/v1/studies", "{\"a\":\"\xff\"}", 400, "invalid UTF-8"},
        {"POST", "/v1/studies", "{} {}", 400, "behind the end"},
        {"POST", "/v1/studies", "[]", 422, "a study is a JSON object"},
        {"POST", "/v1/studies", "{}", 422, "\"/name\""},
        {"POST", "/v1/studies", "{\"name\":\"n\",\"kind\":\"weather\"}", 422,
         "is not one of \\\"statistics\\\""},
        {"POST", "/v1/studies", STUDY("\"surface\":{\"hurst\":[0.2,1.4],\"wavelength_ratio\":8}"),
         422, "{\"pointer\":\"/surface/hurst/1\",\"detail\":\"1.4 is not in (0, 1]\"}"},
        {"POST", "/v1/studies", STUDY("\"surface\":{\"hurst\":\"high\",\"wavelength_ratio\":8}"),
         422, "is not a number"},
        {"POST", "/v1/studies", STUDY("\"surface\":{\"hurst\":[],\"wavelength_ratio\":8}"), 422,
         "an empty list"},
        {"POST", "/v1/studies",
         STUDY("\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":8,\"colour\":1}"), 422,
         "unknown name"},
        {"POST", "/v1/studies", STUDY("\"surface\":{\"hurst\":0.8}"), 422, "wavelength_ratio"},
        {"POST", "/v1/studies",
         STUDY("\"seed\":9007199254740993,\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":8}"), 400,
         "an integer beyond 2^53"},
        {"POST", "/v1/studies",
         STUDY("\"realisations\":{\"target_error\":0.01},\"surface\":{\"hurst\":0.8,\"wavelength_"
               "ratio\":8}"),
         422, "a target error is for a later version"},
        {"POST", "/v1/studies",
         STUDY("\"realisations\":0,\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":8}"), 422,
         "0 is not in [1, 10000000]"},
        {"POST", "/v1/studies", STUDY("\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":8000}"), 422,
         "/surface"},
        {"POST", "/v1/jobs/claim", "{\"worker\":\"w\",\"kinds\":3}", 422, "kinds"},
        {"POST", "/v1/jobs/claim", "[1]", 422, "Invalid content"},
        {"POST", "/v1/jobs/999999/heartbeat",
         "{\"token\":\"0123456789abcdef0123456789abcdef\",\"done\":1}", 404,
         "there is no job 999999"},
        {"POST", "/v1/jobs/abc/heartbeat", "{}", 404, "no such job"},
        {"POST", "/v1/jobs/1/heartbeat", "{}", 422, "token"},
        {"POST", "/v1/jobs/1/complete", "{\"token\":\"0123456789abcdef0123456789abcdef\"}", 422,
         "Invalid content"},
    };
    for (size_t w = 0; w < sizeof WRONG / sizeof *WRONG; w++)
        check_answer(WRONG[w].method, WRONG[w].path, WRONG[w].body, WRONG[w].status, WRONG[w].text);
}

static void check_raw(const char *request, const char *status) {
    char *reply = http_raw(port, request, strlen(request)), expected[32];
    snprintf(expected, sizeof expected, "HTTP/1.1 %s", status);
    if (strncmp(reply, expected, strlen(expected)) != 0) {
        print_error("%s\ngot %.200s\n", request, reply);
        fail();
    }
    free(reply);
}

static void wrong_headers_are_refused(void **state) {
    (void)state;
    check_raw("POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
              "text/plain\r\nContent-Length: 2\r\n\r\n{}",
              "415");
    check_raw("POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
              "application/json\r\nContent-Length: 2\r\nContent-Length: 2\r\n\r\n{}",
              "400");
    check_raw("POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
              "application/json\r\nContent-Length: 2\r\nTransfer-Encoding: "
              "chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n",
              "400");
    check_raw("POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
              "application/json\r\nContent-Length: 99999999\r\n\r\n",
              "413");
    check_raw("GET /v1/studies HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n", "403");
    check_raw("GET /v1/studies HTTP/1.1\r\nHost: rugo.example\r\nConnection: close\r\n\r\n", "200");
    check_raw("GET /v1/studies HTTP/1.1\r\nHost: localhost\r\nOrigin: "
              "http://evil.example\r\nConnection: close\r\n\r\n",
              "403");
    check_raw("GET /v1/studies HTTP/1.1\r\nHost: localhost:1\r\nOrigin: "
              "http://localhost:1\r\nConnection: close\r\n\r\n",
              "200");
    check_raw("HEAD /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n", "200");
}

static void deep_nesting_is_refused(void **state) {
    (void)state;
    char deep[2001];
    memset(deep, '[', 2000);
    deep[2000] = 0;
    check_answer("POST", "/v1/studies", deep, 400, "nesting deeper");
}

/* A chunked body has no length to refuse: it is cut past 16 MiB, and the server goes on. */
static void endless_chunks_are_cut(void **state) {
    (void)state;
    int connection = http_connect(port);
    const char *head =
        "POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        "Transfer-Encoding: chunked\r\n\r\n";
    char *chunk = malloc(65536 + 16);
    assert_non_null(chunk);
    int used = snprintf(chunk, 16, "10000\r\n");
    memset(chunk + used, ' ', 65536);
    memcpy(chunk + used + 65536, "\r\n", 2);
    assert_true(send(connection, head, strlen(head), MSG_NOSIGNAL) > 0);
    int chunks = 0;
    while (chunks < 2000 && send(connection, chunk, (size_t)used + 65538, MSG_NOSIGNAL) > 0)
        chunks++;
    assert_true(chunks < 2000);
    free(chunk);
    close(connection);
    check_answer("GET", "/healthz", NULL, 200, "ok");
}

/* One byte a time keeps the library's own timeout away; the deadline (2 s here) must come all the
 * same. */
static void slow_requests_are_cut(void **state) {
    (void)state;
    int connection = http_connect(port);
    const char *request = "GET /healthz HTTP/1.1\r\nHost: localhost\r\nX-Slow: yes";
    time_t begin = time(NULL);
    bool cut = false;
    for (const char *c = request; *c && !cut; c++) {
        char byte;
        cut = send(connection, c, 1, MSG_NOSIGNAL) < 0 ||
              recv(connection, &byte, 1, MSG_DONTWAIT) == 0;
        sleep_ms(200);
    }
    assert_true(cut);
    assert_true(time(NULL) - begin < 9);
    close(connection);
}

static void half_closed_connections_do_no_harm(void **state) {
    (void)state;
    for (int i = 0; i < 20; i++) {
        int connection = http_connect(port);
        send(connection, "GET /healthz HT", 15, MSG_NOSIGNAL);
        shutdown(connection, SHUT_WR);
        close(connection);
    }
    check_answer("GET", "/healthz", NULL, 200, "ok");
}

static void descriptions_and_page(void **state) {
    (void)state;
    check_answer("GET", "/", NULL, 200, "<title>Rugo</title>");
    check_answer("GET", "/app.js", NULL, 200, "textContent");
    check_answer("GET", "/style.css", NULL, 200, "body");
    check_answer("GET", "/v1/openapi.yaml", NULL, 200, "openapi: 3.1");
    check_answer("GET", "/v1/study.schema.json", NULL, 200, "\"hurst\"");
    check_answer("GET", "/metrics", NULL, 200, "rugo_jobs{state=\"waiting\"}");
    char *answer;
    int status = http_exchange(port, "GET", "/v1/snapshot", NULL, NULL, &answer);
    assert_int_equal(status, 200);
    assert_memory_equal(answer, "SQLite format 3", 15);
    free(answer);
}

/* --- tokens --- */

static void roles_bound_what_a_token_may_do(void **state) {
    (void)state;
    struct process other = {0};
    spit("tokens",
         "# for the "
         "test\nread:read-token-000000\nsubmit:submit-token-0000\nwork:work-token-000000\n");
    unsigned main_port = port;
    struct process main_server = server;
    port =
        serve_start(&other, (const char *[]){"--db", "tokens.db", "--token-file", "tokens", NULL});
    static const struct {
        const char *method, *path, *token;
        int status;
    } ASKED[] = {
        {"GET", "/v1/studies", NULL, 401},
        {"GET", "/v1/studies", "wrong-token-000000", 401},
        {"GET", "/v1/studies", "read-token-000000", 200},
        {"GET", "/v1/studies", "work-token-000000", 200},
        {"POST", "/v1/studies", "read-token-000000", 403},
        {"POST", "/v1/studies", "work-token-000000", 403},
        {"POST", "/v1/studies", "submit-token-0000", 201},
        {"POST", "/v1/jobs/claim", "submit-token-0000", 403},
        {"POST", "/v1/jobs/claim", "work-token-000000", 200},
        {"GET", "/healthz", NULL, 200},
        {"GET", "/metrics", NULL, 401},
    };
    for (size_t a = 0; a < sizeof ASKED / sizeof *ASKED; a++) {
        char headers[160] = JSON;
        if (ASKED[a].token)
            snprintf(headers, sizeof headers, JSON "Authorization: Bearer %s\r\n", ASKED[a].token);
        bool claim = strstr(ASKED[a].path, "claim") != NULL, post = *ASKED[a].method == 'P';
        const char *body = claim ? "{\"worker\":\"w\"}" : post ? ONE_CASE : NULL;
        int status = http_exchange(port, ASKED[a].method, ASKED[a].path, headers, body, NULL);
        if (status != ASKED[a].status)
            print_error("%s %s with %s: %d\n", ASKED[a].method, ASKED[a].path,
                        ASKED[a].token ? ASKED[a].token : "no token", status);
        assert_int_equal(status, ASKED[a].status);
    }
    process_kill(&other, SIGTERM);
    assert_int_equal(process_wait(&other, 15), 0);
    assert_false(contains(other.err, "token-0000"));
    port = main_port;
    server = main_server;
}

static void beyond_loopback_tokens_are_needed(void **state) {
    (void)state;
    assert_int_equal(run_rugo("open", (const char *[]){"serve", "--db", "open.db", "--listen",
                                                       "0.0.0.0:0", NULL}),
                     2);
    assert_true(contains("open.err", "tokens are needed"));
    spit("bad-tokens", "admin:0123456789abcdef\n");
    assert_int_equal(run_rugo("bad", (const char *[]){"serve", "--db", "open.db", "--token-file",
                                                      "bad-tokens", NULL}),
                     2);
    assert_true(contains("bad.err", "bad-tokens, line 1"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_study_from_submission_to_curves),
        cmocka_unit_test(unchanged_curves_are_not_sent_again),
        cmocka_unit_test(a_key_makes_submission_safe_to_repeat),
        cmocka_unit_test(a_lease_is_needed_to_report),
        cmocka_unit_test(wrong_requests_are_told_what_is_wrong),
        cmocka_unit_test(wrong_headers_are_refused),
        cmocka_unit_test(deep_nesting_is_refused),
        cmocka_unit_test(endless_chunks_are_cut),
        cmocka_unit_test(slow_requests_are_cut),
        cmocka_unit_test(half_closed_connections_do_no_harm),
        cmocka_unit_test(descriptions_and_page),
        cmocka_unit_test(roles_bound_what_a_token_may_do),
        cmocka_unit_test(beyond_loopback_tokens_are_needed),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
