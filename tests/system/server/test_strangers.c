/* Protects: what is no server of Rugo is named so at first contact, with status 2, by workers and
 * by commands; what a stranger sends in place of a snapshot is no file afterwards; and what answers
 * later in the place of a server that is away is waited out. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <arpa/inet.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

enum { END_S = 60 };

/* --- a stand-in, which answers each connection with the same bytes --- */

struct stranger {
    pid_t pid;
    char url[64];
};

/* Keeps what was asked where the test sees it. */
static void note(const char *request, ssize_t size) {
    FILE *file = fopen("seen", "a");
    if (file == NULL)
        return;
    if (size > 0)
        fwrite(request, 1, (size_t)size, file);
    fclose(file);
}

static void answer(int peer, const char *bytes, size_t size, bool endless) {
    char request[8192];
    /* A banner comes before any request: nobody waits for one. */
    if (strncmp(bytes, "HTTP", 4) == 0)
        note(request, recv(peer, request, sizeof request, 0));
    while (send(peer, bytes, size, MSG_NOSIGNAL) > 0 && endless) {
        bytes = request;
        size = sizeof request;
    }
    shutdown(peer, SHUT_WR);
    while (recv(peer, request, sizeof request, 0) > 0) {
    }
    close(peer);
}

/* A process answers each connection, as a client may hold one while it opens another. */
static void stand_in(int listening, const char *bytes, size_t size, bool endless) {
    signal(SIGCHLD, SIG_IGN);
    for (;;) {
        int peer = accept(listening, NULL, NULL);
        if (fork() == 0) {
            prctl(PR_SET_PDEATHSIG, SIGKILL);
            answer(peer, bytes, size, endless);
            _exit(0);
        }
        close(peer);
    }
}

/* On a free port where port is 0. */
static struct stranger stranger_start(unsigned port, const char *bytes, size_t size, bool endless) {
    struct stranger stranger;
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
    socklen_t length = sizeof address;
    const int yes = 1;
    int listening = socket(AF_INET, SOCK_STREAM, 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    assert_int_equal(setsockopt(listening, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes), 0);
    assert_int_equal(bind(listening, (struct sockaddr *)&address, sizeof address), 0);
    assert_int_equal(listen(listening, 16), 0);
    assert_int_equal(getsockname(listening, (struct sockaddr *)&address, &length), 0);
    snprintf(stranger.url, sizeof stranger.url, "http://127.0.0.1:%u", ntohs(address.sin_port));
    stranger.pid = fork();
    assert_true(stranger.pid >= 0);
    if (stranger.pid == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        stand_in(listening, bytes, size, endless);
    }
    close(listening);
    return stranger;
}

static void stranger_end(const struct stranger *stranger) {
    kill(stranger->pid, SIGKILL);
    waitpid(stranger->pid, NULL, 0);
}

#define HTML "<html><title>Log in</title></html>"
#define PAGE(STATUS, BODY)                                                                         \
    "HTTP/1.1 " STATUS "\r\nContent-Type: text/html\r\nConnection: close\r\n\r\n" BODY

static const char *const STRANGERS[] = {
    PAGE("200 OK", HTML),
    PAGE("200 OK", "{}"),
    PAGE("302 Found\r\nLocation: /login", ""),
    PAGE("404 Not Found", HTML),
    PAGE("501 Not Implemented", HTML),
    "HTTP/1.1 204 No Content\r\nConnection: close\r\n\r\n",
    "SSH-2.0-OpenSSH_9.2p1 Debian-2\r\n",
};
enum { STRANGER_COUNT = sizeof STRANGERS / sizeof *STRANGERS };

/* Runs a command on the url, and looks for its status and a word of its message. */
static void expect(const char *const *arguments, int status, const char *word) {
    struct process process;
    process_start(&process, "stranger", arguments);
    int ended = process_wait(&process, END_S);
    char *said = slurp("stranger.err");
    if (ended != status || strstr(said, word) == NULL) {
        print_error("rugo %s %s: status %d, \"%s\"\n", arguments[0], arguments[2], ended, said);
        fail();
    }
    free(said);
}

static void strangers_are_named_at_once(void **state) {
    (void)state;
    for (size_t s = 0; s < STRANGER_COUNT; s++) {
        struct stranger one = stranger_start(0, STRANGERS[s], strlen(STRANGERS[s]), false);
        const char *word = strncmp(STRANGERS[s], "SSH", 3) == 0 ? "not speak HTTP" : "no server of";
        expect((const char *[]){"work", "--server", one.url, "--workers", "1", NULL}, 2, word);
        expect((const char *[]){"work", "--server", one.url, "--drain", NULL}, 2, word);
        expect((const char *[]){"status", "--server", one.url, NULL}, 2, word);
        expect((const char *[]){"health", "--server", one.url, NULL}, 2, word);
        expect((const char *[]){"snapshot", "--server", one.url, "copy.db", NULL}, 2, word);
        expect((const char *[]){"wait", "--server", one.url, "0123456789abcdef", NULL}, 2, word);
        assert_int_not_equal(access("copy.db", F_OK), 0);
        stranger_end(&one);
    }
}

/* Serves what says that it is Rugo, and is not one's snapshot. */
static void a_snapshot_is_one(void **state) {
    (void)state;
    static const char *const HEADS[] = {"200 OK\r\nContent-Length: 34", "200 OK", "204 No Content",
                                        "200 OK\r\nContent-Length: 99999",
                                        "200 OK\r\nContent-Length: 0"};
    for (size_t h = 0; h < sizeof HEADS / sizeof *HEADS; h++) {
        char text[512];
        snprintf(text, sizeof text, "HTTP/1.1 %s\r\nRugo-Version: 1\r\nConnection: close\r\n\r\n%s",
                 HEADS[h], strncmp(HEADS[h], "204", 3) == 0 ? "" : HTML);
        for (int endless = 0; endless < 2; endless++) {
            struct stranger one = stranger_start(0, text, strlen(text), endless != 0);
            expect((const char *[]){"snapshot", "--server", one.url, "copy.db", NULL}, 1,
                   "no snapshot of http");
            assert_int_equal(run_shell("! ls copy.db*"), 0);
            stranger_end(&one);
        }
    }
}

static void a_database_of_others_is_none(void **state) {
    (void)state;
    static char text[1 << 16];
    int used = snprintf(text, sizeof text,
                        "HTTP/1.1 200 OK\r\nRugo-Version: 1\r\nConnection: close\r\n"
                        "Content-Length: 4096\r\n\r\nSQLite format 3");
    assert_true(used > 0);
    size_t size = (size_t)used - strlen("SQLite format 3") + 4096;
    struct stranger one = stranger_start(0, text, size, false);
    expect((const char *[]){"snapshot", "--server", one.url, "copy.db", NULL}, 1,
           "of another program");
    assert_int_equal(run_shell("! ls copy.db*"), 0);
    stranger_end(&one);
}

/* http:// where TLS is spoken, and https:// where it is not. */
static void the_wrong_scheme_is_named(void **state) {
    (void)state;
    struct process server;
    char url[64];
    unsigned port = serve_start(&server, (const char *[]){"--db", "plain.db", NULL});
    snprintf(url, sizeof url, "https://127.0.0.1:%u", port);
    expect((const char *[]){"work", "--server", url, NULL}, 2, "it speaks no TLS");
    expect((const char *[]){"status", "--server", url, NULL}, 2, "it speaks no TLS");
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, END_S), 0);
    assert_int_equal(run_shell("\"$RUGO\" certificate new pair"), 0);
    char listen[64];
    port = free_port();
    snprintf(listen, sizeof listen, "127.0.0.1:%u", port);
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    process_start(&server, "serve",
                  (const char *[]){"serve", "--listen", listen, "--db", "tls.db", "--tls-cert",
                                   "pair/certificate.pem", "--tls-key", "pair/key.pem", NULL});
    wait_for_text(server.out, "\n");
    expect((const char *[]){"work", "--server", url, NULL}, 2, "it speaks TLS");
    expect((const char *[]){"status", "--server", url, NULL}, 2, "it speaks TLS");
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, END_S), 0);
}

