/* Protects: workers, probes and a reader get in however many connections are held, headers that two
 * readers could read differently are refused, and nothing is computed for peers that have left. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define JSON "Content-Type: application/json\r\n"
enum { MOST = 4, FLOOD = 200, MAPS_MS = 60000, END_S = 20 };

static struct process server;
static unsigned port;

static int start(void **state) {
    (void)state;
    port = serve_start(&server, (const char *[]){"--connections", "4", NULL});
    return 0;
}

/* Asks for a map over a connection of its own. */
static int ask_for_map(const char *request) {
    int connection = http_connect(port);
    assert_true(send(connection, request, strlen(request), MSG_NOSIGNAL) ==
                (ssize_t)strlen(request));
    return connection;
}

/* Soon whatever it does, as computing a map of a contact that takes minutes. */
static int stop(void **state) {
    (void)state;
    static const char LARGE[] =
        "{\"name\":\"large\",\"kind\":\"contact\",\"realisations\":1,\"surface\":{\"hurst\":0.8,"
        "\"wavelength_ratio\":16,\"length_ratio\":8,\"points_per_wavelength\":8,\"rms_slope\":0.1}"
        "}";
    static const char MAP[] = "GET /v1/studies/large/cases/0/realisations/0/map?field=gap&load=0.1 "
                              "HTTP/1.1\r\nHost: localhost\r\n\r\n";
    assert_int_equal(http_exchange(port, "POST", "/v1/studies", JSON, LARGE, NULL), 201);
    int connection = ask_for_map(MAP);
    sleep_ms(300);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, END_S), 0);
    close(connection);
    return 0;
}

static int status_of(const char *method, const char *path, const char *body) {
    return http_exchange(port, method, path, body != NULL ? JSON : NULL, body, NULL);
}

/* A request over a connection that stays; fills the answer. */
static void ask_over(int connection, const char *path, const char *body, char answer[4096]) {
    char request[600];
    int size =
        snprintf(request, sizeof request,
                 "POST %s HTTP/1.1\r\nHost: localhost\r\n" JSON "Content-Length: %zu\r\n\r\n%s",
                 path, strlen(body), body);
    assert_true(send(connection, request, (size_t)size, MSG_NOSIGNAL) == size);
    size_t used = 0, whole = 4095;
    while (used < whole) {
        ssize_t part = recv(connection, answer + used, whole - used, 0);
        if (part <= 0) {
            print_error("the connection ended: %.*s\n", (int)used, answer);
            fail();
        }
        used += (size_t)part;
        answer[used] = '\0';
        const char *end = strstr(answer, "\r\n\r\n"), *length = strstr(answer, "Content-Length: ");
        if (end != NULL && length != NULL)
            whole = (size_t)(end + 4 - answer) + strtoul(length + 16, NULL, 10);
        assert_true(whole <= 4095);
    }
}

struct lease {
    int connection;
    char path[64], token[64];
};

static void take_lease(struct lease *lease) {
    char answer[4096];
    lease->connection = http_connect(port);
    ask_over(lease->connection, "/v1/jobs/claim",
             "{\"worker\":\"w\",\"count\":1,\"sequence\":true}", answer);
    assert_memory_equal(answer, "HTTP/1.1 200", 12);
    const char *token = strstr(answer, "\"token\":\""), *job = strstr(answer, "\"id\":");
    assert_non_null(token);
    assert_non_null(job);
    assert_int_equal(sscanf(token, "\"token\":\"%63[^\"]\"", lease->token), 1);
    snprintf(lease->path, sizeof lease->path, "/v1/jobs/%ld/heartbeat", strtol(job + 5, NULL, 10));
}

static void body_of(const struct lease *lease, char body[128]) {
    snprintf(body, 128, "{\"token\":\"%s\",\"done\":0}", lease->token);
}

static void check_vital(void) {
    for (int i = 0; i < 3; i++) {
        assert_int_equal(status_of("GET", "/healthz", NULL), 200);
        assert_int_equal(status_of("GET", "/metrics", NULL), 200);
        assert_int_equal(status_of("GET", "/v1/studies", NULL), 200);
    }
}

static void silence_shuts_nobody_out(void **state) {
    (void)state;
    int silent[FLOOD];
    for (int i = 0; i < FLOOD; i++) {
        silent[i] = http_connect(port);
        if (i % 2 == 1)
            (void)send(silent[i], "GET /v1/studies HT", 18, MSG_NOSIGNAL);
    }
    check_vital();
    char *metrics;
    assert_int_equal(http_exchange(port, "GET", "/metrics", NULL, NULL, &metrics), 200);
    const char *open = strstr(metrics, "\nrugo_http_connections ");
    assert_non_null(open);
    assert_true(strtol(open + strlen("\nrugo_http_connections "), NULL, 10) < FLOOD / 2);
    free(metrics);
    for (int i = 0; i < FLOOD; i++)
        close(silent[i]);
}

