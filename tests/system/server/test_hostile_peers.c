/* Protects: nobody's slowness, strangeness or malice holds the server up, and every connection
 * ends.
 */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include "tests/support/sql.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

static struct process server, hasty_server; /* the second with a deadline of 1 s */
static unsigned port, hasty;

static int start(void **state) {
    (void)state;
    hasty =
        serve_start(&hasty_server, (const char *[]){"--db", "hasty.db", "--deadline", "1", NULL});
    assert_int_equal(rename("serve.err", "hasty.err"), 0);
    port = serve_start(&server, (const char *[]){"--allow-host", "rugo.example", NULL});
    return 0;
}

static void say(int connection, const char *text) {
    assert_true(send(connection, text, strlen(text), MSG_NOSIGNAL) == (ssize_t)strlen(text));
}

/* Reads until text has come; false where the connection ends before. */
static bool hear(int connection, const char *text) {
    char heard[4096];
    size_t used = 0;
    for (ssize_t part; used + 1 < sizeof heard; used += (size_t)part) {
        if ((part = recv(connection, heard + used, sizeof heard - used - 1, 0)) <= 0)
            return false;
        heard[used + (size_t)part] = 0;
        if (strstr(heard, text))
            return true;
    }
    return false;
}

static void check_alive(void) {
    assert_int_equal(http_exchange(hasty, "GET", "/healthz", NULL, NULL, NULL), 200);
    assert_int_equal(http_exchange(port, "GET", "/healthz", NULL, NULL, NULL), 200);
}

static void submit(unsigned at, char id[17]) {
    char *answer;
    assert_int_equal(http_exchange(at, "POST", "/v1/studies", "Content-Type: application/json\r\n",
                                   ONE_CASE, &answer),
                     201);
    assert_int_equal(sscanf(answer, "{\"id\":\"%16[0-9a-f]\"", id), 1);
    free(answer);
}

/* --- requests that are none --- */

static void check_raw(const char *request, const char *status) {
    char *reply = http_raw(port, request, strlen(request)), expected[32];
    snprintf(expected, sizeof expected, "HTTP/1.1 %s", status);
    if (strncmp(reply, expected, strlen(expected)) != 0) {
        print_error("%s\ngot %.200s\n", request, reply);
        fail();
    }
    free(reply);
}

static void wrong_headers_are_refused(void **state) {
    (void)state;
    check_raw("POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
              "text/plain\r\nContent-Length: 2\r\n\r\n{}",
              "415");
    check_raw("POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
              "application/json\r\nContent-Length: 2\r\nContent-Length: 2\r\n\r\n{}",
              "400");
    check_raw("POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
              "application/json\r\nContent-Length: 2\r\nTransfer-Encoding: "
              "chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n",
              "400");
    check_raw("POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
              "application/json\r\nContent-Length: 99999999\r\n\r\n",
              "413");
    check_raw("GET /v1/studies HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n", "403");
    check_raw("GET /v1/studies HTTP/1.1\r\nHost: rugo.example\r\nConnection: close\r\n\r\n", "200");
    check_raw("GET /v1/studies HTTP/1.1\r\nHost: localhost\r\nOrigin: "
              "http://evil.example\r\nConnection: close\r\n\r\n",
              "403");
    check_raw("GET /v1/studies HTTP/1.1\r\nHost: localhost:1\r\nOrigin: "
              "http://localhost:1\r\nConnection: close\r\n\r\n",
              "200");
    check_raw("POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
              "application/json\r\nTransfer-Encoding: gzip\r\n\r\n{}",
              "400");
    check_raw("GET /healthz HTTP/1.1\r\nHost: LocalHost\r\nConnection: close\r\n\r\n", "200");
    check_raw("HEAD /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n", "200");
}

#define RAW(text)                                                                                  \
    { text, sizeof(text) - 1 }
#define HEAD "GET /healthz HTTP/1.1\r\nHost: localhost\r\n"