/* A worker begins before its server, and outlives what a proxy answers for it. */
static void a_known_server_is_waited_for(void **state) {
    (void)state;
    struct process server, worker;
    char listen[64], url[64];
    unsigned port = free_port();
    snprintf(listen, sizeof listen, "127.0.0.1:%u", port);
    snprintf(url, sizeof url, "http://127.0.0.1:%u", port);
    const char *const serve[] = {"serve", "--listen", listen, "--db", "away.db", NULL};
    process_start(&worker, "worker",
                  (const char *[]){"work", "--server", url, "--workers", "1", NULL});
    wait_for_text("worker.err", "waiting for jobs");
    process_start(&server, "serve", serve);
    wait_for_text("worker.err", "answered again");
    process_kill(&server, SIGKILL);
    process_wait(&server, END_S);
    unlink("seen");
    struct stranger one = stranger_start(port, STRANGERS[0], strlen(STRANGERS[0]), false);
    wait_for_text("seen", "POST /v1/jobs/claim");
    stranger_end(&one);
    process_start(&server, "serve", serve);
    wait_for_text(server.out, "\n");
    spit("one.json", ONE_CASE);
    assert_int_equal(
        run_rugo("submit", (const char *[]){"submit", "--server", url, "one.json", NULL}), 0);
    char *id = slurp("submit.out");
    id[strcspn(id, "\n")] = '\0';
    assert_int_equal(run_rugo("wait", (const char *[]){"wait", "--server", url, id, NULL}), 0);
    free(id);
    process_kill(&worker, SIGTERM);
    assert_int_equal(process_wait(&worker, END_S), 0);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, END_S), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strangers_are_named_at_once), cmocka_unit_test(a_snapshot_is_one),
        cmocka_unit_test(a_database_of_others_is_none), cmocka_unit_test(the_wrong_scheme_is_named),
        cmocka_unit_test(a_known_server_is_waited_for)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
