/* Requests to a service that holds finished, waiting and broken studies: drawn from its table of
 * routes, with the messages of workers and whole studies for bodies. Each is given one answer, none
 * of which is a failure of the server's own; the service stays well. */
#include "server/command/command.h"
#include "server/http/http.h"
#include "tests/support/fuzz/answer.h"
#include "tests/support/fuzz/fuzz.h"
#include "tests/support/fuzz/served_store.h"
#include "worker/clock.h"
#include "worker/log.h"
#include <gsl/gsl_errno.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

enum {
    REQUESTS_MOST = 8, /* by one input */
    ANEW_AFTER = 2000, /* requests: what they queue is gone with the store */
    HEALTH_EACH = 64,  /* requests */
    LEASE_MS = 60000,
    PATIENCE_MS = 60000,
};
static const char PRISTINE[] = "pristine.db", SERVED[] = "requests.db";

static struct service service;
static struct http *http;
static struct served served;
static size_t requests;
static bool anew; /* the next input finds the store as it was in the beginning */
enum { ROUTES_MOST = 64, CLASSES = 6 };
static struct {
    size_t answers[CLASSES]; /* by hundreds of the status */
    int64_t milliseconds;
} asked[ROUTES_MOST]; /* of each route */

/* A process for a map in a file, which the service starts, is this program again. */
__attribute__((constructor)) static void be_command(int argc, char **argv) {
    const char *command = "characterise", *arguments[ARGUMENTS_MOST] = {NULL};
    if (argc < 2 || strcmp(argv[1], command) != 0)
        return;
    const struct command *one = &COMMAND_CHARACTERISE;
    void *options = calloc(1, one->options_size);
    MUST(options != NULL);
    gsl_set_error_handler_off();
    int status = options_parse(argc - 1, argv + 1, one->options, options, one->least, one->most,
                               one->arguments, arguments);
    if (status == 0)
        status = one->run(options, arguments);
    fflush(stdout);
    _exit(status);
}

/* --- the service --- */

static void copy_store(void) {
    static char bytes[1 << 16];
    served_store_remove(SERVED);
    FILE *from = fopen(PRISTINE, "rb"), *to = fopen(SERVED, "wb");
    MUST(from != NULL && to != NULL);
    for (size_t size; (size = fread(bytes, 1, sizeof bytes, from)) > 0;)
        MUST(fwrite(bytes, 1, size, to) == size);
    fclose(from);
    MUST(fclose(to) == 0);
}

static void end_service(void) {
    http_stop(&http);
    service_close(&service);
    served_store_remove(SERVED);
}

/* For who wants to know what of the service was asked for: RUGO_SHOW_REQUESTS=1. */
static void show_requests(void) {
    const struct route *route;
    for (size_t r = 0; getenv("RUGO_SHOW_REQUESTS") != NULL && (route = route_at(r)) != NULL; r++)
        fprintf(stderr, "%-6s %-42s 2xx %zu, 3xx %zu, 4xx %zu; %lld ms\n", route->method,
                route->pattern, asked[r].answers[2], asked[r].answers[3], asked[r].answers[4],
                (long long)asked[r].milliseconds);
}

static void leave(void) {
    show_requests();
    end_service();
    served_store_remove(PRISTINE);
    served_clear(&served);
}

static void start_service(void) {
    struct error err = {0};
    const struct http_options options = {
        .address = "127.0.0.1", .connections = 64, .deadline_s = 30};
    copy_store();
    service = (struct service){.map_bytes = 1 << 20};
    MUST(service_open(&service, SERVED, LEASE_MS, &err) == 0);
    MUST(http_start(&http, &service, &options, &err) == 0);
}

/* --- requests --- */

static void ask(const char *path, struct answer *out) {
    struct drawn_request request = {.route = route_at(0)};
    int size = asprintf(&request.bytes,
                        "GET %s HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n"
                        "\r\n",
                        path);
    MUST(size > 0);
    request.size = (size_t)size;
    answer_of(out, http_port(http), &request);
    drawn_request_clear(&request);
}

static void start(void) {
    log_set_least(LEVEL_ERROR);
    signal(SIGPIPE, SIG_IGN);
    gsl_set_error_handler_off();
    served_store_make(&served, PRISTINE);
    start_service();
    atexit(leave);
}

/* A study that is deleted is not to be had again. */
static bool deletes(const struct drawn_request *request, const struct answer *answer) {
    return strcmp(request->route->method, "DELETE") == 0 && answer->status == 200 &&
           strstr(request->bytes, "results=true") != NULL;
}

/* Jobs that are held, or are no more. */
static void note_jobs(const struct drawn_request *request, const struct answer *answer) {
    route_handler *handler = request->route->handler;
    if (answer->status != 200)
        return;
    if (handler == handle_claim)
        served_take_jobs(&served, answer->body, answer->size);
    else if (handler == handle_complete || handler == handle_fail || handler == handle_release)
        served_forget_job(&served, request->job);
}

static void count_answer(const struct drawn_request *request, const struct answer *answer,
                         int64_t begun_ms) {
    size_t r = 0;
    while (r < ROUTES_MOST - 1 && route_at(r) != request->route)
        r++;
    asked[r].answers[answer->status / 100]++;
    asked[r].milliseconds += clock_ms() - begun_ms;
}

static void make_request(struct choices *choices) {
    struct drawn_request request;
    struct answer answer;
    draw_request(choices, &served, &request);
    int64_t begun_ms = clock_ms();
    answer_of(&answer, http_port(http), &request);
    answer_judge(&answer, &request);
    count_answer(&request, &answer, begun_ms);
    note_jobs(&request, &answer);
    if (*answer.etag != '\0')
        snprintf(served.etag, sizeof served.etag, "%s", answer.etag);
    requests++;
    anew = anew || deletes(&request, &answer) || requests % ANEW_AFTER == 0;
    drawn_request_clear(&request);
    answer_clear(&answer);
    if (requests % HEALTH_EACH == 0) {
        ask("/healthz", &answer);
        MUST(answer.status == 200);
        answer_clear(&answer);
    }
}

/* The library ends connections after their answers: what it holds of them is no leak. */
static void wait_for_end(void) {
    int64_t until_ms = clock_ms() + PATIENCE_MS;
    while (atomic_load(&service.connections) > 0) {
        MUST(clock_ms() < until_ms);
        (void)poll(NULL, 0, 1);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct choices choices = {data, size};
    if (http == NULL)
        start();
    if (anew) {
        end_service();
        served_forget_jobs(&served);
        start_service();
        anew = false;
    }
    for (size_t n = 0; n < REQUESTS_MOST && choices.left > 0; n++)
        make_request(&choices);
    wait_for_end();
    return 0;
}
