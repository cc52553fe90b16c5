/* Protects: publishing that ends. Whatever becomes of a study under a server (cancelled within a
 * case, a block failed for good, results that no program can merge), every other case is published.
 * What cannot be says why and hides no other case. A server with nothing to do uses no
 * processor. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include "tests/support/sql.h"
#include <cjson/cJSON.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Two cases of as many blocks as no worker takes before it is to end. */
static const char LONG[] =
    "{\"name\":\"long\",\"kind\":\"statistics\",\"seed\":7,\"realisations\":1000000,\"surface\":{"
    "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":4,"
    "\"points_per_wavelength\":8,\"heights\":{\"distribution\":[\"gaussian\",\"weibull_max\"],"
    "\"shape\":2,\"max_iterations\":10}},\"statistics\":{\"bins\":{\"height\":[-4,4,20],"
    "\"curvature\":[-8,0,10]}}}";

enum { PATIENCE_S = 60 };
#define JSON "Content-Type: application/json\r\n"

/* The first column of the first row as a text; the caller frees. "" when there is none. */
static char *ask(const char *database, const char *sql, const char *study) {
    sqlite3 *db = NULL;
    sqlite3_stmt *row = NULL;
    assert_int_equal(sqlite3_open_v2(database, &db, SQLITE_OPEN_READONLY, NULL), SQLITE_OK);
    sqlite3_busy_timeout(db, 20000);
    if (sqlite3_prepare_v2(db, sql, -1, &row, NULL) != SQLITE_OK)
        fail_msg("%s: %s", sql, sqlite3_errmsg(db));
    sqlite3_bind_text(row, 1, study, -1, SQLITE_STATIC);
    bool found = sqlite3_step(row) == SQLITE_ROW && sqlite3_column_type(row, 0) != SQLITE_NULL;
    char *text = strdup(found ? (const char *)sqlite3_column_text(row, 0) : "");
    assert_non_null(text);
    sqlite3_finalize(row);
    sqlite3_close(db);
    return text;
}

static void expect(const char *database, const char *sql, const char *study, const char *expected) {
    char *text = ask(database, sql, study);
    if (strcmp(text, expected) != 0)
        fail_msg("%s: \"%s\" instead of \"%s\"", sql, text, expected);
    free(text);
}

/* Waits until the query answers with the text. */
static void wait_for(const char *database, const char *sql, const char *study, const char *text) {
    for (int waited = 0; waited < PATIENCE_S * 100; waited++) {
        char *found = ask(database, sql, study);
        bool there = strcmp(found, text) == 0;
        free(found);
        if (there)
            return;
        sleep_ms(10);
    }
    expect(database, sql, study, text);
}

static void submit(const char *url, const char *file, char id[32]) {
    assert_int_equal(run_rugo("submit", (const char *[]){"submit", "--server", url, file, NULL}),
                     0);
    char *text = slurp("submit.out");
    snprintf(id, 32, "%.16s", text);
    free(text);
}

/* Claims the first job that waits and fails it for good. */
static void fail_one_job(unsigned port) {
    char path[64], body[128], *answer = NULL;
    assert_int_equal(http_exchange(port, "POST", "/v1/jobs/claim", JSON,
                                   "{\"worker\":\"w\",\"sequence\":true}", &answer),
                     200);
    cJSON *document = cJSON_Parse(answer);
    const cJSON *job = cJSON_GetArrayItem(cJSON_GetObjectItem(document, "jobs"), 0);
    assert_non_null(job);
    snprintf(path, sizeof path, "/v1/jobs/%.0f/fail", cJSON_GetObjectItem(job, "id")->valuedouble);
    snprintf(body, sizeof body, "{\"token\":\"%s\",\"reason\":\"hopeless\",\"permanent\":true}",
             cJSON_GetObjectItem(job, "token")->valuestring);
    assert_int_equal(http_exchange(port, "POST", path, JSON, body, NULL), 200);
    cJSON_Delete(document);
    free(answer);
}