/* What another reader, such as a proxy, may take for another request is refused, with one head. */
static void doubtful_heads_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *text;
        size_t size;
    } HEADS[] = {
        RAW("GET /healthz HTTP/1.1\nHost: localhost\n\n"),
        RAW("GET /healthz HTTP/1.1\nHost: localhost\r\n\r\n"),
        RAW("GET /healthz HTTP/1.1\r\nHost: localhost\nA: b\r\n\r\n"),
        RAW("POST /v1/check HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
            "Content-Length: 2\n\r\n{}"),
        RAW(HEAD "A: b\0c\r\n\r\n"),
        RAW(HEAD "A: b\0\r\nC: d\r\n\r\n"),
        RAW(HEAD "Authorization: Bearer a\r\nAuthorization: Bearer b\r\n\r\n"),
        RAW("GET /healthz\0 HTTP/1.1\r\nHost: localhost\r\n\r\n"),
        RAW("GET /heal thz HTTP/1.1\r\nHost: localhost\r\n\r\n"),
        RAW("GET /healthz?a=b c HTTP/1.1\r\nHost: localhost\r\n\r\n"),
        RAW("GET /healthz HTTP/1.1\r\nA: b\r\n\r\n"),
    };
    for (size_t h = 0; h < sizeof HEADS / sizeof *HEADS; h++) {
        char *reply = http_raw(port, HEADS[h].text, HEADS[h].size);
        if (strncmp(reply, "HTTP/1.1 400", 12) != 0 || strstr(reply, "\"detail\":\"") == NULL ||
            strstr(reply + 1, "HTTP/1.1 ") != NULL) {
            print_error("head %zu\ngot %.800s\n", h, reply);
            fail();
        }
        free(reply);
    }
    check_raw("GET /healthz HTTP/1.0\r\n\r\n", "200");
    check_raw(HEAD "A:\r\nB: \r\nCookie: c=d; e=f\r\nConnection: close\r\n\r\n", "200");
}

/* 413 comes before the body, and reaches a peer who goes on sending. */
static void large_bodies_are_refused_at_once(void **state) {
    (void)state;
    enum { SIZE = 100000000 };
    char *request = malloc(SIZE);
    assert_non_null(request);
    memset(request, ' ', SIZE);
    int head = snprintf(request, SIZE,
                        "POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
                        "application/json\r\nContent-Length: %d\r\n\r\n",
                        SIZE);
    request[head] = ' ';
    char *reply = http_raw(port, request, SIZE);
    assert_memory_equal(reply, "HTTP/1.1 413", 12);
    free(reply);
    free(request);
}

/* 256 MiB in all: sixteen of the largest bodies, not seventeen. */
static void many_large_bodies_are_refused(void **state) {
    (void)state;
    enum { MOST = 16 };
    const char *head = "POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
                       "application/json\r\nExpect: 100-continue\r\nContent-Length: "
                       "16777216\r\n\r\n";
    int connections[MOST], tries = 0;
    for (int i = 0; i < MOST; i++) {
        connections[i] = http_connect(port);
        say(connections[i], head);
        assert_true(hear(connections[i], "100 Continue"));
    }
    check_raw(head, "503");
    char id[17];
    submit(port, id); /* small ones are taken all the same */
    for (int i = 0; i < MOST; i++)
        close(connections[i]);
    for (bool room = false; !room; sleep_ms(20)) {
        int connection = http_connect(port);
        say(connection, head);
        room = hear(connection, "100 Continue");
        close(connection);
        assert_true(tries++ < 1500);
    }
}

/* A chunked body has no length to refuse: it is cut past 16 MiB, and the server goes on. */
static void endless_chunks_are_cut(void **state) {
    (void)state;
    int connection = http_connect(port);
    const char *head =
        "POST /v1/studies HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        "Transfer-Encoding: chunked\r\n\r\n";
    char *chunk = malloc(65536 + 16);
    assert_non_null(chunk);
    int used = snprintf(chunk, 16, "10000\r\n");
    memset(chunk + used, ' ', 65536);
    memcpy(chunk + used + 65536, "\r\n", 2);
    assert_true(send(connection, head, strlen(head), MSG_NOSIGNAL) > 0);
    int chunks = 0;
    while (chunks < 2000 && send(connection, chunk, (size_t)used + 65538, MSG_NOSIGNAL) > 0)
        chunks++;
    assert_true(chunks < 2000);
    free(chunk);
    close(connection);
    check_alive();
}

