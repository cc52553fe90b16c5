/* Protects: the commands of server/operate.md do what the page says, health and prune too; and a
 * store that is put back while workers go on, as the page describes it, ends with the curves of a
 * run that nothing happened to. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/sql.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* So many jobs that some are left when the snapshot is made. */
static const char STUDY[] =
    "{\"name\":\"kept\",\"kind\":\"statistics\",\"seed\":1,\"realisations\":60,\"surface\":{"
    "\"hurst\":[0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9],\"wavelength_ratio\":8,\"length_ratio\":6,"
    "\"points_per_wavelength\":8},\"statistics\":{\"bins\":{\"height\":[-4,8,24],\"curvature\":[-"
    "16,0,16]}}"
    "}";

static const char SMALL[] =
    "{\"name\":\"small\",\"kind\":\"statistics\",\"seed\":1,\"realisations\":20,\"surface\":{"
    "\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":4,\"points_per_wavelength\":8},"
    "\"statistics\":{\"bins\":{\"height\":[-4,8,24],\"curvature\":[-16,0,16]}}}";

static void page_does_what_it_says(void **state) {
    char command[1200];
    const char *source = getenv("RUGO_SOURCE");
    (void)state;
    spit("study.json", SMALL);
    snprintf(
        command, sizeof command,
        "sh '%s/tests/system/server/operate.sh' '%s/server/operate.md' '%s' %u >operate.out 2>&1",
        source != NULL ? source : ".", source != NULL ? source : ".", rugo(), free_port());
    if (system(command) != 0) {
        char *told = slurp("operate.out");
        fail_msg("%s", told);
    }
    assert_true(contains("operate.out", "operate: all done"));
}

static int64_t jobs_done(const char *path) {
    return sql_integer(path, "SELECT total(jobs_done) FROM study");
}

static void wait_for_jobs(const char *path, int64_t count) {
    for (int tries = 0; jobs_done(path) < count; tries++) {
        assert_true(tries < 12000);
        sleep_ms(10);
    }
}

static void serve_at(struct process *server, const char *listen) {
    process_start(
        server, "serve",
        (const char *[]){"serve", "--db", "live.db", "--listen", listen, "--lease", "5", NULL});
    wait_for_text(server->out, "listening");
}

static char *curves_of(const char *place, const char *at) {
    assert_int_equal(
        run_rugo("curves", (const char *[]){"curves", place, at, "kept", "--format", "csv", NULL}),
        0);
    assert_int_equal(system("grep -v '^#' curves.out >curves.csv"), 0);
    char *text = slurp("curves.csv");
    assert_true(strlen(text) > 10000);
    return text;
}

static void restored_store_goes_on(void **state) {
    struct process server, worker;
    char listen[40], url[48];
    (void)state;
    snprintf(listen, sizeof listen, "127.0.0.1:%u", free_port());
    snprintf(url, sizeof url, "http://%s", listen);
    spit("kept.json", STUDY);
    serve_at(&server, listen);
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--server", url, "kept.json", NULL}), 0);
    process_start(&worker, "work",
                  (const char *[]){"work", "--server", url, "--workers", "2", NULL});
    wait_for_jobs("live.db", 2);
    process_kill(&worker, SIGSTOP); /* so that however late the snapshot is, jobs are left */
    assert_int_equal(
        run_rugo("snapshot", (const char *[]){"snapshot", "--server", url, "copy.db", NULL}), 0);
    int64_t kept = jobs_done("copy.db");
    process_kill(&worker, SIGCONT);
    wait_for_jobs("live.db", kept + 1);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    /* work that was done after the snapshot is lost with the store */
    assert_int_equal(system("mkdir aside && mv live.db* aside/ && cp copy.db live.db"), 0);
    assert_int_equal(jobs_done("live.db"), kept);
    serve_at(&server, listen);
    assert_int_equal(run_rugo("wait", (const char *[]){"wait", "--server", url, "kept", "--timeout",
                                                       "300", NULL}),
                     0);
    char *restored = curves_of("--server", url);
    process_kill(&worker, SIGTERM);
    assert_int_equal(process_wait(&worker, 20), 0);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    assert_int_equal(
        run_rugo("run", (const char *[]){"run", "--db", "fresh.db", "kept.json", NULL}), 0);
    char *fresh = curves_of("--db", "fresh.db");
    assert_string_equal(restored, fresh);
    free(restored);
    free(fresh);
}

static void health_tells_the_reason(void **state) {
    struct process server;
    char url[48];
    (void)state;
    snprintf(url, sizeof url, "http://127.0.0.1:%u",
             serve_start(&server, (const char *[]){"--db", "gone.db", NULL}));
    const char *const health[] = {"health", "--server", url, NULL};
    assert_int_equal(run_rugo("health", health), 0);
    assert_true(contains("health.out", "\"status\":\"ok\""));
    assert_int_equal(rename("gone.db", "there.db"), 0);
    assert_int_equal(run_rugo("health", health), 1);
    assert_true(contains("health.err", "rugo health: database gone.db is gone"));
    process_kill(&server, SIGTERM);
    process_wait(&server, 20);
    assert_int_equal(run_rugo("health", health), 1);
}

static void change(const char *path, const char *sql) {
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db, sql, NULL, NULL, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_changes(db), 1);
    sqlite3_close(db);
}

/* What ended long ago goes; what ended lately, or has not, stays. */
static void prune_takes_what_is_old(void **state) {
    static const char *const RUN[] = {"run", "--db", "prune.db", "small.json", NULL};
    static const char *const PRUNE[] = {"prune", "--db", "prune.db", "--older-than", "30", NULL};
    (void)state;
    spit("small.json", SMALL);
    assert_int_equal(run_rugo("run", RUN), 0);
    change("prune.db", "UPDATE study SET name = 'old', finished = '2020-01-31T12:00:00Z'");
    assert_int_equal(run_rugo("run", RUN), 0);
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--db", "prune.db", "small.json", NULL}), 0);
    assert_int_equal(run_rugo("prune", (const char *[]){"prune", "--db", "prune.db", NULL}), 2);
    assert_true(contains("prune.err", "--older-than DAYS is missing"));
    assert_int_equal(run_rugo("prune", (const char *[]){"prune", "--db", "prune.db", "--older-than",
                                                        "100001", NULL}),
                     2);
    assert_true(contains("prune.err", "--older-than 100001 is not a whole number in [0, 100000]"));
    assert_int_equal(run_rugo("prune", (const char *[]){"prune", "--db", "prune.db", "--older-than",
                                                        "30", "--dry-run", NULL}),
                     0);
    assert_true(
        contains("prune.out", "ended 2020-01-31T12:00:00Z  old\n1 studies would be deleted"));
    assert_int_equal(run_rugo("prune", PRUNE), 0);
    assert_true(contains("prune.out", "ended 2020-01-31T12:00:00Z  old\n1 studies deleted"));
    assert_int_equal(run_rugo("prune", PRUNE), 0);
    assert_true(contains("prune.out", "0 studies deleted"));
    assert_int_equal(run_rugo("status", (const char *[]){"status", "--db", "prune.db", NULL}), 0);
    assert_true(contains("status.out", "done") && contains("status.out", "queued"));
    assert_false(contains("status.out", "old"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(page_does_what_it_says),
        cmocka_unit_test(restored_store_goes_on),
        cmocka_unit_test(health_tells_the_reason),
        cmocka_unit_test(prune_takes_what_is_old),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
