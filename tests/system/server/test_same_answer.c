/* Protects: one study and one seed give the same curves, byte for byte, with any number of workers,
 * near or over HTTP, whoever is killed when; and nothing runs in vain but the jobs of a killed
 * worker. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/seed.h"
#include "tests/support/small_studies.h"
#include "tests/support/sql.h"
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static uint64_t seed;

/* Curves without what names the run. */
static char *curves_of(const char *database) {
    char id[32], *text;
    sqlite3_stmt *row = sql_row(database, "SELECT study FROM study_progress");
    snprintf(id, sizeof id, "%s", (const char *)sqlite3_column_text(row, 0));
    sql_end(row);
    assert_int_equal(run_rugo("curves", (const char *[]){"curves", "--db", database, id, NULL}), 0);
    text = slurp("curves.out");
    char *cases = strstr(text, "\"cases\":");
    assert_non_null(cases);
    memmove(text, cases, strlen(cases) + 1);
    return text;
}

/* Claims that led to no result. */
static long in_vain(const char *database) {
    return sql_integer(database,
                       "SELECT sum(attempts + losses) - sum(state = 'done') FROM job_log");
}

static char *expected; /* by one worker, undisturbed */

static int undisturbed(void **state) {
    (void)state;
    seed = seed_of_now();
    spit("study.json", SEVERAL_BLOCKS);
    assert_int_equal(run_rugo("one", (const char *[]){"run", "--db", "one.db", "--workers", "1",
                                                      "study.json", NULL}),
                     0);
    expected = curves_of("one.db");
    assert_int_equal(sql_integer("one.db", "SELECT count(*) FROM job_log"), SEVERAL_BLOCKS_JOBS);
    assert_int_equal(in_vain("one.db"), 0);
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
        assert_int_equal(process_wait(&workers[w], 200), 0);
    check_same("two.db");
    assert_int_equal(in_vain("two.db"), 0);
}

/* What the process holds of the blocks of the Weibull case, which take a while, or of all. */
static long blocks_held(const char *database, const struct process *worker, bool all) {
    char sql[160];
    snprintf(sql, sizeof sql,
             "SELECT count(*) FROM job_log WHERE state = 'running' AND \"case\" >= %d AND worker "
             "LIKE '%%-%ld'",
             all ? 0 : 1, (long)worker->pid);
    return sql_integer(database, sql);
}

/* Waits until the worker is in the middle of a block, or nothing is left for it, and a random
 * moment longer. */
static void wait_until_at_work(const char *database, const struct process *worker) {
    for (int tries = 0; blocks_held(database, worker, false) == 0; tries++) {
        if (!sql_integer(database, "SELECT count(*) FROM job_log WHERE state = 'waiting'"))
            return;
        assert_true(tries < 24000);
        sleep_ms(5);
    }
    sleep_ms((long)(next_word(&seed) % 60));
}

/* Kills a worker in the middle of a block. */
static void kill_at_work(const char *database, struct process *worker) {
    wait_until_at_work(database, worker);
    process_kill(worker, SIGKILL);
    process_wait(worker, 20);
}

/* How many blocks remain with a worker that was killed: the one it was in, unless it was just done,
 * and those it had not begun. Their leases end, as time would have it: until they are counted
 * nobody else may have them. */
static long lose_blocks(const char *database, const struct process *dead) {
    char sql[160];
    long held = blocks_held(database, dead, true);
    snprintf(sql, sizeof sql,
             "UPDATE job SET lease_until = 0 WHERE state = 'running' AND worker LIKE '%%-%ld'",
             (long)dead->pid);
    sql_change(database, sql);
    return held;
}

/* Each victim dies over a block of its own; the last worker gets them. */
static void with_workers_killed(void **state) {
    (void)state;
    long lost = 0;
    submit_to("killed.db");
    for (int k = 0; k < 3; k++) {
        struct process victim;
        process_start(&victim, "victim",
                      (const char *[]){"work", "--db", "killed.db", "--workers", "1", NULL});
        struct process dead = victim;
        kill_at_work("killed.db", &victim);
        lost += lose_blocks("killed.db", &dead);
    }
    assert_int_equal(
        run_rugo("last", (const char *[]){"work", "--db", "killed.db", "--drain", NULL}), 0);
    check_same("killed.db");
    print_message("blocks lost: %ld\n", lost);
    assert_int_equal(in_vain("killed.db"), lost);
    assert_int_equal(
        sql_integer("killed.db", "SELECT sum(count) FROM job_log WHERE state = 'done'"),
        1000 * SEVERAL_BLOCKS_JOBS);
}

