/* Protects: what each role of a token may do, and that beyond this machine there is no service
 * without tokens. Server and clients read the same files of tokens, which nobody else may read, and
 * a token is revoked at once. */
#include "server/http/guard/tokens.h"
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include "worker/clock.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#define JSON "Content-Type: application/json\r\n"

static void roles_bound_what_a_token_may_do(void **state) {
    (void)state;
    struct process other = {0};
    spit_secret("tokens",
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

static int submit_with(unsigned port, const char *token, const char *body, char id[17]) {
    char headers[160], *answer;
    snprintf(headers, sizeof headers,
             JSON "Idempotency-Key: monday\r\nAuthorization: Bearer %s\r\n", token);
    int status = http_exchange(port, "POST", "/v1/studies", headers, body, &answer);
    sscanf(answer, "{\"id\":\"%16[0-9a-f]", id);
    free(answer);
    return status;
}

/* The key of one owner is no other's, who would get a study that is not his. */
static void keys_belong_to_their_owner(void **state) {
    (void)state;
    static const char ANNA[] = "anna-token-00000", BERT[] = "bert-token-00000";
    struct process other = {0};
    char first[17] = "", again[17] = "", others[17] = "";
    spit_secret("owners", "submit:anna:anna-token-00000\nsubmit:bert:bert-token-00000\n");
    unsigned port =
        serve_start(&other, (const char *[]){"--db", "owners.db", "--token-file", "owners", NULL});
    assert_int_equal(submit_with(port, ANNA, ONE_CASE, first), 201);
    assert_int_equal(submit_with(port, BERT, ONE_CASE, others), 201);
    assert_string_not_equal(first, others);
    assert_int_equal(submit_with(port, ANNA, ONE_CASE, again), 200);
    assert_string_equal(first, again);
    assert_int_equal(submit_with(port, BERT, ONE_CASE, again), 200);
    assert_string_equal(others, again);
    assert_int_equal(submit_with(port, BERT, SEVERAL_BLOCKS, again), 409);
    process_kill(&other, SIGTERM);
    assert_int_equal(process_wait(&other, 15), 0);
}

static void beyond_loopback_tokens_are_needed(void **state) {
    (void)state;
    assert_int_equal(run_rugo("open", (const char *[]){"serve", "--db", "open.db", "--listen",
                                                       "0.0.0.0:0", NULL}),
                     2);
    assert_true(contains("open.err", "tokens are needed"));
    spit_secret("bad-tokens", "boss:0123456789abcdef\n");
    assert_int_equal(run_rugo("bad", (const char *[]){"serve", "--db", "open.db", "--token-file",
                                                      "bad-tokens", NULL}),
                     2);
    assert_true(contains("bad.err", "bad-tokens, line 1"));
}

/* One file for the server and for all who ask it; or one with a single token and no role. Both
 * begin with a byte-order mark, as editors write it. */
static void one_file_for_both_ends(void **state) {
    (void)state;
    static const char *const FILES[] = {
        "\xef\xbb\xbf# "
        "ours\nread:read-token-000000\r\n\nsubmit:submit-token-0000\nwork:work-token-000000\n",
        "\xef\xbb\xbfonly-token-0000000\n"};
    spit("one.json", ONE_CASE);
    for (size_t f = 0; f < 2; f++) {
        struct process other = {0};
        char url[64], database[16];
        spit_secret("both", FILES[f]);
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
    spit_secret("empty", "# nothing\n");
    assert_int_equal(run_rugo("none", (const char *[]){"status", "--server", "http://127.0.0.1:1",
                                                       "--token-file", "empty", NULL}),
                     2);
    assert_true(contains("none.err", "empty holds no token"));
}

/* A token in clear text is for this machine alone, unless --insecure says otherwise. */
static void beyond_loopback_tokens_need_tls(void **state) {
    (void)state;
    spit_secret("tokens", "read:read-token-000000\n");
    assert_int_equal(
        run_rugo("clear", (const char *[]){"serve", "--db", "open.db", "--listen", "0.0.0.0:0",
                                           "--token-file", "tokens", NULL}),
        2);
    assert_true(contains("clear.err", "--tls-cert"));
    /* by name or address, these are other machines (RFC 5737, 3; RFC 2606, 2) */
    static const char *const AWAY[] = {"http://192.0.2.1:1", "http://127.0.0.1.invalid:1"};
    for (size_t a = 0; a < 2; a++) {
        assert_int_equal(run_rugo("clear", (const char *[]){"status", "--server", AWAY[a],
                                                            "--token-file", "tokens", NULL}),
                         2);
        assert_true(contains("clear.err", "clear text"));
    }
    assert_int_equal(
        run_rugo("clear", (const char *[]){"status", "--server", AWAY[1], "--token-file", "tokens",
                                           "--insecure", NULL}),
        1);
    assert_false(contains("clear.err", "clear text"));
}

static void files_open_to_others_are_refused(void **state) {
    (void)state;
    static const mode_t OPEN[] = {0666, 0644, 0640, 0604};
    spit("open-tokens", "read:read-token-000000\n");
    for (size_t m = 0; m < sizeof OPEN / sizeof *OPEN; m++) {
        assert_int_equal(chmod("open-tokens", OPEN[m]), 0);
        assert_int_equal(
            run_rugo("mode", (const char *[]){"serve", "--db", "open.db", "--listen", "127.0.0.1:0",
                                              "--token-file", "open-tokens", NULL}),
            2);
        assert_true(contains("mode.err", "chmod 600"));
        assert_int_equal(
            run_rugo("mode", (const char *[]){"status", "--server", "http://127.0.0.1:1",
                                              "--token-file", "open-tokens", NULL}),
            2);
        assert_true(contains("mode.err", "chmod 600"));
    }
}

/* Makes a token by the command; the caller frees it. */
static char *new_token(const char *role, const char *name) {
    assert_int_equal(
        run_rugo("new", (const char *[]){"token", "new", role, name, "--token-file", "file", NULL}),
        0);
    char *token = slurp("new.out");
    token[strcspn(token, "\n")] = '\0';
    assert_int_equal(strlen(token), 48);
    assert_false(contains("file", token)); /* it has the digest alone */
    return token;
}

static int list_with(unsigned port, const char *token) {
    char headers[160];
    snprintf(headers, sizeof headers, "Authorization: Bearer %s\r\n", token);
    return http_exchange(port, "GET", "/v1/studies", headers, NULL, NULL);
}

/* One request over an open connection, whose answer is read to its end; its status. */
static int ask_open(int connection, const char *token) {
    char text[4096];
    int status = 0;
    size_t used = 0, whole = sizeof text - 1;
    int length = snprintf(text, sizeof text,
                          "GET /v1/studies HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer "
                          "%s\r\n\r\n",
                          token);
    assert_int_equal(send(connection, text, (size_t)length, MSG_NOSIGNAL), length);
    while (used < whole) {
        ssize_t got = recv(connection, text + used, sizeof text - 1 - used, 0);
        assert_true(got > 0);
        used += (size_t)got;
        text[used] = '\0';
        const char *end = strstr(text, "\r\n\r\n"), *size = strstr(text, "\r\nContent-Length: ");
        if (end != NULL && size != NULL)
            whole = (size_t)(end + 4 - text) + strtoul(size + 18, NULL, 10);
    }
    assert_int_equal(sscanf(text, "HTTP/1.1 %d", &status), 1);
    return status;
}

/* As an editor does it: nobody finds half of the text. */
static void replace_file(const char *path, const char *text) {
    spit_secret("new", text);
    assert_int_equal(rename("new", path), 0);
}

/* Tokens outlive their file for a while, as an editor may be at work. A machine that takes longer
 * to ask has missed it, and looks again. */
static void check_grace(unsigned port, const char *token, const char *text) {
    enum { LOOKS = 10 };
    int status = 401;
    for (int look = 0; look < LOOKS && status != 200; look++) {
        replace_file("file", text);
        assert_int_equal(list_with(port, token), 200);
        int64_t gone_ms = clock_ms();
        assert_int_equal(unlink("file"), 0);
        status = list_with(port, token);
        assert_true(status == 200 || clock_ms() - gone_ms >= TOKENS_GRACE_MS);
    }
    assert_int_equal(status, 200);
}

/* Made, used and revoked beside a running server, over a connection that stays open. */
static void tokens_are_revoked_at_once(void **state) {
    (void)state;
    struct process other = {0};
    char *anna = new_token("read", "anna"), *bert = new_token("read", "bert");
    unsigned port =
        serve_start(&other, (const char *[]){"--db", "revoked.db", "--token-file", "file", NULL});
    int connection = http_connect(port);
    assert_int_equal(list_with(port, anna), 200);
    assert_int_equal(ask_open(connection, bert), 200);
    char *carl = new_token("submit", "carl");
    assert_int_equal(list_with(port, carl), 200);
    assert_int_equal(run_rugo("revoke", (const char *[]){"token", "revoke", "bert", "--token-file",
                                                         "file", NULL}),
                     0);
    assert_int_equal(ask_open(connection, bert), 401);
    assert_int_equal(list_with(port, bert), 401);
    assert_int_equal(list_with(port, anna), 200);
    assert_int_equal(
        run_rugo("list", (const char *[]){"token", "list", "--token-file", "file", NULL}), 0);
    assert_true(contains("list.out", "carl"));
    assert_false(contains("list.out", "bert"));
    assert_int_equal(run_rugo("revoke", (const char *[]){"token", "revoke", "bert", "--token-file",
                                                         "file", NULL}),
                     1);
    close(connection);

    /* A line at fault counts for nothing, and no other suffers from it. */
    char *text = slurp("file"), *broken = NULL;
    assert_true(asprintf(&broken, "boss:anna:0123456789abcdef\n%s", strchr(text, '\n') + 1) > 0);
    replace_file("file", broken);
    assert_int_equal(list_with(port, anna), 401);
    assert_int_equal(list_with(port, carl), 200);
    wait_for_text(other.err, "counts for nothing");

    /* The server sees that the file is gone though nobody asks. */
    assert_int_equal(unlink("file"), 0);
    wait_for_text(other.err, "no token is valid any more");
    int64_t gone_ms = clock_ms();
    while (list_with(port, carl) != 401) {
        assert_true(clock_ms() - gone_ms < 20 * TOKENS_GRACE_MS);
        sleep_ms(50);
    }
    check_grace(port, anna, text);
    process_kill(&other, SIGTERM);
    assert_int_equal(process_wait(&other, 15), 0);
    assert_false(contains(other.err, anna));
    free(text);
    free(broken);
    free(anna);
    free(bert);
    free(carl);
}

/* A server's file of digests is of no use to a client, which is refused with that reason. */
static void a_client_needs_the_token(void **state) {
    (void)state;
    unlink("file");
    free(new_token("read", "anna"));
    assert_int_equal(run_rugo("digest", (const char *[]){"status", "--server", "http://127.0.0.1:1",
                                                         "--token-file", "file", NULL}),
                     2);
    assert_true(contains("digest.err", "digests alone"));
    assert_int_equal(run_rugo("out", (const char *[]){"token", "new", "work", "w", "--token-file",
                                                      "file", "--out", "client", NULL}),
                     0);
    struct stat about;
    assert_int_equal(stat("client", &about), 0);
    assert_int_equal(about.st_mode & 0777, 0600);
    assert_true(contains("client", "work:w:"));
    static const char *const WRONG[][2] = {
        {"boss", "w"},        {"read", "a b"},      {"read", ""},          {"#x", "anna"},
        {"submit", "carl:x"}, {"submit:x", "anna"}, {"submit", "sha256:x"}};
    char *before = slurp("file");
    for (size_t w = 0; w < sizeof WRONG / sizeof *WRONG; w++)
        assert_int_equal(
            run_rugo("wrong", (const char *[]){"token", "new", WRONG[w][0], WRONG[w][1],
                                               "--token-file", "file", NULL}),
            2);
    char *after = slurp("file");
    assert_string_equal(before, after);
    free(before);
    free(after);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(roles_bound_what_a_token_may_do),
        cmocka_unit_test(keys_belong_to_their_owner),
        cmocka_unit_test(beyond_loopback_tokens_are_needed),
        cmocka_unit_test(one_file_for_both_ends),
        cmocka_unit_test(beyond_loopback_tokens_need_tls),
        cmocka_unit_test(files_open_to_others_are_refused),
        cmocka_unit_test(tokens_are_revoked_at_once),
        cmocka_unit_test(a_client_needs_the_token),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
