/* A kind of study is one file: a third one, which stands in tests/support alone, goes through the
 * whole program. This program is the test and, with arguments, rugo with that kind in its table. */
#define main program_main
#include "server/command/main.c" // NOLINT(bugprone-suspicious-include)
#undef main
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/third_kind.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define LIST(KIND) KIND(STATISTICS_KIND) KIND(CONTACT_KIND) KIND(NEEDLE_KIND)
JOB_KIND_TABLE(LIST)

static const char STUDY[] =
    "{\"name\":\"buffon\",\"kind\":\"needle\",\"seed\":4,\"realisations\":8,\"needle\":{"
    "\"throws\":[1000,4000]}}";

static int setup(void **state) {
    (void)state;
    spit("needle.json", STUDY);
    assert_int_equal(run_rugo("run", (const char *const[]){"run", "needle.json", "--db", "a.db",
                                                           "--out", "out", "--workers", "2", NULL}),
                     0);
    return 0;
}

/* The id of the one study of a store, from its list. */
static const char *study_of(const char *place, const char *where) {
    static char id[40];
    assert_int_equal(
        run_rugo("list", (const char *const[]){"status", place, where, "--format", "json", NULL}),
        0);
    char *list = slurp("list.out");
    const char *at = strstr(list, "\"id\":\"");
    assert_non_null(at);
    assert_int_equal(sscanf(at, "\"id\":\"%39[^\"]", id), 1);
    free(list);
    return id;
}

/* Checked, run, printed as a table, and as JSON, CSV and pictures. */
static void is_run_and_shown(void **state) {
    (void)state;
    assert_true(contains("run.out", "pi"));
    assert_true(contains("run.out", "3.14"));
    assert_int_equal(run_rugo("check", (const char *const[]){"check", "needle.json", NULL}), 0);
    assert_true(contains("check.out", "buffon"));
    assert_int_equal(run_rugo("bad", (const char *const[]){"check", "needle.json", "--set",
                                                           "/needle/throws=0", NULL}),
                     2);
    assert_true(contains("bad.err", "/needle/throws"));
    assert_int_equal(run_rugo("schema", (const char *const[]){"check", "--schema", NULL}), 0);
    assert_true(contains("schema.out", "needles a realisation"));
    assert_true(contains("schema.out", "\"maximum\": 9007199254740992\n"));
    assert_true(contains("out/curves.json", "\"crossings\""));
    assert_true(contains("out/curves.csv", "buffon"));
    assert_true(contains("out/crossings.svg", "</svg>"));
}

/* Curves and report of the store; the theory holds within four standard errors. */
static void is_read_back(void **state) {
    (void)state;
    const char *id = study_of("--db", "a.db");
    assert_int_equal(run_rugo("curves", (const char *const[]){"curves", id, "--db", "a.db", NULL}),
                     0);
    char *text = slurp("curves.out");
    cJSON *document = cJSON_Parse(text);
    free(text);
    const cJSON *cases = cJSON_GetObjectItem(document, "cases");
    assert_int_equal(cJSON_GetArraySize(cases), 2);
    const cJSON *one;
    cJSON_ArrayForEach(one, cases) {
        const cJSON *curve = cJSON_GetArrayItem(cJSON_GetObjectItem(one, "curves"), 0);
        for (int k = 0; k < LENGTHS; k++) {
            double y = cJSON_GetArrayItem(cJSON_GetObjectItem(curve, "y"), k)->valuedouble;
            double error =
                cJSON_GetArrayItem(cJSON_GetObjectItem(curve, "standard_error"), k)->valuedouble;
            assert_true(error > 0 && fabs(y - 0.2 * (k + 1) / M_PI) < 4 * error);
        }
    }
    cJSON_Delete(document);
    assert_int_equal(run_rugo("csv", (const char *const[]){"curves", id, "--db", "a.db", "--format",
                                                           "csv", NULL}),
                     0);
    assert_true(contains("csv.out", "crossings"));
    assert_int_equal(run_rugo("report", (const char *const[]){"report", id, "--db", "a.db", NULL}),
                     0);
    assert_true(contains("report.out", "s to halve"));
}

/* The same study by a server and a worker elsewhere: the same curves. */
static void is_served(void **state) {
    (void)state;
    struct process server, worker;
    char url[40], id[40];
    unsigned port = serve_start(&server, (const char *const[]){"--db", "b.db", NULL});
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    assert_int_equal(
        run_rugo("submit", (const char *const[]){"submit", "needle.json", "--server", url, NULL}),
        0);
    process_start(
        &worker, "work",
        (const char *const[]){"work", "--server", url, "--workers", "2", "--drain", NULL});
    assert_int_equal(process_wait(&worker, 200), 0);
    snprintf(id, sizeof id, "%s", study_of("--server", url));
    assert_int_equal(run_rugo("served", (const char *const[]){"curves", id, "--server", url, NULL}),
                     0);
    const char *local = study_of("--db", "a.db");
    assert_int_equal(
        run_rugo("local", (const char *const[]){"curves", local, "--db", "a.db", NULL}), 0);
    char *served = slurp("served.out"), *ours = slurp("local.out");
    const char *cases = strstr(served, "\"cases\"");
    assert_non_null(cases);
    assert_string_equal(cases, strstr(ours, "\"cases\""));
    free(served);
    free(ours);
    process_kill(&server, SIGTERM);
    process_wait(&server, 20);
}

int main(int argc, char **argv) {
    static char self[4096];
    if (argc > 1)
        return program_main(argc, argv);
    if (readlink("/proc/self/exe", self, sizeof self - 1) < 0 || setenv("RUGO", self, 1) != 0)
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_run_and_shown),
        cmocka_unit_test(is_read_back),
        cmocka_unit_test(is_served),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
