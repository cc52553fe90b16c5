/* Protects: thousands of connections of strangers that are silent, send half a request, a byte now
 * and then, or do not read their answers, shut nobody out: probes are answered, and no worker loses
 * a lease. */
#include "tests/support/check.h"
#include "tests/support/faults/world.h"
#include <arpa/inet.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

enum { CONNECTIONS = 3000, OPENED_AT_ONCE = 150, PROBE_MS = 500 };

struct flood {
    int connections[CONNECTIONS]; /* -1: none */
    int next;                     /* to be looked at */
    int64_t probe_at;
    unsigned probes;
    long slowest_ms;
};

/* What a connection says first; the last waits for an answer that it does not read. */
static const char *const BEGINNINGS[] = {
    "", "GET /v1/studies HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow: ",
    "POST /v1/studies HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
    "Content-Length: 1000000\r\n\r\n{",
    "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"};

/* Does not wait: a full backlog is no answer either. */
static int flood_connect(struct world *world) {
    struct sockaddr_in to = {.sin_family = AF_INET, .sin_port = htons((uint16_t)world->port)};
    const char *beginning = BEGINNINGS[world_draw(world, 4)];
    int connection = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0), room = 1;
    if (connection < 0)
        return -1;
    setsockopt(connection, SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(connection, (struct sockaddr *)&to, sizeof to) != 0 && errno != EINPROGRESS) {
        close(connection);
        return -1;
    }
    send(connection, beginning, strlen(beginning), MSG_NOSIGNAL);
    world_count_fault(world);
    return connection;
}

/* One more byte; whether the connection is still there. */
static bool flood_drip(int connection) {
    return send(connection, "a", 1, MSG_NOSIGNAL) == 1 || errno == EAGAIN;
}

static void probe(struct world *world, struct flood *flood) {
    static const char *const PROBES[] = {"/healthz", "/metrics"};
    const char *path = PROBES[world_draw(world, 2)];
    int64_t begin = world_now();
    int status = world_ask(world, "GET", path, NULL, NULL);
    long took = (long)(world_now() - begin);
    flood->probes++;
    if (took > flood->slowest_ms)
        flood->slowest_ms = took;
    if (status != 200)
        world_lose(&world->tally->lost, "%s was answered by %d after %ld ms", path, status, took);
}

static void strike(struct world *world) {
    struct flood *flood = world->options.context;
    if (flood->probes == 0 && world_ask(world, "GET", "/healthz", NULL, NULL) != 200)
        return; /* the server has yet to start */
    for (int n = 0; n < OPENED_AT_ONCE; n++) {
        int *connection = &flood->connections[flood->next];
        flood->next = (flood->next + 1) % CONNECTIONS;
        if (*connection >= 0 && !flood_drip(*connection)) {
            close(*connection);
            *connection = -1;
        }
        if (*connection < 0)
            *connection = flood_connect(world);
    }
    if (world_now() >= flood->probe_at) {
        probe(world, flood);
        flood->probe_at = world_now() + PROBE_MS;
    }
}

static void heal(struct world *world) {
    struct flood *flood = world->options.context;
    for (int n = 0; n < CONNECTIONS; n++)
        if (flood->connections[n] >= 0)
            close(flood->connections[n]);
    printf("%u probes were answered, the slowest after %ld ms\n", flood->probes, flood->slowest_ms);
}

static void floods_shut_nobody_out(void **state) {
    (void)state;
    struct flood *flood = calloc(1, sizeof *flood);
    struct rlimit files;
    assert_non_null(flood);
    spit("tokens", "admin:token-of-the-test-0\nwork:token-of-the-test-1\n");
    assert_int_equal(chmod("tokens", 0600), 0);
    for (int n = 0; n < CONNECTIONS; n++)
        flood->connections[n] = -1;
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &files), 0);
    files.rlim_cur = files.rlim_max;
    if (files.rlim_max < CONNECTIONS + 100 || setrlimit(RLIMIT_NOFILE, &files) != 0) {
        print_message("SKIP: fewer than %d files may be open here\n", CONNECTIONS + 100);
        skip();
    }
    world_test(&(struct world_options){.program = "floods",
                                       .workers = 3,
                                       .submitters = 2,
                                       .headers = "Content-Type: application/json\r\n"
                                                  "Authorization: Bearer token-of-the-test-0\r\n",
                                       .token_file = "tokens",
                                       .server_kb = 384 * 1024,
                                       .long_model = true,
                                       .strike = strike,
                                       .pause_ms = 40,
                                       .heal = heal,
                                       .context = flood},
               20);
    free(flood);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(floods_shut_nobody_out)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
