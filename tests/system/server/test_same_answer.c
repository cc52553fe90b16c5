/* Protects: one study and one seed give the same curves, byte for byte, with any number of workers,
 * near or over HTTP, whoever is killed when; and nothing runs in vain but what a killed worker had
 * under way. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <signal.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static unsigned seed;

/* Curves without what names the run. */
static char *curves_of(const char *database) {
    sqlite3 *db = NULL;
    sqlite3_stmt *row = NULL;
    char id[32], *text;
    assert_int_equal(sqlite3_open_v2(database, &db, SQLITE_OPEN_READONLY, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(db, "SELECT study FROM study_progress", -1, &row, NULL),
                     SQLITE_OK);
    assert_int_equal(sqlite3_step(row), SQLITE_ROW);
    snprintf(id, sizeof id, "%s", (const char *)sqlite3_column_text(row, 0));
    sqlite3_finalize(row);
    sqlite3_close(db);
    assert_int_equal(run_rugo("curves", (const char *[]){"curves", "--db", database, id, NULL}), 0);
    text = slurp("curves.out");
    char *cases = strstr(text, "\"cases\":");
    assert_non_null(cases);
    memmove(text, cases, strlen(cases) + 1);
    return text;
}

/* One number out of a database, for figures that only its log has. */
static long log_number(const char *database, const char *sql) {
    sqlite3 *db = NULL;
    sqlite3_stmt *row = NULL;
    assert_int_equal(sqlite3_open_v2(database, &db, SQLITE_OPEN_READONLY, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(db, sql, -1, &row, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(row), SQLITE_ROW);
    long number = (long)sqlite3_column_int64(row, 0);
    sqlite3_finalize(row);
    sqlite3_close(db);
    return number;
}

static char *expected; /* by one worker, undisturbed */

static int undisturbed(void **state) {
    (void)state;
    seed = (unsigned)time(NULL);
    print_message("seed %u\n", seed);
    spit("study.json", SEVERAL_BLOCKS);
    assert_int_equal(run_rugo("one", (const char *[]){"run", "--db", "one.db", "--workers", "1",
                                                      "study.json", NULL}),
                     0);
    expected = curves_of("one.db");
    assert_int_equal(log_number("one.db", "SELECT sum(attempts) FROM job_log"), 6);
    return 0;
}

static int cleanup(void **state) {
    (void)state;
    free(expected);
    return 0;
}

static void check_same(const char *database) {
    char *curves = curves_of(database);
    assert_string_equal(curves, expected);
    free(curves);
}

static void submit_to(const char *database) {
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--db", database, "study.json", NULL}), 0);
}

static void with_five_threads(void **state) {
    (void)state;
    assert_int_equal(run_rugo("five", (const char *[]){"run", "--db", "five.db", "--workers", "5",
                                                       "study.json", NULL}),
                     0);
    check_same("five.db");
}

static void with_two_processes_on_one_file(void **state) {
    (void)state;
    struct process workers[2];
    submit_to("two.db");
    for (int w = 0; w < 2; w++)
        process_start(
            &workers[w], w ? "b" : "a",
            (const char *[]){"work", "--db", "two.db", "--drain", "--workers", "1", NULL});
    for (int w = 0; w < 2; w++)
        assert_int_equal(process_wait(&workers[w], 60), 0);
    check_same("two.db");
    assert_int_equal(log_number("two.db", "SELECT sum(attempts) FROM job_log"), 6);
}

/* Kills one worker after another at a random moment, then lets a last one finish. */
static void with_workers_killed(void **state) {
    (void)state;
    const int kills = 2; /* three attempts of one job would fail it */
    submit_to("killed.db");
    for (int k = 0; k < kills; k++) {
        struct process worker;
        process_start(
            &worker, "victim",
            (const char *[]){"work", "--db", "killed.db", "--workers", "1", "--lease", "3", NULL});
        sleep_ms(50 + rand_r(&seed) % 400);
        process_kill(&worker, SIGKILL);
        process_wait(&worker, 10);
        sleep_ms(3100); /* its lease must run out */
        struct process next;
        process_start(
            &next, "next",
            (const char *[]){"work", "--db", "killed.db", "--workers", "1", "--lease", "3", NULL});
        sleep_ms(700);
        process_kill(&next, SIGTERM); /* hands back what it had */
        assert_int_equal(process_wait(&next, 20), 0);
    }
    assert_int_equal(run_rugo("last", (const char *[]){"work", "--db", "killed.db", "--drain",
                                                       "--lease", "3", NULL}),
                     0);
    check_same("killed.db");
    assert_true(log_number("killed.db", "SELECT sum(attempts) FROM job_log") <= 6 + kills);
    assert_int_equal(log_number("killed.db", "SELECT sum(count) FROM job_log WHERE state = 'done'"),
                     24000);
}

/* The server dies in the middle and comes back on the same port; workers wait for it. */
static void over_http_with_the_server_killed(void **state) {
    (void)state;
    struct process server, workers[2];
    char url[64], listen[64];
    unsigned port = serve_start(&server, (const char *[]){"--db", "http.db", "--lease", "2", NULL});
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    snprintf(listen, sizeof listen, "127.0.0.1:%u", port);
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--server", url, "study.json", NULL}), 0);
    for (int w = 0; w < 2; w++)
        process_start(&workers[w], w ? "hb" : "ha",
                      (const char *[]){"work", "--server", url, "--drain", "--workers", "1", NULL});
    sleep_ms(100 + rand_r(&seed) % 500);
    process_kill(&server, SIGKILL);
    process_wait(&server, 10);
    sleep_ms(300);
    process_start(
        &server, "serve2",
        (const char *[]){"serve", "--db", "http.db", "--lease", "2", "--listen", listen, NULL});
    for (int w = 0; w < 2; w++)
        assert_int_equal(process_wait(&workers[w], 60), 0);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    check_same("http.db");
    assert_int_equal(log_number("http.db", "SELECT count(*) FROM job_log WHERE state = 'done'"), 6);
}

/* Workers over HTTP killed at random, the server's own workers among them. */
static void over_http_with_workers_killed(void **state) {
    (void)state;
    struct process server, victim;
    char url[64];
    unsigned port = serve_start(
        &server, (const char *[]){"--db", "victims.db", "--lease", "3", "--workers", "1", NULL});
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--server", url, "study.json", NULL}), 0);
    process_start(&victim, "victim",
                  (const char *[]){"work", "--server", url, "--workers", "1", NULL});
    sleep_ms(50 + rand_r(&seed) % 300);
    process_kill(&victim, SIGKILL);
    process_wait(&victim, 10);
    assert_int_equal(run_rugo("rest", (const char *[]){"work", "--server", url, "--drain",
                                                       "--workers", "1", NULL}),
                     0);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    check_same("victims.db");
    assert_true(log_number("victims.db", "SELECT sum(attempts) FROM job_log") <= 7);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(with_five_threads),
        cmocka_unit_test(with_two_processes_on_one_file),
        cmocka_unit_test(with_workers_killed),
        cmocka_unit_test(over_http_with_the_server_killed),
        cmocka_unit_test(over_http_with_workers_killed),
    };
    return cmocka_run_group_tests(tests, undisturbed, cleanup);
}
