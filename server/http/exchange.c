/* One request and its answer at a time: from its headers, over its body, to its end. */
#include "server/http/http_internal.h"
#include "server/http/route.h"
#include "worker/clock.h"
#include "worker/log.h"
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

enum {
    BODY_MOST = 16 << 20,
    BODY_SMALL = 64 << 10,   /* always taken: heartbeats must not wait for large bodies */
    BODIES_MOST = 256 << 20, /* of all larger ones at a time */
};

static int64_t now_ns(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static void count_request(struct http *http, int change) {
    pthread_mutex_lock(&http->mutex);
    http->requests = (unsigned)((int)http->requests + change);
    if (http->stopping) /* else the watchdog would walk its list twice a request */
        pthread_cond_broadcast(&http->changed);
    pthread_mutex_unlock(&http->mutex);
}

static int socket_of(struct MHD_Connection *connection) {
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    return info != NULL ? info->connect_fd : -1;
}

static struct connection *peer_of(struct MHD_Connection *connection) {
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    return info != NULL ? info->socket_context : NULL;
}

static struct exchange *exchange_create(struct http *http, struct MHD_Connection *connection,
                                        const char *method, const char *path) {
    struct connection *peer = peer_of(connection);
    struct exchange *exchange = peer != NULL ? calloc(1, sizeof *exchange) : NULL;
    if (exchange == NULL)
        return NULL;
    exchange->peer = peer;
    exchange->service = http->service;
    exchange->http = http;
    exchange->connection = connection;
    exchange->method = method;
    exchange->path = path;
    exchange->start_ns = now_ns();
    exchange->body_most = BODY_MOST;
    exchange_renew(exchange);
    count_request(http, 1);
    return exchange;
}

/* Idle workers ask for a job again and again, and get none: nobody looks for that. */
static bool is_idle_claim(const struct exchange *exchange) {
    return exchange->status == 204 && strcmp(exchange->path, "/v1/jobs/claim") == 0;
}

static void log_exchange(const struct exchange *exchange, bool whole) {
    char request[160];
    enum log_level level = exchange->status >= 500            ? LEVEL_ERROR
                           : whole && is_idle_claim(exchange) ? LEVEL_DEBUG
                                                              : LEVEL_INFO;
    snprintf(request, sizeof request, "%.16s %.120s", exchange->method, exchange->path);
    struct log_about about = {.request = request,
                              .status = (long)exchange->status,
                              .seconds = 1e-9 * (double)(now_ns() - exchange->start_ns)};
    log_line(level, &about, whole ? "answered" : "cut off");
}

/* Files are few at a time, and take no room of what workers send. */
static size_t bytes_counted(const struct exchange *exchange) {
    return exchange->body_room > BODY_SMALL && !exchange->has_file ? exchange->body_room : 0;
}

/* A worker that has just had an answer about jobs may hold one, until its lease runs out. */
static void note_lease(struct exchange *exchange) {
    if (exchange->status == 200 && strncmp(exchange->path, "/v1/jobs/", 9) == 0)
        connection_leases(exchange->http->connections, exchange->peer,
                          clock_ms() + exchange->service->lease_ms);
}

void exchange_on_completed(void *context, struct MHD_Connection *connection, void **slot,
                           enum MHD_RequestTerminationCode code) {
    struct http *http = context;
    struct exchange *exchange = *slot;
    (void)connection;
    if (exchange == NULL)
        return;
    unsigned hundred = exchange->status / 100;
    if (hundred < STATUS_CLASSES)
        atomic_fetch_add(&http->service->answers[hundred], 1);
    log_exchange(exchange, code == MHD_REQUEST_TERMINATED_COMPLETED_OK);
    if (exchange->response != NULL)
        MHD_destroy_response(exchange->response);
    atomic_fetch_sub(&http->bodies, bytes_counted(exchange));
    characterise_leave(exchange);
    claim_settle(exchange, code == MHD_REQUEST_TERMINATED_COMPLETED_OK);
    note_lease(exchange);
    connection_set(http->connections, exchange->peer, CONNECTION_IDLE);
    free(exchange->body);
    free(exchange);
    *slot = NULL;
    count_request(http, -1);
}

static enum MHD_Result send_answer(struct exchange *exchange) {
    if (exchange->response == NULL)
        return MHD_NO; /* out of memory for any answer: the connection is closed */
    if (atomic_load(&exchange->service->stopping) || connection_is_reserved(exchange->peer))
        answer_header(exchange, "Connection", "close");
    enum MHD_Result queued =
        MHD_queue_response(exchange->connection, exchange->status, exchange->response);
    MHD_destroy_response(exchange->response);
    exchange->response = NULL;
    return queued;
}

/* Room for the body that is announced, or for the largest one where chunks come without a length.
 */
static void reserve_body(struct exchange *exchange) {
    const char *length = exchange_header(exchange, "Content-Length");
    unsigned long long room = length != NULL ? strtoull(length, NULL, 10) : 0;
    if (length == NULL && exchange_header(exchange, "Transfer-Encoding") != NULL)
        room = exchange->body_most;
    if (room > exchange->body_most) {
        char detail[64];
        snprintf(detail, sizeof detail, "a body may have up to %zu MiB", exchange->body_most >> 20);
        answer_problem(exchange, 413, detail, NULL);
        return;
    }
    exchange->body_room = (size_t)room;
    size_t bytes = bytes_counted(exchange); /* given back by on_completed */
    if (atomic_fetch_add(&exchange->http->bodies, bytes) + bytes > BODIES_MOST && bytes != 0)
        answer_problem(exchange, 503, "too many large bodies at a time", NULL);
}

static bool keep_body(struct exchange *exchange, const char *data, size_t size) {
    if (size > exchange->body_room - exchange->body_size)
        return false;
    if (exchange->body == NULL && (exchange->body = malloc(exchange->body_room + 1)) == NULL)
        return false;
    memcpy(exchange->body + exchange->body_size, data, size);
    exchange->body_size += size;
    exchange->body[exchange->body_size] = 0;
    return true;
}

static enum MHD_Result begin(struct http *http, struct MHD_Connection *connection,
                             const char *method, const char *path, void **slot) {
    struct exchange *exchange = exchange_create(http, connection, method, path);
    *slot = exchange;
    if (exchange == NULL)
        return MHD_NO;
    route_refuse_early(exchange);
    if (exchange->status == 0)
        reserve_body(exchange);
    /* An answer before the body closes the connection: what an early refusal wants. */
    return exchange->status != 0 ? send_answer(exchange) : MHD_YES;
}

enum MHD_Result exchange_on_request(void *context, struct MHD_Connection *connection,
                                    const char *path, const char *method, const char *version,
                                    const char *data, size_t *size, void **slot) {
    struct exchange *exchange = *slot;
    (void)version;
    if (exchange == NULL)
        return begin(context, connection, method, path, slot);
    if (*size != 0) {
        /* A chunked body past the cap can only be cut. */
        bool kept = keep_body(exchange, data, *size);
        *size = 0;
        return kept ? MHD_YES : MHD_NO;
    }
    int64_t start_ns = now_ns();
    connection_set(exchange->http->connections, exchange->peer, CONNECTION_WORKS);
    route_answer(exchange);
    exchange_renew(exchange);
    atomic_fetch_add(&exchange->service->nanoseconds, (uint_fast64_t)(now_ns() - start_ns));
    return send_answer(exchange);
}

void exchange_renew(struct exchange *exchange) {
    connection_set(exchange->http->connections, exchange->peer,
                   exchange->status == 0 ? CONNECTION_TAKES : CONNECTION_SENDS);
}

void exchange_vouch(struct exchange *exchange) {
    connection_vouch(exchange->http->connections, exchange->peer);
}

bool exchange_is_reserved(const struct exchange *exchange) {
    return connection_is_reserved(exchange->peer);
}

bool exchange_takes_turn(struct exchange *exchange) {
    return connection_takes_turn(exchange->http->connections, exchange->peer);
}

int exchange_is_lost(void *context) {
    const struct exchange *exchange = context;
    struct pollfd peer = {.fd = exchange_socket(exchange), .events = POLLRDHUP};
    return atomic_load(&exchange->service->stopping) || poll(&peer, 1, 0) > 0;
}

int exchange_reader(struct exchange *exchange, struct store **out, struct error *err) {
    return service_reader_until(exchange->service, exchange_is_lost, exchange, out, err);
}

const char *exchange_query(const struct exchange *exchange, const char *name) {
    return MHD_lookup_connection_value(exchange->connection, MHD_GET_ARGUMENT_KIND, name);
}

/* A connection of the reserve is not kept waiting, as a claim may ask for. */
const char *exchange_header(const struct exchange *exchange, const char *name) {
    if (connection_is_reserved(exchange->peer) && strcasecmp(name, "Prefer") == 0)
        return NULL;
    return MHD_lookup_connection_value(exchange->connection, MHD_HEADER_KIND, name);
}

int exchange_socket(const struct exchange *exchange) {
    return socket_of(exchange->connection);
}
