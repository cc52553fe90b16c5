/* Protects: who deletes a study, near or over HTTP, finds it gone and the file smaller, and is
 * refused where it has not ended. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define JSON "Content-Type: application/json\r\n"

static struct process server;
static unsigned port;

static void check_answer(const char *method, const char *path, int status, const char *text) {
    char *answer = NULL;
    int got = http_exchange(port, method, path, NULL, NULL, &answer);
    if (got != status || strstr(answer, text) == NULL)
        fail_msg("%s %s: %d %s", method, path, got, answer);
    free(answer);
}

static void submit(char id[17]) {
    char *answer;
    assert_int_equal(http_exchange(port, "POST", "/v1/studies", JSON, ONE_CASE, &answer), 201);
    assert_int_equal(sscanf(answer, "{\"id\":\"%16[0-9a-f]\"", id), 1);
    free(answer);
}

static void over_http(void **state) {
    (void)state;
    char id[17], other[17], path[96], *answer;
    port = serve_start(&server, NULL);
    submit(id);
    submit(other);
    snprintf(path, sizeof path, "/v1/studies/%s?results=true", id);
    check_answer("DELETE", path, 409, "has not ended: cancel it first");
    snprintf(path, sizeof path, "/v1/studies/%s?results=yes", id);
    check_answer("DELETE", path, 422, "?results is true");
    snprintf(path, sizeof path, "/v1/studies/%s", id);
    check_answer("DELETE", path, 200, "\"state\":\"cancelled\"");
    snprintf(path, sizeof path, "/v1/studies/%s?results=true", id);
    check_answer("DELETE", path, 200, "\"name\":\"one\",\"state\":\"deleted\"}");
    check_answer("DELETE", path, 404, "there is no study");
    snprintf(path, sizeof path, "/v1/studies/%s/events", id);
    check_answer("GET", path, 404, "there is no study");
    snprintf(path, sizeof path, "/v1/studies?after=%s", id);
    check_answer("GET", path, 200, other);
    assert_int_equal(http_exchange(port, "GET", "/v1/studies", NULL, NULL, &answer), 200);
    assert_null(strstr(answer, id));
    free(answer);
    check_answer("GET", "/metrics", 200, "rugo_studies 1\n");
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 15), 0);
}

static int rugo_delete(const char *id) {
    return run_rugo("delete", (const char *[]){"delete", "--db", "near.db", id, NULL});
}

static long size_of(const char *path) {
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    return (long)info.st_size;
}

/* By the name of the study. */
static void in_a_local_store(void **state) {
    (void)state;
    spit("one.json", ONE_CASE);
    spit("blocks.json", SEVERAL_BLOCKS);
    assert_int_equal(run_rugo("one", (const char *[]){"run", "--db", "near.db", "one.json", NULL}),
                     0);
    long small = size_of("near.db");
    assert_int_equal(
        run_rugo("blocks", (const char *[]){"run", "--db", "near.db", "blocks.json", NULL}), 0);
    assert_true(size_of("near.db") > small + 100000);
    assert_int_equal(rugo_delete("absent"), 1);
    assert_true(contains("delete.err", "there is no study \"absent\""));
    assert_int_equal(rugo_delete("blocks"), 0);
    assert_true(contains("delete.out", "is deleted"));
    assert_in_range(size_of("near.db"), 1, small + 8 * 4096);
    assert_int_equal(run_rugo("status", (const char *[]){"status", "--db", "near.db", NULL}), 0);
    assert_true(contains("status.out", "one"));
    assert_false(contains("status.out", "blocks"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(over_http),
        cmocka_unit_test(in_a_local_store),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
