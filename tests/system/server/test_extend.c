/* Protects: more realisations of a study compute only what is missing, and its curves are those of
 * one study of that number, byte for byte, of every kind, whether it is extended or submitted anew.
 */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include "tests/support/sql.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define SURFACE                                                                                    \
    "\"surface\":{\"dimension\":1,\"hurst\":[0.3,0.8],\"wavelength_ratio\":4,\"length_ratio\":2,"  \
    "\"points_per_wavelength\":8}"

/* Numbers below the first interval of side experiments, and across it. */
static const struct {
    const char *name, *first, *then, *study;
} STUDIES[] = {
    {"statistics", "realisations=7", "realisations=19",
     "{\"name\":\"s\",\"kind\":\"statistics\",\"seed\":4,\"realisations\":1," SURFACE
     ",\"statistics\":{\"bins\":{\"height\":[-4,8,24],\"curvature\":[-16,0,16]}}}"},
    {"contact", "realisations=5", "realisations=37",
     "{\"name\":\"c\",\"kind\":\"contact\",\"seed\":4,\"realisations\":1," SURFACE ",\"contact\":{"
     "\"pressures\":{\"values\":[0.02,0.1]},\"model\":[\"halfspace\",\"layered\"]}}"},
    {"own", "realisations=6", "realisations=9",
     "{\"name\":\"o\",\"kind\":\"contact\",\"seed\":4,\"realisations\":1,\"random\":"
     "\"independent\"," SURFACE
     ",\"contact\":{\"cell_error\":\"none\",\"pressures\":{\"values\":[0.02,0.1]}}}"},
};
enum { STUDY_COUNT = sizeof STUDIES / sizeof *STUDIES };

/* What a command prints, less the line's end. */
static void submit(const char *database, const char *set, char id[17]) {
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--db", database, "--set", set, "--set",
                                            "/name=other", "study.json", NULL}),
        0);
    char *text = slurp("submit.out");
    assert_int_equal(sscanf(text, "%16[0-9a-f]", id), 1);
    free(text);
}

static void work(const char *database) {
    assert_int_equal(run_rugo("work", (const char *[]){"work", "--db", database, "--drain",
                                                       "--workers", "1", NULL}),
                     0);
}

/* Curves without what names the study; the caller frees. */
static char *curves_of(const char *database, const char *id) {
    assert_int_equal(run_rugo("curves", (const char *[]){"curves", "--db", database, id, NULL}), 0);
    char *text = slurp("curves.out"), *cases = strstr(text, "\"cases\":");
    assert_non_null(cases);
    memmove(text, cases, strlen(cases) + 1);
    return text;
}

/* Of one study of the larger number, undisturbed. */
static char *expected_of(size_t s) {
    char database[64], id[17];
    snprintf(database, sizeof database, "whole-%s.db", STUDIES[s].name);
    spit("study.json", STUDIES[s].study);
    submit(database, STUDIES[s].then, id);
    work(database);
    return curves_of(database, id);
}

static void an_extended_study_is_one_of_that_number(void **state) {
    (void)state;
    for (size_t s = 0; s < STUDY_COUNT; s++) {
        char database[64], id[17], *expected = expected_of(s);
        const char *more = strchr(STUDIES[s].then, '=') + 1;
        snprintf(database, sizeof database, "extended-%s.db", STUDIES[s].name);
        submit(database, STUDIES[s].first, id);
        work(database);
        long jobs = sql_integer(database, "SELECT count(*) FROM job_log");
        assert_int_equal(run_rugo("extend", (const char *[]){"extend", "--db", database, id,
                                                             "--realisations", more, NULL}),
                         0);
        assert_true(contains("extend.out", "queued"));
        assert_int_equal(
            sql_integer(database, "SELECT min(first) FROM job_log WHERE state = 'waiting'"),
            atoi(strchr(STUDIES[s].first, '=') + 1));
        work(database);
        /* none of those that were there ran again */
        assert_true(jobs > 0);
        assert_int_equal(sql_integer(database, "SELECT max(attempts) FROM job_log"), 1);
        assert_int_equal(sql_integer(database, "SELECT sum(count) FROM job_log"), 2 * atoi(more));
        char *curves = curves_of(database, id);
        assert_string_equal(curves, expected);
        free(curves);
        free(expected);
    }
}

static void a_study_submitted_with_more_takes_what_is_there(void **state) {
    (void)state;
    for (size_t s = 0; s < STUDY_COUNT; s++) {
        char database[64], id[17], other[17], *expected = expected_of(s);
        int had = atoi(strchr(STUDIES[s].first, '=') + 1);
        snprintf(database, sizeof database, "again-%s.db", STUDIES[s].name);
        submit(database, STUDIES[s].first, other);
        assert_false(contains("submit.err", "were there already"));
        work(database);
        submit(database, "seed=5", id); /* another seed: nothing is taken */
        assert_false(contains("submit.err", "were there already"));
        submit(database, STUDIES[s].then, id);
        assert_true(contains("submit.err", "were there already"));
        char sql[200];
        snprintf(sql, sizeof sql,
                 "SELECT min(first) FROM job_log WHERE state = 'waiting' AND study = '%s'", id);
        assert_int_equal(sql_integer(database, sql), had);
        work(database);
        char *curves = curves_of(database, id);
        assert_string_equal(curves, expected);
        free(curves);
        free(expected);
    }
}