/* All connections are of workers with jobs. */
static void leases_shut_nobody_out(void **state) {
    (void)state;
    static const char STUDY[] =
        "{\"name\":\"many\",\"kind\":\"statistics\",\"realisations\":5,\"surface\":{\"hurst\":[0.3,"
        "0.4,0.5,0.6,0.7,0.8],\"wavelength_ratio\":4,\"length_ratio\":2}}";
    struct lease leases[MOST];
    int silent[FLOOD];
    char body[128], answer[4096];
    assert_int_equal(status_of("POST", "/v1/studies", STUDY), 201);
    for (int i = 0; i < MOST; i++)
        take_lease(&leases[i]);
    for (int i = 0; i < FLOOD; i++)
        silent[i] = http_connect(port);
    check_vital();
    for (int i = 0; i < MOST; i++) {
        body_of(&leases[i], body);
        assert_int_equal(status_of("POST", leases[i].path, body), 200);
        ask_over(leases[i].connection, leases[i].path, body, answer); /* it was not closed */
        assert_memory_equal(answer, "HTTP/1.1 200", 12);
    }
    assert_int_equal(status_of("GET", "/v1/studies/many/events", NULL), 503);
    for (int i = 0; i < FLOOD; i++)
        close(silent[i]);
    for (int i = 0; i < MOST; i++)
        close(leases[i].connection);
}

static void strange_headers_are_refused(void **state) {
    (void)state;
    static const char *const LINES[] = {
        "X-A : b\r\n",
        "Content-Length : 2\r\n",
        "X-A: b\r\n c\r\n",
        "X-A: b\r\n\tc: d\r\n",
        "X-A:\r\n b\r\n",
        "Content-Length: 2\r\n 0\r\n",
        "X-A: b\rContent-Length: 9\r\n",
        "X-\rA: b\r\n",
        "X-A: b\x01\r\n",
        "Content-Length: 2\r\nContent-Length: 2\r\n",
        "Content-Length: 0\r\nContent-Length: 0\r\n",
        "Content-Length: 2\r\nTransfer-Encoding: chunked\r\n",
        "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n",
        "Transfer-Encoding: xchunked\r\n",
    };
    static const char *const PLAIN[] = {"", "X-A:\r\n", "X-A:b\r\n", "X-A: \t b\tc \r\n"};
    char request[300];
    for (size_t i = 0; i < sizeof LINES / sizeof *LINES; i++) {
        snprintf(request, sizeof request,
                 "POST /v1/check HTTP/1.1\r\nHost: localhost\r\n" JSON "%s\r\n{}", LINES[i]);
        char *reply = http_raw(port, request, strlen(request)); /* to the end of the connection */
        if (strncmp(reply, "HTTP/1.1 400", 12) != 0) {
            print_error("%s\ngot %.200s\n", request, reply);
            fail();
        }
        free(reply);
    }
    for (size_t i = 0; i < sizeof PLAIN / sizeof *PLAIN; i++) {
        snprintf(request, sizeof request,
                 "GET /healthz HTTP/1.1\r\nHost: localhost\r\n%sConnection: close\r\n\r\n",
                 PLAIN[i]);
        char *reply = http_raw(port, request, strlen(request));
        assert_memory_equal(reply, "HTTP/1.1 200", 12);
        free(reply);
    }
}

static bool has_answer(int connection) {
    struct pollfd file = {.fd = connection, .events = POLLIN};
    return poll(&file, 1, 0) > 0;
}

/* Heights that are iterated for hours occupy a map's slot no longer than someone waits for them. */
static void maps_end_with_their_peers(void **state) {
    (void)state;
    static const char ENDLESS[] =
        "{\"name\":\"endless\",\"kind\":\"statistics\",\"realisations\":1,\"surface\":{\"hurst\":"
        "0.8,\"wavelength_ratio\":16,\"length_ratio\":8,\"points_per_wavelength\":8,\"heights\":{"
        "\"distribution\":\"weibull_max\",\"shape\":1,\"tolerance\":0,\"stall_gain\":0,"
        "\"stall_iterations\":1000000,\"max_iterations\":1000000}}}";
    static const char PATH[] = "/v1/studies/one/cases/0/realisations/0/map";
    static const char MAP[] = "GET /v1/studies/endless/cases/0/realisations/0/map HTTP/1.1\r\n"
                              "Host: localhost\r\n\r\n";
    int connections[2], status = 0, waited = 0;
    struct process own; /* which lets nobody go for want of room */
    unsigned other = port;
    port = serve_start(&own, (const char *[]){"--db", "maps.db", NULL});
    assert_int_equal(status_of("POST", "/v1/studies", ENDLESS), 201);
    assert_int_equal(status_of("POST", "/v1/studies", ONE_CASE), 201);
    for (size_t n = 0; n < 2; n++)
        connections[n] = ask_for_map(MAP);
    while ((status = status_of("GET", PATH, NULL)) == 200 && (waited += 20) < MAPS_MS) {
        sleep_ms(20);
        for (size_t n = 0; n < 2; n++)
            if (has_answer(connections[n])) { /* the short map had its slot, and it was refused */
                close(connections[n]);
                connections[n] = ask_for_map(MAP);
            }
    }
    assert_int_equal(status, 503); /* both are being made */
    for (size_t n = 0; n < 2; n++)
        close(connections[n]);
    while ((status = status_of("GET", PATH, NULL)) == 503 && (waited += 20) < MAPS_MS)
        sleep_ms(20);
    assert_int_equal(status, 200);
    process_kill(&own, SIGTERM);
    assert_int_equal(process_wait(&own, 15), 0);
    port = other;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_end_with_their_peers),
        cmocka_unit_test(silence_shuts_nobody_out),
        cmocka_unit_test(leases_shut_nobody_out),
        cmocka_unit_test(strange_headers_are_refused),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