/* A path is the peer's text: it must not write log lines of its own. */
static void log_lines_cannot_be_forged(void **state) {
    (void)state;
    const char *path = "/x%0atime=2000-01-01T00:00:00Z%20level=error%20msg=forged";
    assert_int_equal(http_exchange(port, "GET", path, NULL, NULL, NULL), 404);
    wait_for_text(server.err, "forged");
    assert_false(contains(server.err, "\ntime=2000"));
}

/* --- slow peers --- */

/* One byte a time keeps the library's own timeout away; the deadline (1 s here) must come all the
 * same. */
static void slow_requests_are_cut(void **state) {
    (void)state;
    int connection = http_connect(hasty);
    const char *request = "GET /healthz HTTP/1.1\r\nHost: localhost\r\nX-Slow: yes";
    bool cut = false;
    for (const char *c = request; *c && !cut; c++) {
        char byte;
        cut = send(connection, c, 1, MSG_NOSIGNAL) < 0 ||
              recv(connection, &byte, 1, MSG_DONTWAIT) == 0;
        sleep_ms(200);
    }
    assert_true(cut);
    close(connection);
}

static void half_closed_connections_do_no_harm(void **state) {
    (void)state;
    for (int i = 0; i < 20; i++) {
        int connection = http_connect(port);
        send(connection, "GET /healthz HT", 15, MSG_NOSIGNAL);
        shutdown(connection, SHUT_WR);
        close(connection);
    }
    check_alive();
}

/* Their deadline frees them. */
static void silent_connections_are_cut(void **state) {
    (void)state;
    enum { MOST = 300 };
    int connections[MOST];
    for (int i = 0; i < MOST; i++)
        connections[i] = http_connect(hasty);
    bool alone = false;
    for (int tries = 0; !alone && tries < 600; tries++) {
        char *metrics;
        sleep_ms(100);
        assert_int_equal(http_exchange(hasty, "GET", "/metrics", NULL, NULL, &metrics), 200);
        alone = strstr(metrics, "\nrugo_http_connections 1\n") != NULL;
        free(metrics);
    }
    assert_true(alone);
    for (int i = 0; i < MOST; i++)
        close(connections[i]);
}

/* Room for a snapshot that no socket's buffers hold. */
static void fatten_database(const char *path) {
    sql_change(path, "CREATE TABLE fat AS SELECT zeroblob(24000000) AS bytes");
}