/* Clock ticks of processor time that a process has used. */
static long ticks_of(pid_t pid) {
    char path[64];
    unsigned long user = 0, kernel = 0;
    snprintf(path, sizeof path, "/proc/%ld/stat", (long)pid);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    /* 14 and 15 of the fields, of which the second, the name, is in parentheses */
    int read = fscanf(file, "%*d (%*[^)]) %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu",
                      &user, &kernel);
    fclose(file);
    assert_int_equal(read, 2);
    return (long)(user + kernel);
}

/* The publisher that tried for ever took a whole processor: 300 ticks here, each time. What is left
 * to do after the last case, such as a checkpoint, takes some at first. */
static void check_idle(const struct process *server) {
    enum { LOOKS = 10 };
    long used = 0, most = sysconf(_SC_CLK_TCK) / 10;
    for (int look = 0; look < LOOKS; look++) {
        long before = ticks_of(server->pid);
        sleep_ms(3000);
        used = ticks_of(server->pid) - before;
        if (used <= most)
            return;
    }
    fail_msg("an idle server used %ld ticks of %ld a second in 3 s, after %d s", used, 10 * most,
             3 * LOOKS);
}

static void a_server_publishes_what_there_is(void **state) {
    (void)state;
    struct process server, worker;
    char url[64], cut[32], failed[32], whole[32];
    spit("blocks.json", SEVERAL_BLOCKS);
    spit("one.json", ONE_CASE);
    unsigned port = serve_start(&server, (const char *[]){"--db", "serve.db", NULL});
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    spit("long.json", LONG);
    submit(url, "long.json", cut);
    /* some of many blocks of its first case come in, then it is cancelled */
    process_start(&worker, "worker",
                  (const char *[]){"work", "--server", url, "--workers", "1", NULL});
    wait_for("serve.db", "SELECT min(1, realisations_done) FROM study_progress WHERE study = ?",
             cut, "1");
    assert_int_equal(run_rugo("cancel", (const char *[]){"cancel", "--server", url, cut, NULL}), 0);
    process_kill(&worker, SIGTERM);
    process_wait(&worker, PATIENCE_S);
    submit(url, "blocks.json", failed);
    submit(url, "one.json", whole);
    fail_one_job(port);
    assert_int_equal(run_rugo("drain", (const char *[]){"work", "--server", url, "--drain", NULL}),
                     0);
    wait_for("serve.db", "SELECT count(*) FROM case_progress WHERE state IN ('open', 'due')", NULL,
             "0");
    expect("serve.db",
           "SELECT state || (0 < realisations_done AND realisations_done < realisations) FROM "
           "case_progress WHERE study = ? AND \"case\" = 0",
           cut, "published1");
    expect("serve.db", "SELECT state FROM study_progress WHERE study = ?", cut, "cancelled");
    expect("serve.db",
           "SELECT group_concat(state || (realisations_done < realisations), ' ') FROM "
           "case_progress WHERE study = ?",
           failed, "published1 published0");
    expect("serve.db", "SELECT state FROM study_progress WHERE study = ?", failed, "failed");
    expect("serve.db", "SELECT state FROM study_progress WHERE study = ?", whole, "done");
    for (int s = 0; s < 3; s++)
        expect("serve.db", "SELECT count(*) > 10 FROM curve_points WHERE study = ?",
               s == 0   ? cut
               : s == 1 ? failed
                        : whole,
               "1");
    check_idle(&server);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, PATIENCE_S), 0);
}

/* A published case whose document was damaged is answered as before, and published anew. */
static void what_was_damaged_is_published_anew(void **state) {
    (void)state;
    struct process server;
    char path[80], *before = NULL, *after = NULL;
    spit("one.json", ONE_CASE);
    assert_int_equal(
        run_rugo("whole", (const char *[]){"run", "--db", "harmed.db", "one.json", NULL}), 0);
    char *study = ask("harmed.db", "SELECT public FROM study", NULL);
    char *document = ask("harmed.db", "SELECT document FROM published", NULL);
    snprintf(path, sizeof path, "/v1/studies/%s/curves", study);
    unsigned port = serve_start(&server, (const char *[]){"--db", "harmed.db", NULL});
    assert_int_equal(http_exchange(port, "GET", path, NULL, NULL, &before), 200);
    sql_change("harmed.db", "UPDATE published SET document = replace(document, '0.', '1.')");
    assert_int_equal(http_exchange(port, "GET", path, NULL, NULL, &after), 200);
    assert_string_equal(strchr(before, '{'), strchr(after, '{'));
    wait_for("harmed.db", "SELECT document FROM published", NULL, document);
    expect("harmed.db", "SELECT state FROM study_progress WHERE study = ?", study, "done");
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, PATIENCE_S), 0);
    assert_true(contains(server.err, "is damaged, and is made anew"));
    assert_int_equal(run_rugo("verify", (const char *[]){"verify", "--db", "harmed.db", NULL}), 0);
    free(before);
    free(after);
    free(document);
    free(study);
}

