/* Protects: a study is found by its id, the first digits of it, or its name, on a local store and
 * over HTTP alike; and commands that wait for it end as it does. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NAMED(name, seed)                                                                          \
    "{\"name\":\"" name "\",\"kind\":\"statistics\",\"seed\":" seed                                \
    ",\"realisations\":5,\"surface\":{\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":4}}"

static struct process server;
static unsigned port;
static char url[64];

static int start(void **state) {
    (void)state;
    spit("one.json", ONE_CASE);
    spit("rough.json", NAMED("rough and smooth: 100 %", "1"));
    spit("rough2.json", NAMED("rough and smooth: 100 %", "2"));
    spit("path.json", NAMED("a/b", "1"));
    port = serve_start(&server, NULL);
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    return 0;
}

static int stop(void **state) {
    (void)state;
    process_kill(&server, SIGTERM);
    return process_wait(&server, 15);
}

static void submit(const char *file, char id[17]) {
    assert_int_equal(run_rugo("submit", (const char *[]){"submit", "--server", url, file, NULL}),
                     0);
    char *text = slurp("submit.out");
    assert_int_equal(sscanf(text, "%16[0-9a-f]", id), 1);
    free(text);
}

static void work(void) {
    assert_int_equal(run_rugo("work", (const char *[]){"work", "--server", url, "--drain",
                                                       "--workers", "1", NULL}),
                     0);
}

/* Asks by what is given, near and far: both end with `status` and print `text`. */
static void check_both(const char *command, const char *given, int status, const char *text) {
    const char *const places[2][2] = {{"--db", "rugo.db"}, {"--server", url}};
    for (int p = 0; p < 2; p++) {
        int ended = run_rugo(
            "ask", (const char *[]){command, places[p][0], places[p][1], "--", given, NULL});
        if (ended != status || !(contains("ask.out", text) || contains("ask.err", text))) {
            char *told = slurp("ask.err");
            print_error("%s %s %s: %d %s\n", command, places[p][0], given, ended, told);
            free(told);
        }
        assert_int_equal(ended, status);
        assert_true(contains("ask.out", text) || contains("ask.err", text));
    }
}

static void a_study_has_several_names(void **state) {
    (void)state;
    static const char NAME[] = "rough and smooth: 100 %";
    char first[17], second[17], other[17], prefix[8];
    submit("rough.json", first);
    submit("one.json", other);
    check_both("status", NAME, 0, first);
    check_both("report", NAME, 0, "rough and smooth");
    check_both("curves", NAME, 0, first);
    check_both("status", first, 0, first);
    snprintf(prefix, sizeof prefix, "%.7s", other);
    check_both("status", prefix, 0, other);
    submit("rough2.json", second);
    check_both("status", NAME, 0, second);
    check_both("status", NAME, 0, "2 studies are named \"rough and smooth: 100 %\"; this is");
    check_both("curves", NAME, 0, second);
    check_both("status", first, 0, first);
    check_both("status", "nobody", 1, "there is no study \"nobody\"; rugo status lists");
    check_both("status", "oen", 1, "there is no study \"oen\" (did you mean one?)");
    check_both("status", "0123456789abcdef", 1, "there is no study");
    check_both("status", "", 2, "neither is empty");
}

/* The newest need not be the one that is meant: what cannot be had again is refused. */
static void none_of_several_is_lost(void **state) {
    (void)state;
    static const char NAME[] = "rough and smooth: 100 %";
    check_both("cancel", NAME, 2, "may be each of 2 studies");
    check_both("delete", NAME, 2, "may be each of 2 studies");
}

/* A name of hexadecimal digits may be the beginning of an id, of another study, too. */
static void a_name_goes_before_first_digits(void **state) {
    (void)state;
    char id[17], named[17], digit[2] = "", document[300];
    submit("one.json", id);
    digit[0] = id[0];
    snprintf(document, sizeof document, NAMED("%s", "3"), digit);
    spit("digit.json", document);
    submit("digit.json", named);
    check_both("status", digit, 0, named);
}

/* The longest name: 200 characters of 4 bytes, a mathematical lambda each. */
static void a_long_name_is_found(void **state) {
    (void)state;
    char id[17], name[801] = "", document[1200];
    for (int c = 0; c < 200; c++)
        snprintf(name + 4 * c, sizeof name - 4 * (size_t)c, "\xf0\x9d\x9c\x86");
    snprintf(document, sizeof document, NAMED("%s", "3"), name);
    spit("long.json", document);
    submit("long.json", id);
    check_both("status", name, 0, id);
}

static void over_http_too(void **state) {
    (void)state;
    char *answer;
    assert_int_equal(http_exchange(port, "GET", "/v1/studies/one/curves?quantity=summit_height_pdf",
                                   NULL, NULL, &answer),
                     200);
    free(answer);
    assert_int_equal(http_exchange(port, "GET", "/v1/studies/rough%20and%20smooth%3A%20100%20%25",
                                   NULL, NULL, &answer),
                     200);
    free(answer);
    assert_int_equal(http_exchange(port, "GET",
                                   "/v1/studies/rough%20and%20smooth%3A%20100%20%25?unique=true",
                                   NULL, NULL, &answer),
                     422);
    assert_non_null(strstr(answer, "may be each of 2 studies"));
    free(answer);
    assert_int_equal(http_exchange(port, "DELETE",
                                   "/v1/studies/rough%20and%20smooth%3A%20100%20%25", NULL, NULL,
                                   NULL),
                     422);
    assert_int_equal(http_exchange(port, "GET", "/v1/studies/one?unique=false", NULL, NULL, NULL),
                     422);
    assert_int_equal(http_exchange(port, "DELETE", "/v1/studies/nobody", NULL, NULL, NULL), 404);
}

