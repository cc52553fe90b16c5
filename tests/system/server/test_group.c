/* Protects: a group on one server: studies are of the name of the token that submitted them, their
 * owners take turns at the workers, and none but the owner or an admin changes a study. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define JSON "Content-Type: application/json\r\n"

static struct process server;
static unsigned port;

static int start(void **state) {
    (void)state;
    spit_secret("tokens",
                "submit:anna:anna-token-00000\nsubmit:bert:bert-token-00000\n"
                "submit:nameless-token-0\nwork:work-token-000000\nadmin:root:admin-token-0000\n"
                "read:carl:carl-token-00000\n");
    port =
        serve_start(&server, (const char *[]){"--token-file", "tokens", "--share", "carl=2", NULL});
    return 0;
}

static int stop(void **state) {
    (void)state;
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 15), 0);
    return 0;
}

static int ask(const char *token, const char *method, const char *path, const char *body,
               char **answer) {
    char headers[160];
    snprintf(headers, sizeof headers, "%sAuthorization: Bearer %s\r\n", body != NULL ? JSON : "",
             token);
    return http_exchange(port, method, path, headers, body, answer);
}

/* SEVERAL_BLOCKS with a seed of its own. */
static void submit(const char *token, int seed, char id[17]) {
    char text[sizeof SEVERAL_BLOCKS + 20], *answer;
    const char *rest = strstr(SEVERAL_BLOCKS, "\"seed\":7");
    assert_non_null(rest);
    snprintf(text, sizeof text, "%.*s\"seed\":%d%s", (int)(rest - SEVERAL_BLOCKS), SEVERAL_BLOCKS,
             seed, rest + strlen("\"seed\":7"));
    assert_int_equal(ask(token, "POST", "/v1/studies", text, &answer), 201);
    assert_int_equal(sscanf(answer, "{\"id\":\"%16[0-9a-f]\"", id), 1);
    free(answer);
}

static void check_answer(const char *token, const char *method, const char *id, const char *rest,
                         int status, const char *text) {
    char path[128], *answer;
    snprintf(path, sizeof path, "/v1/studies/%s%s", id, rest);
    const char *body = strstr(rest, "extend") != NULL ? "{\"realisations\":6001}" : NULL;
    int got = ask(token, method, path, body, &answer);
    if (got != status || strstr(answer, text) == NULL)
        fail_msg("%s %s of %s: %d %s", method, path, token, got, answer);
    free(answer);
}

/* Claims a job, which goes on running; the study. */
static void claim(char id[17]) {
    char *answer;
    assert_int_equal(ask("work-token-000000", "POST", "/v1/jobs/claim",
                         "{\"worker\":\"w\",\"sequence\":true}", &answer),
                     200);
    const char *study = strstr(answer, "\"study\":\"");
    assert_non_null(study);
    assert_int_equal(sscanf(study, "\"study\":\"%16[0-9a-f]\"", id), 1);
    free(answer);
}

static void owners_take_turns_and_keep_their_own(void **state) {
    (void)state;
    char anna[17], second[17], bert[17], nobody[17], got[17];
    submit("anna-token-00000", 1, anna);
    submit("anna-token-00000", 2, second);
    claim(got);
    assert_string_equal(got, anna);
    submit("bert-token-00000", 3, bert);
    check_answer("carl-token-00000", "GET", bert, "", 200, "\"owner\":\"bert\",\"priority\":0,");
    check_answer("carl-token-00000", "GET", bert, "", 200, "\"place\":1,\"starts_in\":");
    check_answer("carl-token-00000", "GET", second, "", 200, "\"place\":2,\"starts_in\":");
    check_answer("carl-token-00000", "GET", anna, "", 200, "\"place\":null,\"starts_in\":null,");
    claim(got); /* behind a study that has begun, and before one that came first */
    assert_string_equal(got, bert);
    claim(got);
    assert_string_equal(got, anna);

    static const struct {
        const char *method, *rest;
    } CHANGES[] = {
        {"DELETE", ""}, {"DELETE", "?results=true"}, {"POST", "/retry"}, {"POST", "/extend"}};
    static const char *const OTHERS[] = {"bert-token-00000", "nameless-token-0"};
    for (size_t c = 0; c < sizeof CHANGES / sizeof *CHANGES; c++) {
        for (size_t o = 0; o < 2; o++)
            check_answer(OTHERS[o], CHANGES[c].method, anna, CHANGES[c].rest, 403,
                         "is of anna, who may change it");
        check_answer("carl-token-00000", CHANGES[c].method, anna, CHANGES[c].rest, 403,
                     "role, read, does not allow this");
    }
    check_answer("anna-token-00000", "POST", anna, "/extend", 200, "\"queued\":2");
    check_answer("anna-token-00000", "DELETE", anna, "", 200, "\"state\":\"cancelled\"");
    check_answer("admin-token-0000", "DELETE", second, "", 200, "\"state\":\"cancelled\"");
    check_answer("admin-token-0000", "DELETE", second, "?results=true", 200, "deleted");
    /* what is of nobody is anybody's who may submit */
    submit("nameless-token-0", 4, nobody);
    check_answer("carl-token-00000", "GET", nobody, "", 200, "\"owner\":null");
    check_answer("bert-token-00000", "DELETE", nobody, "", 200, "\"state\":\"cancelled\"");
    assert_int_equal(ask("admin-token-0000", "POST", "/v1/jobs/claim", "{\"worker\":\"w\"}", NULL),
                     403);
}

