/* Protects: a server whose store was moved, deleted or replaced, or cannot be written, says so and
 * takes nothing that would be lost; it reads no other file than it writes, and goes on once the
 * file is back. */
#include "schema/store/store_internal.h"
#include "server/http/health.h"
#include "server/http/service.h"
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define JSON "Content-Type: application/json\r\n"
enum { PATIENCE_MS = 60000 };

static struct process server;
static unsigned port;

static int start(void **state) {
    (void)state;
    port = serve_start(&server, (const char *[]){"--db", "served.db", NULL});
    return 0;
}

static int stop(void **state) {
    (void)state;
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    static const char *const LEFT[] = {"served.db", "served.db-wal", "served.db-shm"};
    for (size_t l = 0; l < sizeof LEFT / sizeof *LEFT; l++)
        remove(LEFT[l]);
    return 0;
}

static int submit(void) {
    return http_exchange(port, "POST", "/v1/studies", JSON, ONE_CASE, NULL);
}

static int list(void) {
    return http_exchange(port, "GET", "/v1/studies", NULL, NULL, NULL);
}

/* What /healthz says: 200 and ok, or 503 with a reason in which this stands. */
static void check_health(int status, const char *reason) {
    char *body = NULL;
    assert_int_equal(http_exchange(port, "GET", "/healthz", NULL, NULL, &body), status);
    cJSON *document = cJSON_Parse(strchr(body, '{'));
    const char *said = cJSON_GetStringValue(cJSON_GetObjectItem(document, "status"));
    assert_non_null(said);
    assert_string_equal(said, status == 200 ? "ok" : "failing");
    const cJSON *reasons = cJSON_GetObjectItem(document, "reasons"), *one;
    bool found = reason == NULL;
    cJSON_ArrayForEach(one, reasons) found = found || strstr(one->valuestring, reason) != NULL;
    if (!found)
        fail_msg("no reason '%s' in %s", reason, body);
    cJSON_Delete(document);
    free(body);
}

static void check_metric(const char *line) {
    char *body = NULL;
    assert_int_equal(http_exchange(port, "GET", "/metrics", NULL, NULL, &body), 200);
    if (strstr(body, line) == NULL)
        fail_msg("no '%s' in the metrics", line);
    free(body);
}

/* The writer sees by itself that the file is back. */
static void wait_until_well(void) {
    for (int waited = 0; http_exchange(port, "GET", "/healthz", NULL, NULL, NULL) != 200;
         waited += 100) {
        assert_true(waited < PATIENCE_MS);
        sleep_ms(100);
    }
}

static void a_store_that_was_moved_is_not_written(void **state) {
    (void)state;
    check_health(200, NULL);
    check_metric("rugo_healthy 1\n");
    assert_int_equal(submit(), 201);
    assert_int_equal(rename("served.db", "away.db"), 0);
    check_health(503, "is gone");
    assert_int_equal(submit(), 503);
    assert_int_equal(list(), 503);
    check_health(503, "the last commit failed");
    check_metric("rugo_healthy 0\n");
    assert_int_equal(rename("away.db", "served.db"), 0);
    wait_until_well();
    assert_int_equal(submit(), 201);
    assert_int_equal(list(), 200);
}

static void another_file_in_its_place_is_neither_read_nor_written(void **state) {
    (void)state;
    assert_int_equal(submit(), 201);
    assert_int_equal(
        run_rugo("snapshot", (const char *[]){"snapshot", "--db", "served.db", "other.db", NULL}),
        0);
    assert_int_equal(rename("served.db", "kept.db"), 0);
    assert_int_equal(rename("other.db", "served.db"), 0);
    check_health(503, "is another file");
    assert_int_equal(submit(), 503);
    assert_int_equal(list(), 503);
    assert_int_equal(rename("kept.db", "served.db"), 0);
    wait_until_well();
    assert_int_equal(submit(), 201);
    assert_int_equal(remove("served.db"), 0);
    check_health(503, "is gone");
    assert_int_equal(submit(), 503);
    assert_int_equal(list(), 503);
}

/* --- without a server --- */

static int do_nothing(struct store *store, void *context, struct error *err) {
    (void)context;
    return store_share(store, "someone", 1 + (double)(time(NULL) % 2), err);
}

static int fill(struct store *store, void *context, struct error *err) {
    (void)context;
    return store_execute(store, "CREATE TABLE filling AS SELECT zeroblob(1000000) AS bytes", err);
}

/* A full disk, as SQLite has it for a file that may have no more pages. */
static void a_full_disk_is_told_until_there_is_room(void **state) {
    (void)state;
    static struct service service;
    struct error err = {0};
    struct health health;
    assert_int_equal(service_open(&service, "full.db", 60000, &err), 0);
    service_health(&service, &health);
    assert_int_equal(health.count, 0);
    assert_int_equal(store_execute(service.store, "PRAGMA max_page_count = 100", &err), 0);
    assert_int_equal(writer_do(service.writer, fill, NULL, &err), ERROR_SYSTEM);
    assert_non_null(strstr(err.text, "is full"));
    service_health(&service, &health);
    assert_int_equal(health.count, 1);
    assert_non_null(strstr(health.reasons[0].text, "the last commit failed"));
    assert_non_null(strstr(health.reasons[0].text, "is full"));
    assert_int_equal(writer_do(service.writer, do_nothing, NULL, &err), 0);
    service_health(&service, &health);
    assert_int_equal(health.count, 0);
    service_close(&service);
    remove("full.db");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_store_that_was_moved_is_not_written, start, stop),
        cmocka_unit_test_setup_teardown(another_file_in_its_place_is_neither_read_nor_written,
                                        start, stop),
        cmocka_unit_test(a_full_disk_is_told_until_there_is_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
