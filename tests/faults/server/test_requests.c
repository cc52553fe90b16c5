/* Protects: a request for which there is no memory costs that request and no other. Whichever
 * allocation fails, in the library too, the peer gets an answer, of the server's trouble or a right
 * one, or its connection is closed; the same request is answered as ever afterwards, and the
 * service is well. */
#include "tests/support/check.h"

#include "server/http/http.h"
#include "tests/support/failing/failing_allocator.h"
#include "tests/support/fuzz/answer.h"
#include "tests/support/fuzz/served_store.h"
#include "tests/support/seed.h"
#include "worker/clock.h"
#include "worker/log.h"
#include <arpa/inet.h>
#include <errno.h>
#include <gsl/gsl_errno.h>
#include <inttypes.h>
#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

/* Allocations of a request that fail, unless RUGO_FAULTS=all; each alone, and with all behind it.
 */
enum { FAILURES = 12, BYTES = 128, LEASE_MS = 60000, WELL_MS = 60000, PATIENCE_S = 60 };

static struct service service;
static struct http *http;
static struct served served;

static int start(void **state) {
    struct error err = {0};
    const struct http_options options = {
        .address = "127.0.0.1", .connections = 64, .deadline_s = 30};
    (void)state;
    log_set_least(LEVEL_ERROR + 1); /* answers report what fails */
    signal(SIGPIPE, SIG_IGN);
    gsl_set_error_handler_off();
    served_store_make(&served, "requests.db");
    assert_int_equal(service_open(&service, "requests.db", LEASE_MS, &err), 0);
    assert_int_equal(http_start(&http, &service, &options, &err), 0);
    return 0;
}

static int stop(void **state) {
    (void)state;
    http_stop(&http);
    service_close(&service);
    served_store_remove("requests.db");
    served_clear(&served);
    return 0;
}

/* Sends the request and reads the answer to its end, without an allocation of its own: its status;
 * 0 where the connection was closed without one, and -1 where it did not end in time. It asserts
 * nothing, since a test that ends here would leave all allocations failing. */