/* The commands show it, and read the same file of tokens. */
static void commands_tell_the_line(void **state) {
    (void)state;
    char url[64];
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    spit_secret("mine", "submit:anna:anna-token-00000\n");
    spit("blocks.json", SEVERAL_BLOCKS);
    assert_int_equal(run_rugo("submit", (const char *[]){"submit", "--server", url, "--token-file",
                                                         "mine", "--set", "priority=5", "--set",
                                                         "/name=queued", "blocks.json", NULL}),
                     0);
    assert_int_equal(run_rugo("status", (const char *[]){"status", "--server", url, "--token-file",
                                                         "mine", "queued", NULL}),
                     0);
    assert_true(contains("status.out", "position 1 in line, "));
    assert_int_equal(run_rugo("status", (const char *[]){"status", "--server", url, "--token-file",
                                                         "mine", NULL}),
                     0);
    assert_true(contains("status.out", "anna"));
    assert_int_equal(run_rugo("priority", (const char *[]){"check", "--set", "priority=101",
                                                           "blocks.json", NULL}),
                     2);
    assert_true(contains("priority.err", "/priority: 101 is not in [-100, 100]"));
}

static void wrong_names_and_shares_are_told(void **state) {
    (void)state;
    static const struct {
        const char *line, *share, *text;
    } WRONG[] = {
        {"submit:a b:0123456789abcdef\n", "a=1", "line 1: in role:name:token, a name has 1 to 40"},
        {"submit:anna:short\n", "a=1", "a token of less than 16 characters"},
        {"submit:anna:0123456789abcdef\n", "anna", "--share anna is not NAME=WEIGHT"},
        {"submit:anna:0123456789abcdef\n", "a b=2",
         "--share a b=2 is not NAME=WEIGHT, where a name"},
        {"submit:anna:0123456789abcdef\n", "=2", "--share =2 is not NAME=WEIGHT"},
        {"submit:anna:0123456789abcdef\n", "anna=", "--share anna= is not NAME=WEIGHT"},
        {"submit:anna:0123456789abcdef\n", "anna= 2", "--share anna= 2 is not NAME=WEIGHT"},
        {"submit:anna:0123456789abcdef\n", "anna=0x2", "--share anna=0x2 is not NAME=WEIGHT"},
        {"submit:anna:0123456789abcdef\n", "anna=1e999", "a weight is above 0, finite"},
        {"submit:anna:0123456789abcdef\n", "anna=-1", "a weight is above 0, finite"}};
    for (size_t w = 0; w < sizeof WRONG / sizeof *WRONG; w++) {
        spit_secret("bad", WRONG[w].line);
        assert_int_equal(run_rugo("bad", (const char *[]){"serve", "--db", "bad.db", "--listen",
                                                          "127.0.0.1:0", "--token-file", "bad",
                                                          "--share", WRONG[w].share, NULL}),
                         2);
        if (!contains("bad.err", WRONG[w].text))
            fail_msg("%s: not \"%s\"", WRONG[w].line, WRONG[w].text);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(owners_take_turns_and_keep_their_own),
        cmocka_unit_test(commands_tell_the_line),
        cmocka_unit_test(wrong_names_and_shares_are_told),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