/* As an older program would leave it, whose scalars were others: the case is due, cannot be merged,
 * and stands before another that can. */
static void what_cannot_be_merged_is_marked(void **state) {
    (void)state;
    struct process server;
    char *older = NULL, *other = NULL;
    spit("one.json", ONE_CASE);
    assert_int_equal(run_rugo("older", (const char *[]){"run", "--db", "old.db", "one.json", NULL}),
                     0);
    sql_change(
        "old.db",
        "UPDATE scalar_names SET names = json_array('colour'); UPDATE result SET seal = NULL");
    assert_int_equal(run_rugo("other", (const char *[]){"run", "--db", "old.db", "--set", "seed=4",
                                                        "one.json", NULL}),
                     0);
    sql_change(
        "old.db",
        "DELETE FROM point_error; DELETE FROM scalar_error; DELETE FROM point; DELETE "
        "FROM curve; DELETE FROM scalar; DELETE FROM published; UPDATE study_case SET settled = 0");
    older = ask("old.db", "SELECT public FROM study WHERE id = 1", NULL);
    other = ask("old.db", "SELECT public FROM study WHERE id = 2", NULL);
    serve_start(&server, (const char *[]){"--db", "old.db", NULL});
    wait_for("old.db", "SELECT state FROM case_progress WHERE study = ?", other, "published");
    wait_for("old.db", "SELECT state FROM case_progress WHERE study = ?", older, "failed");
    expect("old.db",
           "SELECT error LIKE '%scalars%' FROM case_progress WHERE "
           "study = ?",
           older, "1");
    expect("old.db", "SELECT state FROM study_progress WHERE study = ?", older, "failed");
    check_idle(&server);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, PATIENCE_S), 0);
    assert_int_equal(run_rugo("again", (const char *[]){"run", "--db", "old.db", "one.json", NULL}),
                     1);
    assert_true(contains("again.err", "cases that cannot be published: 1"));
    assert_int_equal(run_rugo("status", (const char *[]){"status", "--db", "old.db", older, NULL}),
                     0);
    assert_true(contains("status.out", "not published: case 0:"));
    /* a retry gives up what cannot be merged, and has it computed anew */
    assert_int_equal(run_rugo("retry", (const char *[]){"retry", "--db", "old.db", older, NULL}),
                     0);
    expect("old.db", "SELECT state FROM case_progress WHERE study = ?", older, "open");
    assert_int_equal(run_rugo("again", (const char *[]){"run", "--db", "old.db", "one.json", NULL}),
                     0);
    expect("old.db", "SELECT state FROM case_progress WHERE study = ?", older, "published");
    free(older);
    free(other);
}

/* Two cases, of which the first one's blocks are given the scalars of an older program. */
static char *spoil_one_case(const char *database) {
    assert_int_equal(run_rugo("two", (const char *[]){"run", "--db", database, "--set",
                                                      "surface.hurst=[0.5,0.8]", "one.json", NULL}),
                     0);
    sql_change(
        database,
        "INSERT INTO scalar_names (names) VALUES (json_array('colour')); UPDATE result SET "
        "names_id = (SELECT max(id) FROM scalar_names), seal = NULL WHERE job_id IN (SELECT id "
        "FROM job "
        "WHERE case_number = 0); DELETE FROM published WHERE case_number = 0; UPDATE study_case "
        "SET settled = 0 WHERE number = 0");
    return ask(database, "SELECT public FROM study", NULL);
}