static long ask_without_memory(const struct drawn_request *request) {
    static char text[1 << 16];
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons(http_port(http))};
    struct timeval patience = {.tv_sec = PATIENCE_S};
    int peer = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    setsockopt(peer, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    setsockopt(peer, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    bool late = peer < 0 || connect(peer, (struct sockaddr *)&address, sizeof address) != 0;
    if (!late)
        (void)send(peer, request->bytes, request->size, MSG_NOSIGNAL);
    size_t used = 0;
    int64_t until_ms = clock_ms() + 2000 * PATIENCE_S;
    for (ssize_t got = 1; got > 0 && !late;) {
        got = recv(peer, text + used, sizeof text - 1 - used, 0);
        late = (got < 0 && errno != ECONNRESET && errno != EINTR) || clock_ms() > until_ms;
        used += got > 0 ? (size_t)got : 0;
        used = used == sizeof text - 1 ? 64 : used; /* its beginning is enough */
        text[used] = '\0';
        if (strstr(text, "event: progress") != NULL)
            break;
    }
    if (peer >= 0)
        close(peer);
    if (late)
        return -1;
    return strncmp(text, "HTTP/1.1 ", 9) == 0 && used > 9 ? strtol(text + 9, NULL, 10) : 0;
}

static void ask_as_ever(const struct drawn_request *request) {
    struct answer answer;
    answer_of(&answer, http_port(http), request);
    answer_judge(&answer, request);
    if (request->route->handler == handle_claim && answer.status == 200)
        served_take_jobs(&served, answer.body, answer.size);
    answer_clear(&answer);
}

static void fail_at(const struct drawn_request *request, uint64_t n, uint64_t most) {
    failing_arm(n, most);
    long status = ask_without_memory(request);
    struct failing_count count = failing_disarm();
    bool told = status == 0 || (status >= 200 && status < 500) || status == 500 || status == 503;
    if (!told || (count.failed == 0 && (status < 200 || status >= 500))) {
        failing_where();
        fail_msg("%.*s\nallocations from %" PRIu64 " failed, %" PRIu64 " of them: %ld",
                 (int)request->size, request->bytes, n, count.failed, status);
    }
    ask_as_ever(request);
}

static uint64_t fail_each(const struct drawn_request *request) {
    const char *wish = getenv("RUGO_FAULTS");
    uint64_t failed = 0;
    ask_as_ever(request);
    failing_arm(0, 0);
    long status = ask_without_memory(request);
    uint64_t total = failing_disarm().asked;
    assert_true(status >= 0);
    bool all = (wish != NULL && strcmp(wish, "all") == 0) || total < FAILURES;
    for (uint64_t n = 0; n < total; n += all ? 1 : total / FAILURES, failed += 2) {
        fail_at(request, n, 1);
        fail_at(request, n, UINT64_MAX);
    }
    return failed;
}

/* A request of the route as it is meant to be sent. */
static void draw_of(size_t route, uint64_t *seed, struct drawn_request *out) {
    uint8_t bytes[BYTES];
    for (size_t b = 0; b < BYTES; b++)
        bytes[b] = (uint8_t)next_word(seed);
    bytes[0] = (uint8_t)route;
    bytes[1] = 0;
    draw_request(&(struct choices){bytes, BYTES}, &served, out);
    assert_ptr_equal(out->route, route_at(route));
}

/* Requests with results, whatever is drawn. */
static uint64_t fail_fixed(void) {
    static const struct {
        route_handler *handler;
        const char *path;
    } FIXED[] = {
        {handle_map, "/v1/studies/flat/cases/0/realisations/0/map"},
        {handle_map, "/v1/studies/pressed/cases/0/realisations/1/map?field=gap&load=0.1"},
        {handle_nodes, "/v1/studies/pressed/cases/0/realisations/1/nodes?load=0.1"},
        {handle_curves, "/v1/studies/small/curves?case=1"},
        {handle_report, "/v1/studies/asked/report"},
        {handle_plot, "/v1/studies/small/plot?quantity=contact_area"},
        {handle_table, "/v1/studies/flat/table?columns=summit_density"},
        {handle_events, "/v1/studies/waiting/events"},
    };
    uint64_t failed = 0;
    for (size_t n = 0; n < sizeof FIXED / sizeof *FIXED; n++) {
        struct drawn_request request = {.route = route_at(0)};
        for (size_t r = 0; route_at(r)->handler != FIXED[n].handler; r++)
            request.route = route_at(r + 1);
        int size = asprintf(&request.bytes,
                            "GET %s HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n",
                            FIXED[n].path);
        assert_true(size > 0);
        request.size = (size_t)size;
        failed += fail_each(&request);
        drawn_request_clear(&request);
    }
    return failed;
}

static void a_request_without_memory_costs_itself(void **state) {
    uint64_t seed = seed_of_now(), failed = fail_fixed();
    (void)state;
    for (size_t r = 0; route_at(r) != NULL; r++) {
        struct drawn_request request;
        /* A file is looked at by a process of its own, which would be this test again. */
        if (route_at(r)->handler == handle_characterise)
            continue;
        draw_of(r, &seed, &request);
        failed += fail_each(&request);
        drawn_request_clear(&request);
    }
    print_message("%" PRIu64 " failures\n", failed);
    assert_true(failed > 100);
}

/* A commit that failed is tried again by itself. */
static void the_service_is_well_afterwards(void **state) {
    static char bytes[] = "GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n";
    const struct drawn_request health = {
        .route = route_at(0), .bytes = bytes, .size = sizeof bytes - 1};
    int64_t until_ms = clock_ms() + WELL_MS;
    struct answer answer = {.status = 503};
    (void)state;
    for (; answer.status != 200; answer_clear(&answer)) {
        assert_true(clock_ms() < until_ms);
        answer_of(&answer, http_port(http), &health);
        if (answer.status == 200)
            break;
        (void)poll(NULL, 0, 100);
    }
    answer_clear(&answer);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_request_without_memory_costs_itself),
        cmocka_unit_test(the_service_is_well_afterwards),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
