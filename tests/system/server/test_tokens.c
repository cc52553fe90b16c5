/* Protects: what each role of a token may do, that beyond this machine there is no service without
 * tokens, and that server and clients read the same files of them. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define JSON "Content-Type: application/json\r\n"

static void roles_bound_what_a_token_may_do(void **state) {
    (void)state;
    struct process other = {0};
    spit("tokens",
         "# for the "
         "test\nread:read-token-000000\nsubmit:submit-token-0000\nwork:work-token-000000\n");
    unsigned port =
        serve_start(&other, (const char *[]){"--db", "tokens.db", "--token-file", "tokens", NULL});
    static const struct {
        const char *method, *path, *token;
        int status;
    } ASKED[] = {
        {"GET", "/v1/studies", NULL, 401},
        {"GET", "/v1/studies", "wrong-token-000000", 401},
        {"GET", "/v1/studies", "read-token-000000", 200},
        {"GET", "/v1/studies", "work-token-000000", 200},
        {"POST", "/v1/studies", "read-token-000000", 403},
        {"POST", "/v1/studies", "work-token-000000", 403},
        {"POST", "/v1/studies", "submit-token-0000", 201},
        {"POST", "/v1/jobs/claim", "submit-token-0000", 403},
        {"POST", "/v1/jobs/claim", "work-token-000000", 200},
        {"GET", "/healthz", NULL, 200},
        {"GET", "/metrics", NULL, 401},
    };
    for (size_t a = 0; a < sizeof ASKED / sizeof *ASKED; a++) {
        char headers[160] = JSON;
        if (ASKED[a].token)
            snprintf(headers, sizeof headers, JSON "Authorization: Bearer %s\r\n", ASKED[a].token);
        bool claim = strstr(ASKED[a].path, "claim") != NULL, post = *ASKED[a].method == 'P';
        const char *body = claim ? "{\"worker\":\"w\"}" : post ? ONE_CASE : NULL;
        int status = http_exchange(port, ASKED[a].method, ASKED[a].path, headers, body, NULL);
        if (status != ASKED[a].status)
            print_error("%s %s with %s: %d\n", ASKED[a].method, ASKED[a].path,
                        ASKED[a].token ? ASKED[a].token : "no token", status);
        assert_int_equal(status, ASKED[a].status);
    }
    process_kill(&other, SIGTERM);
    assert_int_equal(process_wait(&other, 15), 0);
    assert_false(contains(other.err, "token-0000"));
}

static void beyond_loopback_tokens_are_needed(void **state) {
    (void)state;
    assert_int_equal(run_rugo("open", (const char *[]){"serve", "--db", "open.db", "--listen",
                                                       "0.0.0.0:0", NULL}),
                     2);
    assert_true(contains("open.err", "tokens are needed"));
    spit("bad-tokens", "boss:0123456789abcdef\n");
    assert_int_equal(run_rugo("bad", (const char *[]){"serve", "--db", "open.db", "--token-file",
                                                      "bad-tokens", NULL}),
                     2);
    assert_true(contains("bad.err", "bad-tokens, line 1"));
}

/* One file for the server and for all who ask it; or one with a single token and no role. */
static void one_file_for_both_ends(void **state) {
    (void)state;
    static const char *const FILES[] = {
        "# ours\nread:read-token-000000\r\n\nsubmit:submit-token-0000\nwork:work-token-000000\n",
        "only-token-0000000\n"};
    spit("one.json", ONE_CASE);
    for (size_t f = 0; f < 2; f++) {
        struct process other = {0};
        char url[64], database[16];
        spit("both", FILES[f]);
        snprintf(database, sizeof database, "both%zu.db", f);
        unsigned port =
            serve_start(&other, (const char *[]){"--db", database, "--token-file", "both", NULL});
        snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
        static const char *const COMMANDS[][4] = {
            {"submit", "one.json", NULL}, {"work", "--drain", NULL}, {"wait", "one", NULL}};
        for (size_t c = 0; c < 3; c++)
            assert_int_equal(
                run_rugo("both", (const char *[]){COMMANDS[c][0], "--server", url, "--token-file",
                                                  "both", COMMANDS[c][1], NULL}),
                0);
        assert_int_equal(run_rugo("none", (const char *[]){"status", "--server", url, NULL}), 2);
        assert_true(contains("none.err", "token"));
        process_kill(&other, SIGTERM);
        assert_int_equal(process_wait(&other, 15), 0);
    }
    spit("empty", "# nothing\n");
    assert_int_equal(run_rugo("none", (const char *[]){"status", "--server", "http://127.0.0.1:1",
                                                       "--token-file", "empty", NULL}),
                     2);
    assert_true(contains("none.err", "empty holds no token"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roles_bound_what_a_token_may_do),
        cmocka_unit_test(beyond_loopback_tokens_are_needed),
        cmocka_unit_test(one_file_for_both_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
