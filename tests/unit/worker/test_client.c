/* The client against servers that are away, slow, cut off, endless or no servers at all: an error
 * each time, within its time and memory, and the token never shown. */
#include "tests/unit/worker/stub_server.h"
#include "worker/link/client.h"

static struct client *client_of(const char *url, const char *token) {
    struct client *client = NULL;
    struct error err = {0};
    assert_int_equal(client_create(&client, url, token, NULL, &err), 0);
    return client;
}

/* With the patience that a busy machine may need. */
static const struct request CLAIM = {
    .method = "POST", .path = "/v1/jobs/claim", .body = "{\"count\":1}", .timeout_ms = 60000};

/* One exchange with a stub; gives client_json's status and error. */
static int ask_within(struct stub *stub, long timeout_ms, struct error *err) {
    struct request claim = CLAIM;
    claim.timeout_ms = timeout_ms;
    stub_start(stub);
    struct client *client = client_of(stub->url, "secret-token");
    cJSON *answer = NULL;
    int status = client_json(client, &claim, &answer, err);
    client_destroy(&client);
    stub_stop(stub);
    cJSON_Delete(answer);
    assert_null(strstr(err->text, "secret-token"));
    return status;
}

static int ask(struct stub *stub, struct error *err) {
    return ask_within(stub, CLAIM.timeout_ms, err);
}

static void refused_connection_is_no_answer(void **state) {
    (void)state;
    char url[64];
    int refusing = bind_any(url, sizeof url); /* a port that nobody listens to */
    struct client *client = client_of(url, "secret-token");
    cJSON *answer = NULL;
    struct error err = {0};
    assert_int_equal(client_json(client, &CLAIM, &answer, &err), ERROR_SYSTEM);
    assert_non_null(strstr(err.text, url));
    assert_null(strstr(err.text, "secret-token"));
    assert_null(answer);
    client_destroy(&client);
    close(refusing);
}

/* Protects the request's form, and one connection for many requests. */
static void requests_share_a_connection(void **state) {
    (void)state;
    struct stub stub = {
        .manner = ANSWER,
        .answer = "HTTP/1.1 200 OK\r\nRugo-Version: 1\r\nContent-Length: 11\r\n\r\n{\"jobs\":[]}"};
    stub_start(&stub);
    struct client *client = client_of(stub.url, "secret-token");
    struct error err = {0};
    for (int n = 0; n < 3; n++) {
        cJSON *answer = NULL;
        assert_int_equal(client_json(client, &CLAIM, &answer, &err), 0);
        assert_true(cJSON_IsArray(cJSON_GetObjectItem(answer, "jobs")));
        cJSON_Delete(answer);
    }
    client_destroy(&client);
    stub_stop(&stub);
    assert_int_equal(stub.connections, 1);
    assert_int_equal(stub.requests, 3);
    assert_non_null(strstr(stub.request, "POST /v1/jobs/claim HTTP/1.1\r\n"));
    assert_non_null(strstr(stub.request, "Authorization: Bearer secret-token\r\n"));
    assert_non_null(strstr(stub.request, "Content-Type: application/json\r\n"));
    assert_non_null(strstr(stub.request, "\r\n\r\n{\"count\":1}"));
    assert_null(strstr(stub.request, "Expect"));
}

static void no_content_is_no_answer_to_parse(void **state) {
    (void)state;
    struct stub stub = {.manner = ANSWER,
                        .answer = "HTTP/1.1 204 No Content\r\nRugo-Version: 1\r\n\r\n"};
    struct error err = {0};
    assert_int_equal(ask(&stub, &err), 0);
}

/* A server that says nothing, or one byte now and then, costs the time-out and no more. */
static void slow_servers_are_left(void **state) {
    (void)state;
    const enum manner manners[] = {SILENT, DRIP};
    for (size_t n = 0; n < 2; n++) {
        struct stub stub = {
            .manner = manners[n],
            .answer = "HTTP/1.1 200 OK\r\nRugo-Version: 1\r\nContent-Length: 2\r\nX-Padding: "};
        struct error err = {0};
        struct timespec begin, end;
        clock_gettime(CLOCK_MONOTONIC, &begin);
        assert_int_equal(ask_within(&stub, 400, &err), ERROR_SYSTEM);
        clock_gettime(CLOCK_MONOTONIC, &end);
        assert_true(end.tv_sec - begin.tv_sec < 30); /* 0.4 s and the load of the machine */
    }
}