/* A worker that is asked to end hands its block back: it is no attempt, nobody waits for a
 * lease. */
static void with_a_worker_told_to_end(void **state) {
    (void)state;
    struct process worker;
    submit_to("told.db");
    process_start(&worker, "told",
                  (const char *[]){"work", "--db", "told.db", "--workers", "1", NULL});
    wait_until_at_work("told.db", &worker);
    process_kill(&worker, SIGTERM);
    assert_int_equal(process_wait(&worker, 20), 0);
    assert_int_equal(sql_integer("told.db", "SELECT count(*) FROM job_log WHERE state = 'running'"),
                     0);
    assert_int_equal(run_rugo("rest", (const char *[]){"work", "--db", "told.db", "--drain", NULL}),
                     0);
    check_same("told.db");
    assert_int_equal(in_vain("told.db"), 0);
}

/* The server dies in the middle of blocks and comes back on the same port; workers wait for it. */
static void over_http_with_the_server_killed(void **state) {
    (void)state;
    struct process server, workers[2];
    char url[64], listen[40];
    snprintf(listen, sizeof listen, "127.0.0.1:%u", free_port());
    snprintf(url, sizeof url, "http://%s", listen);
    serve_start(&server,
                (const char *[]){"--db", "http.db", "--lease", "5", "--listen", listen, NULL});
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--server", url, "study.json", NULL}), 0);
    for (int w = 0; w < 2; w++)
        process_start(&workers[w], w ? "hb" : "ha",
                      (const char *[]){"work", "--server", url, "--drain", "--workers", "1", NULL});
    wait_until_at_work("http.db", &workers[0]);
    process_kill(&server, SIGKILL);
    process_wait(&server, 20);
    sleep_ms(300);
    process_start(
        &server, "serve2",
        (const char *[]){"serve", "--db", "http.db", "--lease", "5", "--listen", listen, NULL});
    for (int w = 0; w < 2; w++)
        assert_int_equal(process_wait(&workers[w], 200), 0);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    check_same("http.db");
    assert_int_equal(sql_integer("http.db", "SELECT sum(count) FROM job_log WHERE state = 'done'"),
                     1000 * SEVERAL_BLOCKS_JOBS);
    /* Finished results are kept and sent again; only what a claim took whose answer was lost is in
     * vain, at most every block once. */
    assert_true(in_vain("http.db") <= SEVERAL_BLOCKS_JOBS);
}

/* Waits until a server has done with all that a worker sent before it was killed: a block that was
 * handed in is not lost, and one that was asked for may be. */
static void wait_until_worker_left(unsigned port) {
    enum { ITS_OWN_WORKER_AND_THIS = 2, TRIES = 1000 };
    static const char NAME[] = "\nrugo_http_connections ";
    for (long open = LONG_MAX, tries = 0; open > ITS_OWN_WORKER_AND_THIS; tries++) {
        char *metrics = NULL;
        assert_true(tries < TRIES);
        sleep_ms(10);
        assert_int_equal(http_exchange(port, "GET", "/metrics", NULL, NULL, &metrics), 200);
        const char *at = strstr(metrics, NAME);
        assert_non_null(at);
        open = strtol(at + strlen(NAME), NULL, 10);
        free(metrics);
    }
}

/* A worker over HTTP killed at work; the server's own worker and a third one go on. */
static void over_http_with_workers_killed(void **state) {
    (void)state;
    struct process server, victim;
    char url[64];
    unsigned port = serve_start(
        &server, (const char *[]){"--db", "victims.db", "--lease", "60", "--workers", "1", NULL});
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--server", url, "study.json", NULL}), 0);
    process_start(&victim, "victim",
                  (const char *[]){"work", "--server", url, "--workers", "1", NULL});
    struct process dead = victim;
    kill_at_work("victims.db", &victim);
    wait_until_worker_left(port);
    long lost = lose_blocks("victims.db", &dead);
    assert_int_equal(run_rugo("rest", (const char *[]){"work", "--server", url, "--drain",
                                                       "--workers", "1", NULL}),
                     0);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    check_same("victims.db");
    print_message("blocks lost: %ld\n", lost);
    assert_int_equal(in_vain("victims.db"), lost);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(with_five_threads),
        cmocka_unit_test(with_two_processes_on_one_file),
        cmocka_unit_test(with_workers_killed),
        cmocka_unit_test(with_a_worker_told_to_end),
        cmocka_unit_test(over_http_with_the_server_killed),
        cmocka_unit_test(over_http_with_workers_killed),
    };
    return cmocka_run_group_tests(tests, undisturbed, cleanup);
}