/* A name with a slash is several segments of a path. */
static void a_name_that_is_no_segment(void **state) {
    (void)state;
    char id[17];
    static const struct {
        const char *method, *path;
    } ASKED[] = {{"GET", "/v1/studies/a%2Fb"},
                 {"DELETE", "/v1/studies/a%2fb"},
                 {"GET", "/v1/studies/one%2Freport"}, /* not the report of one */
                 {"GET", "/v1/%73tudies/one%2Freport"},
                 {"GET", "/v1/studies/a%2Fb/curves?case=0"}};
    submit("path.json", id);
    assert_int_equal(run_rugo("near", (const char *[]){"status", "--db", "rugo.db", "a/b", NULL}),
                     0);
    assert_int_equal(run_rugo("far", (const char *[]){"status", "--server", url, "a/b", NULL}), 2);
    assert_true(contains("far.err", "name its id"));
    for (size_t a = 0; a < sizeof ASKED / sizeof *ASKED; a++) {
        char *answer = NULL;
        assert_int_equal(http_exchange(port, ASKED[a].method, ASKED[a].path, NULL, NULL, &answer),
                         404);
        assert_non_null(strstr(answer, "by a name with a /; name its id"));
        free(answer);
    }
    /* Of what comes behind the path it means nothing. */
    assert_int_equal(
        http_exchange(port, "GET", "/v1/studies/one/table?columns=%2F", NULL, NULL, NULL), 422);
}

static void waiting_ends_as_the_study_does(void **state) {
    (void)state;
    char id[17];
    struct process waiting, watching;
    submit("one.json", id);
    assert_int_equal(
        run_rugo("short", (const char *[]){"wait", "--server", url, "--timeout", "1", id, NULL}),
        1);
    assert_true(contains("short.err", "has not ended within 1 s"));
    process_start(&waiting, "waiting", (const char *[]){"wait", "--server", url, id, NULL});
    process_start(&watching, "watching",
                  (const char *[]){"status", "--watch", "--db", "rugo.db", id, NULL});
    wait_for_text("watching.out", "queued");
    work();
    assert_int_equal(process_wait(&waiting, 120), 0);
    assert_true(contains("waiting.out", "done"));
    assert_int_equal(process_wait(&watching, 120), 0);
    assert_true(contains("watching.out", "realisations 5 of 5"));
    submit("one.json", id);
    process_start(&waiting, "waiting", (const char *[]){"wait", "--db", "rugo.db", id, NULL});
    assert_int_equal(run_rugo("cancel", (const char *[]){"cancel", "--server", url, id, NULL}), 0);
    assert_int_equal(process_wait(&waiting, 120), 1);
    assert_true(contains("waiting.err", "is cancelled"));
}

/* 130, as all commands end that are interrupted; of all studies there is no end to wait for. */
static void watching_is_interrupted(void **state) {
    (void)state;
    char id[17];
    struct process watching;
    submit("one.json", id);
    for (int one = 0; one < 2; one++) {
        process_start(
            &watching, "watching",
            (const char *[]){"status", "--watch", "--server", url, one != 0 ? id : NULL, NULL});
        wait_for_text("watching.out", "queued");
        process_kill(&watching, SIGTERM);
        assert_int_equal(process_wait(&watching, 20), one != 0 ? 130 : 0);
    }
    assert_int_equal(run_rugo("cancel", (const char *[]){"cancel", "--server", url, id, NULL}), 0);
}

/* The first loads are far above what the model reaches: each realisation leaves a note, and no
 * value.
 */
static void a_study_without_a_value_is_no_success(void **state) {
    (void)state;
    spit(
        "steep.json",
        "{\"name\":\"steep\",\"kind\":\"contact\",\"seed\":1,\"realisations\":2,\"surface\":{"
        "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":8,\"length_ratio\":2,\"rms_slope\":1.9,"
        "\"points_per_wavelength\":8},\"contact\":{\"model\":[\"full\"],\"levels\":[8],"
        "\"pressures\":{\"values\":[4,6]}}}");
    assert_int_equal(
        run_rugo("steep", (const char *[]){"run", "--db", "rugo.db", "steep.json", NULL}), 1);
    assert_true(contains("steep.out", "(0 of 2)"));
    assert_true(contains("steep.err", "no realisation has a value: model full"));
    check_both("wait", "steep", 1, "no realisation has a value");
    check_both("status", "steep", 0, "no realisation has a value in 1 of 1 cases: model full");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_study_has_several_names),
        cmocka_unit_test(none_of_several_is_lost),
        cmocka_unit_test(a_long_name_is_found),
        cmocka_unit_test(over_http_too),
        cmocka_unit_test(a_name_goes_before_first_digits),
        cmocka_unit_test(a_name_that_is_no_segment),
        cmocka_unit_test(waiting_ends_as_the_study_does),
        cmocka_unit_test(watching_is_interrupted),
        cmocka_unit_test(a_study_without_a_value_is_no_success),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