static void broken_answers_are_errors(void **state) {
    (void)state;
    static const char *const answers[] = {
        "HTTP/1.1 200 OK\r\nRugo-Version: 1\r\nContent-Length: 100\r\n\r\n{\"jobs\":", /* cut off */
        "HTTP/1.1 200 OK\r\nRugo-Version: 1\r\nTransfer-Encoding: chunked\r\n\r\n5\r\n{\"a\":\r\n",
        "HTTP/1.1 200 OK\r\nRugo-Version: 1\r\nContent-Le",
        "",
        "SSH-2.0-OpenSSH_9.2\r\n", /* another service */
        "HTTP/1.1 200 OK\r\nRugo-Version: 1\r\nContent-Length: 7\r\n\r\n{\"a\":1",
        "HTTP/1.1 200 OK\r\nRugo-Version: 1\r\nContent-Length: 5\r\n\r\n<htm>",
        "HTTP/1.1 200 OK\r\nRugo-Version: 1\r\nContent-Length: 13\r\n\r\n{\"a\":1,\"a\":2}",
        "HTTP/1.1 200 OK\r\nRugo-Version: 1\r\nContent-Length: 99999999999\r\n\r\n{",
    };
    for (size_t n = 0; n < sizeof answers / sizeof answers[0]; n++) {
        struct stub stub = {.manner = ANSWER_AND_CLOSE, .answer = answers[n]};
        struct error err = {0};
        /* waiting does not help where no HTTP is spoken */
        int wanted = strncmp(answers[n], "SSH", 3) == 0 ? ERROR_INPUT : ERROR_SYSTEM;
        if (ask(&stub, &err) != wanted || err.text[0] == '\0') {
            fail_msg("taken: %s", answers[n]);
        }
    }
}

/* Protects the memory of a worker: the reply is cut, not kept. */
static void endless_answer_is_cut(void **state) {
    (void)state;
    struct stub stub = {.manner = ENDLESS, .answer = "HTTP/1.1 200 OK\r\nRugo-Version: 1\r\n\r\n"};
    stub_start(&stub);
    struct client *client = client_of(stub.url, NULL);
    struct request request = {.method = "GET", .path = "/"};
    cJSON *answer = NULL;
    struct error err = {0};
    assert_int_equal(client_json(client, &request, &answer, &err), ERROR_SYSTEM);
    assert_non_null(strstr(err.text, "larger than"));
    assert_null(answer);
    client_destroy(&client);
    stub_stop(&stub);
}

static void statuses_become_errors(void **state) {
    (void)state;
    static const struct {
        const char *status;
        int code;
    } table[] = {
        {"400 Bad Request", ERROR_INPUT},
        {"401 Unauthorized", ERROR_INPUT},
        {"404 Not Found", ERROR_ABSENT},
        {"408 Request Timeout", ERROR_SYSTEM},
        {"409 Conflict", ERROR_STATE},
        {"422 Unprocessable Content", ERROR_INPUT},
        {"429 Too Many Requests", ERROR_SYSTEM},
        {"500 Internal Server Error", ERROR_SYSTEM},
        {"503 Service Unavailable", ERROR_SYSTEM},
    };
    for (size_t n = 0; n < sizeof table / sizeof table[0]; n++) {
        char answer[512];
        static const char problem[] =
            "{\"title\":\"t\",\"detail\":\"the study is "
            "invalid\",\"errors\":[{\"pointer\":\"/seed\","
            "\"detail\":\"must be a number\"},{\"pointer\":\"/kind\",\"detail\":\"is required\"}]}";
        snprintf(answer, sizeof answer,
                 "HTTP/1.1 %s\r\nRugo-Version: 1\r\nContent-Type: "
                 "application/problem+json\r\nContent-Length: "
                 "%zu\r\n\r\n%s",
                 table[n].status, sizeof problem - 1, problem);
        struct stub stub = {.manner = ANSWER, .answer = answer};
        struct error err = {0};
        assert_int_equal(ask(&stub, &err), table[n].code);
        assert_string_equal(err.text, "the study is invalid; /seed: must be a number; "
                                      "/kind: is required");
    }
}

static void a_fault_of_the_whole_is_told_once(void **state) {
    (void)state;
    static const char answer[] =
        "HTTP/1.1 422 Unprocessable Content\r\nRugo-Version: 1\r\nContent-Type: "
        "application/problem+json\r\n"
        "Content-Length: 75\r\n\r\n"
        "{\"detail\":\"too few rows\",\"errors\":[{\"pointer\":\"\",\"detail\":\"too few rows\"}]}";
    struct stub stub = {.manner = ANSWER, .answer = answer};
    struct error err = {0};
    assert_int_equal(strlen(strstr(answer, "\r\n\r\n") + 4), 75);
    assert_int_equal(ask(&stub, &err), ERROR_INPUT);
    assert_string_equal(err.text, "too few rows");
}