/* The document has both cases: the first one with its fault alone, the second one with results. */
static void check_told(unsigned port, const char *study, const char *what) {
    char request[120]; /* of HTTP/1.0: the body comes as a whole */
    int size = snprintf(request, sizeof request,
                        "GET /v1/studies/%s/%s HTTP/1.0\r\nHost: localhost\r\n\r\n", study, what);
    char *text = http_raw(port, request, (size_t)size);
    assert_non_null(strstr(text, " 200 OK\r\n"));
    cJSON *document = cJSON_Parse(strchr(text, '{'));
    const cJSON *cases = cJSON_GetObjectItem(document, "cases");
    assert_int_equal(cJSON_GetArraySize(cases), 2);
    const cJSON *first = cJSON_GetArrayItem(cases, 0), *second = cJSON_GetArrayItem(cases, 1);
    const char *error = cJSON_GetStringValue(cJSON_GetObjectItem(first, "error"));
    assert_non_null(error);
    assert_non_null(strstr(error, "case 0: "));
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(first, "curves")), 0);
    assert_null(cJSON_GetObjectItem(second, "error"));
    assert_true(cJSON_GetArraySize(cJSON_GetObjectItem(second, "curves")) > 3);
    cJSON_Delete(document);
    free(text);
}

static void check_told_in_csv(unsigned port, const char *study) {
    char request[200];
    int size = snprintf(request, sizeof request,
                        "GET /v1/studies/%s/curves HTTP/1.1\r\nHost: localhost\r\nAccept: "
                        "text/csv\r\nConnection: close\r\n\r\n",
                        study);
    char *answer = http_raw(port, request, (size_t)size);
    assert_non_null(strstr(answer, "HTTP/1.1 200"));
    assert_non_null(strstr(answer, "Rugo-Missing-Cases: 0\r\n"));
    assert_null(strstr(answer, "\n0,"));
    assert_non_null(strstr(answer, "\n1,"));
    free(answer);
}

/* One case that cannot be merged hides no other: curves and report name both, over HTTP and on the
 * command line, which says so where people see it. */
static void the_other_cases_are_answered(void **state) {
    (void)state;
    struct process server;
    char path[80], url[64], *text = NULL;
    spit("one.json", ONE_CASE);
    char *study = spoil_one_case("part.db");
    unsigned port = serve_start(&server, (const char *[]){"--db", "part.db", NULL});
    wait_for("part.db", "SELECT group_concat(state, ' ') FROM case_progress WHERE study = ?", study,
             "failed published");
    check_told(port, study, "curves");
    check_told(port, study, "report");
    check_told_in_csv(port, study);
    snprintf(path, sizeof path, "/v1/studies/%s/curves?case=0", study);
    assert_int_equal(http_exchange(port, "GET", path, NULL, NULL, &text), 422);
    assert_non_null(strstr(text, "case 0: "));
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    const char *const places[][2] = {{"--db", "part.db"}, {"--server", url}};
    for (int p = 0; p < 2; p++) {
        assert_int_equal(run_rugo("told", (const char *[]){"curves", places[p][0], places[p][1],
                                                           "--format", "csv", study, NULL}),
                         0);
        assert_true(contains("told.err", "rugo curves: no results: case 0: "));
        assert_true(contains("told.out", "\n1,"));
        assert_int_equal(
            run_rugo("told", (const char *[]){"report", places[p][0], places[p][1], study, NULL}),
            0);
        assert_true(contains("told.err", "rugo report: no results: case 0: "));
        assert_true(contains("told.out", "\nno results: case 0: "));
    }
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, PATIENCE_S), 0);
    assert_int_equal(
        run_rugo("rerun", (const char *[]){"run", "--db", "part.db", "--set",
                                           "surface.hurst=[0.5,0.8]", "one.json", NULL}),
        1);
    assert_true(contains("rerun.out", "\nno results: case 0: "));
    assert_true(contains("rerun.err", "cases that cannot be published: 1"));
    free(text);
    free(study);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_server_publishes_what_there_is),
        cmocka_unit_test(what_was_damaged_is_published_anew),
        cmocka_unit_test(what_cannot_be_merged_is_marked),
        cmocka_unit_test(the_other_cases_are_answered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