static int extend(const char *database, const char *id, const char *realisations) {
    return run_rugo("extend", (const char *[]){"extend", "--db", database, id, "--realisations",
                                               realisations, NULL});
}

static void what_cannot_be_extended_is_told(void **state) {
    (void)state;
    char id[17];
    spit("study.json", STUDIES[0].study);
    submit("told.db", "realisations=5", id);
    assert_int_equal(extend("told.db", id, "4"), 1);
    assert_true(contains("extend.err", "has 5 realisations of each case, which 4 would not"));
    assert_int_equal(extend("told.db", id, "5"), 0); /* nothing to do: a lost answer is no fault */
    assert_int_equal(sql_integer("told.db", "SELECT sum(count) FROM job_log"), 10);
    assert_int_equal(extend("told.db", "0123456789abcdef", "9"), 1);
    assert_true(contains("extend.err", "there is no study"));
    assert_int_equal(run_rugo("extend", (const char *[]){"extend", "--db", "told.db", id, NULL}),
                     2);
    assert_true(contains("extend.err", "--realisations N is missing"));
    spit("study.json",
         "{\"name\":\"t\",\"kind\":\"contact\",\"target\":{\"error\":0.05}," SURFACE "}");
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--db", "target.db", "study.json", NULL}), 0);
    char *text = slurp("submit.out");
    assert_int_equal(sscanf(text, "%16[0-9a-f]", id), 1);
    free(text);
    assert_int_equal(extend("target.db", id, "9"), 2);
    assert_true(contains("extend.err", "submit it anew with a smaller error"));
}

/* Cancelled while it runs, extended over HTTP, and worked on to the end. */
static void extended_over_http(void **state) {
    (void)state;
    struct process server;
    char id[17], path[96], url[64], *answer;
    unsigned port = serve_start(&server, NULL);
    const char json[] = "Content-Type: application/json\r\n";
    assert_int_equal(http_exchange(port, "POST", "/v1/studies", json, ONE_CASE, &answer), 201);
    assert_int_equal(sscanf(answer, "{\"id\":\"%16[0-9a-f]\"", id), 1);
    free(answer);
    snprintf(path, sizeof path, "/v1/studies/%s", id);
    assert_int_equal(http_exchange(port, "DELETE", path, NULL, NULL, NULL), 200);
    snprintf(path, sizeof path, "/v1/studies/%s/extend", id);
    static const struct {
        const char *body;
        int status;
        const char *text;
    } ASKED[] = {{NULL, 400, "a JSON body"},
                 {"{\"realisations\":2.5}", 422, "2.5 is not an integer in [1, 10000000]"},
                 {"{\"realisations\":\"2\"}", 422, "is not an integer in [1, 10000000]"},
                 {"{\"realisations\":0}", 422, "0 is not an integer in [1, 10000000]"},
                 {"{\"realisations\":10000001}", 422, "10000001 is not an integer in"},
                 {"{}", 422, "missing: an integer in [1, 10000000]"},
                 {"{\"realisations\":3}", 409, "would not extend"},
                 {"{\"realisations\":8}", 200, "\"queued\":2"},
                 {"{\"realisations\":8}", 200, "\"queued\":0"}};
    for (size_t a = 0; a < sizeof ASKED / sizeof *ASKED; a++) {
        int status = http_exchange(port, "POST", path, ASKED[a].body != NULL ? json : NULL,
                                   ASKED[a].body, &answer);
        if (status != ASKED[a].status || strstr(answer, ASKED[a].text) == NULL)
            fail_msg("%s: %d %s", ASKED[a].body, status, answer);
        free(answer);
    }
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    assert_int_equal(run_rugo("work", (const char *[]){"work", "--server", url, "--drain",
                                                       "--workers", "1", NULL}),
                     0);
    snprintf(path, sizeof path, "/v1/studies/%s", id);
    bool done = false;
    for (int tries = 0; !done; tries++, sleep_ms(20)) {
        assert_true(tries < 3000);
        assert_int_equal(http_exchange(port, "GET", path, NULL, NULL, &answer), 200);
        done = strstr(answer, "\"state\":\"done\"") != NULL &&
               strstr(answer, "\"realisations\":{\"total\":8,\"done\":8,") != NULL;
        free(answer);
    }
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 15), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_extended_study_is_one_of_that_number),
        cmocka_unit_test(a_study_submitted_with_more_takes_what_is_there),
        cmocka_unit_test(what_cannot_be_extended_is_told),
        cmocka_unit_test(extended_over_http),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