/* A server must not send a worker, with its token, elsewhere. */
static void redirects_are_not_followed(void **state) {
    (void)state;
    struct stub stub = {
        .manner = ANSWER,
        .answer = "HTTP/1.1 307 Temporary Redirect\r\nRugo-Version: 1\r\nLocation: /elsewhere\r\n"
                  "Content-Length: 0\r\n\r\n"};
    struct error err = {0};
    assert_int_equal(ask(&stub, &err), ERROR_SYSTEM);
    assert_non_null(strstr(err.text, "307"));
    assert_int_equal(stub.requests, 1);
}

static void download_goes_to_the_file(void **state) {
    (void)state;
    struct stub stub = {
        .manner = ANSWER,
        .answer = "HTTP/1.1 200 OK\r\nRugo-Version: 1\r\nContent-Length: 6\r\n\r\nSQLite"};
    stub_start(&stub);
    struct client *client = client_of(stub.url, NULL);
    struct error err = {0};
    char text[16] = "";
    uint64_t size = 0;
    FILE *file = tmpfile();
    assert_non_null(file);
    assert_int_equal(client_download(client, "/v1/snapshot", file, &size, &err), 0);
    assert_int_equal(size, 6);
    rewind(file);
    assert_int_equal(fread(text, 1, sizeof text, file), 6);
    assert_string_equal(text, "SQLite");
    fclose(file);
    client_destroy(&client);
    stub_stop(&stub);
}

/* The words of a refusal belong to the user, not into the file. */
static void refused_download_leaves_the_file_empty(void **state) {
    (void)state;
    struct stub stub = {
        .manner = ANSWER,
        .answer = "HTTP/1.1 403 Forbidden\r\nRugo-Version: 1\r\nContent-Length: 23\r\n\r\n"
                  "{\"detail\":\"not allowed\"}"};
    stub_start(&stub);
    struct client *client = client_of(stub.url, NULL);
    struct error err = {0};
    FILE *file = tmpfile();
    assert_non_null(file);
    assert_int_equal(client_download(client, "/v1/snapshot", file, NULL, &err), ERROR_INPUT);
    assert_int_equal(ftell(file), 0);
    fclose(file);
    client_destroy(&client);
    stub_stop(&stub);
}

static void wrong_addresses_and_tokens_are_refused(void **state) {
    (void)state;
    static const char *const urls[] = {
        "",
        "host",
        "ftp://host:1",
        "http://",
        "http://h:99999",
        "file:///etc",
        "http://h/path",
        "http://h:1?q=1",
        "http://u:p@h:1",
        "http://h h:1",
        "http://h:1#x",
        "h:1/path",
        "h:1#2",
        "u:p@h:1",
        "study.db",
        "127.0.0.1:",
    };
    struct client *client = NULL;
    struct error err = {0};
    for (size_t n = 0; n < sizeof urls / sizeof urls[0]; n++) {
        if (client_create(&client, urls[n], NULL, NULL, &err) != ERROR_INPUT) {
            fail_msg("'%s' was taken", urls[n]);
        }
        assert_non_null(strstr(err.text, urls[n]));
        assert_null(client);
    }
    static const char *const alone[] = {"127.0.0.1:8080", "localhost:8080", "[::1]:8080"};
    for (size_t n = 0; n < sizeof alone / sizeof alone[0]; n++) {
        assert_int_equal(client_create(&client, alone[n], "a", NULL, &err), 0);
        client_destroy(&client);
    }
    assert_int_equal(client_create(&client, "h.example:8080", "a", NULL, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "http://h.example:8080 would get the token in clear text"));
    assert_int_equal(client_create(&client, "http://h:1", "a\r\nX: y", NULL, &err), ERROR_INPUT);
    assert_int_equal(client_create(&client, "https://[::1]:8080/", "a", NULL, &err), 0);
    client_destroy(&client);
    client_destroy(&client);
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
        cmocka_unit_test(refused_connection_is_no_answer),
        cmocka_unit_test(requests_share_a_connection),
        cmocka_unit_test(no_content_is_no_answer_to_parse),
        cmocka_unit_test(slow_servers_are_left),
        cmocka_unit_test(broken_answers_are_errors),
        cmocka_unit_test(endless_answer_is_cut),
        cmocka_unit_test(statuses_become_errors),
        cmocka_unit_test(a_fault_of_the_whole_is_told_once),
        cmocka_unit_test(redirects_are_not_followed),
        cmocka_unit_test(download_goes_to_the_file),
        cmocka_unit_test(refused_download_leaves_the_file_empty),
        cmocka_unit_test(wrong_addresses_and_tokens_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