/* A connection whose answer has begun, and of which nothing more is read. */
static int begin_download(unsigned at) {
    int connection = http_connect(at), room = 4096;
    setsockopt(connection, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
    say(connection, "GET /v1/snapshot HTTP/1.1\r\nHost: localhost\r\n\r\n");
    assert_true(hear(connection, "200 OK"));
    return connection;
}

/* Who asks for a copy of the database and does not read it is cut after a deadline. */
static void downloads_that_are_not_read_are_cut(void **state) {
    (void)state;
    fatten_database("hasty.db");
    int connection = begin_download(hasty);
    wait_for_text("hasty.err", "cut off");
    assert_true(contains("hasty.err", "status=200"));
    close(connection);
}

/* There are no more than four copies at a time, here of a server that waits for 30 s. */
static void downloads_are_few(void **state) {
    (void)state;
    enum { MOST = 4 };
    int connections[MOST], status = 503;
    fatten_database("rugo.db");
    for (int i = 0; i < MOST; i++)
        connections[i] = begin_download(port);
    assert_int_equal(http_exchange(port, "GET", "/v1/snapshot", NULL, NULL, NULL), 503);
    for (int i = 0; i < MOST; i++)
        close(connections[i]);
    char *answer = NULL;
    for (int tries = 0; status == 503 && tries < 600; tries++) {
        sleep_ms(100);
        free(answer);
        status = http_exchange(port, "GET", "/v1/snapshot", NULL, NULL, &answer);
    }
    assert_int_equal(status, 200);
    assert_memory_equal(answer, "SQLite format 3", 15);
    free(answer);
}

/* --- streams of events --- */

static void a_stream_outlives_the_deadline(void **state) {
    (void)state;
    char id[17], request[200], path[64];
    submit(hasty, id);
    snprintf(request, sizeof request,
             "GET /v1/studies/%s/events HTTP/1.1\r\nHost: localhost\r\n\r\n", id);
    int connection = http_connect(hasty);
    say(connection, request);
    assert_true(hear(connection, "queued"));
    sleep_ms(1800);
    snprintf(path, sizeof path, "/v1/studies/%s", id);
    assert_int_equal(http_exchange(hasty, "DELETE", path, NULL, NULL, NULL), 200);
    assert_true(hear(connection, "cancelled"));
    close(connection);
}

/* Headers alone: the end of a chunked body behind them would be taken for the next answer. */
static void head_of_a_stream_has_no_body(void **state) {
    (void)state;
    char id[17], request[200];
    submit(port, id);
    snprintf(request, sizeof request,
             "HEAD /v1/studies/%s/events HTTP/1.1\r\nHost: localhost\r\nConnection: "
             "close\r\n\r\n",
             id);
    char *reply = http_raw(port, request, strlen(request));
    assert_memory_equal(reply, "HTTP/1.1 200", 12);
    const char *end = strstr(reply, "\r\n\r\n");
    assert_true(end && !end[4]);
    assert_null(strstr(reply, "Content-Length")); /* not that of the document */
    free(reply);
}

/* A study that rests writes nothing: that its watcher has left is seen all the same, and soon. */
static void streams_left_alone_end(void **state) {
    (void)state;
    char id[17], request[200], *metrics = NULL;
    bool none = false;
    submit(port, id);
    snprintf(request, sizeof request,
             "GET /v1/studies/%s/events HTTP/1.1\r\nHost: localhost\r\n\r\n", id);
    int connection = http_connect(port);
    say(connection, request);
    assert_true(hear(connection, "queued"));
    close(connection);
    for (int tries = 0; !none && tries < 100; tries++) { /* it writes once in 15 s */
        sleep_ms(100);
        assert_int_equal(http_exchange(port, "GET", "/metrics", NULL, NULL, &metrics), 200);
        none = strstr(metrics, "\nrugo_event_streams 0\n") != NULL;
        free(metrics);
    }
    assert_true(none);
}

/* --- the whole server --- */

static void a_taken_port_is_refused(void **state) {
    (void)state;
    char address[32];
    snprintf(address, sizeof address, "127.0.0.1:%u", port);
    assert_int_equal(run_rugo("second", (const char *[]){"serve", "--db", "second.db", "--listen",
                                                         address, NULL}),
                     1);
    assert_true(contains("second.err", "in use"));
}

/* SIGTERM ends streams, and does not wait for connections that rest, or for halves of requests. */
static int stop(void **state) {
    (void)state;
    char id[17], request[200];
    submit(port, id);
    snprintf(request, sizeof request,
             "GET /v1/studies/%s/events HTTP/1.1\r\nHost: localhost\r\n\r\n", id);
    int stream = http_connect(port), resting = http_connect(port), half = http_connect(port);
    say(stream, request);
    assert_true(hear(stream, "queued"));
    say(resting, "GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
    assert_true(hear(resting, "ok"));
    say(half, "GET /hea");
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    assert_true(contains(server.err, "msg=ended"));
    assert_true(hear(stream, "0\r\n\r\n")); /* a whole answer, not a torn one */
    close(stream);
    close(resting);
    close(half);
    process_kill(&hasty_server, SIGTERM);
    assert_int_equal(process_wait(&hasty_server, 20), 0);
    return 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(doubtful_heads_are_refused),
        cmocka_unit_test(wrong_headers_are_refused),
        cmocka_unit_test(large_bodies_are_refused_at_once),
        cmocka_unit_test(many_large_bodies_are_refused),
        cmocka_unit_test(endless_chunks_are_cut),
        cmocka_unit_test(log_lines_cannot_be_forged),
        cmocka_unit_test(slow_requests_are_cut),
        cmocka_unit_test(half_closed_connections_do_no_harm),
        cmocka_unit_test(silent_connections_are_cut),
        cmocka_unit_test(downloads_that_are_not_read_are_cut),
        cmocka_unit_test(downloads_are_few),
        cmocka_unit_test(a_stream_outlives_the_deadline),
        cmocka_unit_test(head_of_a_stream_has_no_body),
        cmocka_unit_test(streams_left_alone_end),
        cmocka_unit_test(a_taken_port_is_refused),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
