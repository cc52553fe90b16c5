#include "server/http/http.h"
#include "worker/clock.h"
#include "worker/log.h"
#include <arpa/inet.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum {
    BODY_MOST = 16 << 20,
    BODY_SMALL = 64 << 10,   /* always taken: heartbeats must not wait for large bodies */
    BODIES_MOST = 256 << 20, /* of all larger ones at a time */
    HEADERS_MOST = 32 << 10, /* the library's memory a connection */
    IDLE_MS = 60000,         /* between two requests of a connection */
    END_MS = 10000,          /* for running requests when the server ends */
};

/* The library's own timeout counts idleness only: one byte a second would hold a connection for
 * ever. So each connection has a deadline, and a watchdog shuts those past it. */
struct connection {
    int socket;
    int64_t deadline_ms;
    struct connection *next, **link;
};

struct http {
    struct service *service;
    struct http_options options;
    struct MHD_Daemon *daemon;
    uint16_t port;
    pthread_t watchdog;
    pthread_mutex_t mutex; /* guards the list, requests, stopping and ending */
    pthread_cond_t changed;
    struct connection *connections;
    unsigned requests; /* being answered */
    bool stopping;     /* http_stop waits for the requests */
    bool ending;
    atomic_size_t bodies; /* bytes that running requests with larger bodies may bring */
};

static int64_t now_ns(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

/* --- connections --- */

static int socket_of(struct MHD_Connection *connection) {
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    return info != NULL ? info->connect_fd : -1;
}

static void on_connection(void *context, struct MHD_Connection *connection, void **slot,
                          enum MHD_ConnectionNotificationCode code) {
    struct http *http = context;
    struct connection *entry = *slot;
    if (code == MHD_CONNECTION_NOTIFY_CLOSED) {
        if (entry == NULL)
            return;
        pthread_mutex_lock(&http->mutex);
        *entry->link = entry->next;
        if (entry->next != NULL)
            entry->next->link = entry->link;
        pthread_mutex_unlock(&http->mutex);
        atomic_fetch_sub(&http->service->connections, 1);
        free(entry);
        *slot = NULL;
        return;
    }
    int socket = socket_of(connection);
    entry = calloc(1, sizeof *entry);
    if (entry == NULL) {
        shutdown(socket, SHUT_RDWR); /* it would have no deadline */
        return;
    }
    entry->socket = socket;
    entry->deadline_ms = clock_ms() + 1000 * (int64_t)http->options.deadline_s;
    pthread_mutex_lock(&http->mutex);
    entry->next = http->connections;
    entry->link = &http->connections;
    if (entry->next != NULL)
        entry->next->link = &entry->next;
    http->connections = entry;
    pthread_mutex_unlock(&http->mutex);
    atomic_fetch_add(&http->service->connections, 1);
    *slot = entry;
}

static void set_deadline(struct http *http, struct MHD_Connection *connection,
                         int64_t deadline_ms) {
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    struct connection *entry = info != NULL ? info->socket_context : NULL;
    if (entry == NULL)
        return;
    pthread_mutex_lock(&http->mutex);
    entry->deadline_ms = deadline_ms;
    pthread_mutex_unlock(&http->mutex);
}

void exchange_renew(struct exchange *exchange) {
    int64_t time = 1000 * (int64_t)exchange->http->options.deadline_s;
    set_deadline(exchange->http, exchange->connection, clock_ms() + time);
}

static void *watchdog_thread(void *context) {
    struct http *http = context;
    pthread_mutex_lock(&http->mutex);
    while (!http->ending) {
        int64_t now = clock_ms();
        for (struct connection *entry = http->connections; entry != NULL; entry = entry->next)
            if (entry->deadline_ms <= now) {
                shutdown(entry->socket, SHUT_RDWR);
                entry->deadline_ms = INT64_MAX; /* once is enough */
            }
        clock_cond_wait(&http->changed, &http->mutex, now + 500);
    }
    pthread_mutex_unlock(&http->mutex);
    return NULL;
}

/* --- exchanges --- */

static void count_request(struct http *http, int change) {
    pthread_mutex_lock(&http->mutex);
    http->requests = (unsigned)((int)http->requests + change);
    if (http->stopping) /* else the watchdog would walk its list twice a request */
        pthread_cond_broadcast(&http->changed);
    pthread_mutex_unlock(&http->mutex);
}

static struct exchange *exchange_create(struct http *http, struct MHD_Connection *connection,
                                        const char *method, const char *path) {
    struct exchange *exchange = calloc(1, sizeof *exchange);
    if (exchange == NULL)
        return NULL;
    exchange->service = http->service;
    exchange->http = http;
    exchange->connection = connection;
    exchange->method = method;
    exchange->path = path;
    exchange->start_ns = now_ns();
    exchange_renew(exchange);
    count_request(http, 1);
    return exchange;
}

/* Idle workers ask for a job several times a second, and get none: nobody looks for that. */
static bool is_idle_claim(const struct exchange *exchange) {
    return exchange->status == 204 && strcmp(exchange->path, "/v1/jobs/claim") == 0;
}

static void log_exchange(const struct exchange *exchange, bool whole) {
    char request[160];
    if (whole && is_idle_claim(exchange))
        return;
    snprintf(request, sizeof request, "%.16s %.120s", exchange->method, exchange->path);
    struct log_about about = {.request = request,
                              .status = (long)exchange->status,
                              .seconds = 1e-9 * (double)(now_ns() - exchange->start_ns)};
    log_line(exchange->status >= 500 ? LEVEL_ERROR : LEVEL_INFO, &about,
             whole ? "answered" : "cut off");
}

static size_t bytes_counted(const struct exchange *exchange) {
    return exchange->body_room > BODY_SMALL ? exchange->body_room : 0;
}

static void on_completed(void *context, struct MHD_Connection *connection, void **slot,
                         enum MHD_RequestTerminationCode code) {
    struct http *http = context;
    struct exchange *exchange = *slot;
    if (exchange == NULL)
        return;
    unsigned hundred = exchange->status / 100;
    if (hundred < STATUS_CLASSES)
        atomic_fetch_add(&http->service->answers[hundred], 1);
    log_exchange(exchange, code == MHD_REQUEST_TERMINATED_COMPLETED_OK);
    if (exchange->response != NULL)
        MHD_destroy_response(exchange->response);
    atomic_fetch_sub(&http->bodies, bytes_counted(exchange));
    free(exchange->body);
    free(exchange);
    *slot = NULL;
    count_request(http, -1);
    set_deadline(http, connection, clock_ms() + IDLE_MS);
}

static enum MHD_Result send_answer(struct exchange *exchange) {
    if (exchange->response == NULL)
        return MHD_NO; /* out of memory for any answer: the connection is closed */
    if (atomic_load(&exchange->service->stopping))
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
        room = BODY_MOST;
    if (room > BODY_MOST) {
        answer_problem(exchange, 413, "a body may have up to 16 MiB", NULL);
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

static enum MHD_Result on_request(void *context, struct MHD_Connection *connection,
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
    set_deadline(exchange->http, connection, INT64_MAX); /* the work is ours, not the peer's */
    route_answer(exchange);
    exchange_renew(exchange);
    atomic_fetch_add(&exchange->service->nanoseconds, (uint_fast64_t)(now_ns() - start_ns));
    return send_answer(exchange);
}

const char *exchange_query(const struct exchange *exchange, const char *name) {
    return MHD_lookup_connection_value(exchange->connection, MHD_GET_ARGUMENT_KIND, name);
}

const char *exchange_header(const struct exchange *exchange, const char *name) {
    return MHD_lookup_connection_value(exchange->connection, MHD_HEADER_KIND, name);
}

int exchange_socket(const struct exchange *exchange) {
    return socket_of(exchange->connection);
}

/* --- start and stop --- */

/* Writes the name in a Host header without its port and brackets. */
static void host_name(const char *host, char *name, size_t size) {
    size_t length = *host == '[' ? strcspn(host + 1, "]") : strcspn(host, ":");
    snprintf(name, size, "%.*s", (int)length, host + (*host == '['));
}

bool http_host_allowed(const struct http *http, const char *host) {
    unsigned char address[sizeof(struct in6_addr)];
    char name[256];
    host_name(host, name, sizeof name);
    /* An address is no name that somebody else's DNS could have pointed here. */
    if (strcasecmp(name, "localhost") == 0 || inet_pton(AF_INET, name, address) == 1 ||
        inet_pton(AF_INET6, name, address) == 1)
        return true;
    for (const char *const *allowed = http->options.hosts; allowed != NULL && *allowed != NULL;
         allowed++)
        if (strcasecmp(*allowed, name) == 0)
            return true;
    return false;
}

static bool socket_address(const struct http_options *options, struct sockaddr_storage *storage) {
    struct sockaddr_in *v4 = (struct sockaddr_in *)storage;
    struct sockaddr_in6 *v6 = (struct sockaddr_in6 *)storage;
    memset(storage, 0, sizeof *storage);
    if (inet_pton(AF_INET, options->address, &v4->sin_addr) == 1) {
        v4->sin_family = AF_INET;
        v4->sin_port = htons(options->port);
        return true;
    }
    if (inet_pton(AF_INET6, options->address, &v6->sin6_addr) == 1) {
        v6->sin6_family = AF_INET6;
        v6->sin6_port = htons(options->port);
        return true;
    }
    return false;
}

/* An escaped NUL would cut the text short and make one path another's: it stays as it is. */
static size_t unescape(void *context, struct MHD_Connection *connection, char *text) {
    (void)context;
    (void)connection;
    return strstr(text, "%00") != NULL ? strlen(text) : MHD_http_unescape(text);
}

static void no_library_log(void *context, const char *format, va_list arguments) {
    (void)context;
    (void)format;
    (void)arguments; /* broken requests are the peer's affair; ours are logged by on_completed */
}

static int start_daemon(struct http *http, struct error *err) {
    struct sockaddr_storage address;
    if (!socket_address(&http->options, &address))
        return error_set(err, ERROR_INPUT, "%s is no address to listen on", http->options.address);
    unsigned flags = MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_THREAD_PER_CONNECTION |
                     MHD_USE_POLL | MHD_USE_ITC | MHD_USE_ERROR_LOG;
    if (address.ss_family == AF_INET6)
        flags |= MHD_USE_IPv6;
    http->daemon = MHD_start_daemon(
        flags, http->options.port, NULL, NULL, on_request, http, MHD_OPTION_EXTERNAL_LOGGER,
        no_library_log, NULL, MHD_OPTION_SOCK_ADDR, (struct sockaddr *)&address,
        MHD_OPTION_CONNECTION_LIMIT, http->options.connections, MHD_OPTION_PER_IP_CONNECTION_LIMIT,
        http->options.per_address, MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)HEADERS_MOST,
        MHD_OPTION_NOTIFY_CONNECTION, on_connection, http, MHD_OPTION_NOTIFY_COMPLETED,
        on_completed, http, MHD_OPTION_STRICT_FOR_CLIENT, 1, MHD_OPTION_UNESCAPE_CALLBACK, unescape,
        NULL, MHD_OPTION_LISTEN_BACKLOG_SIZE, 128u, MHD_OPTION_END);
    if (http->daemon == NULL)
        return error_set(err, ERROR_SYSTEM, "cannot listen on %s port %u (in use?)",
                         http->options.address, http->options.port);
    const union MHD_DaemonInfo *info = MHD_get_daemon_info(http->daemon, MHD_DAEMON_INFO_BIND_PORT);
    http->port = info != NULL ? info->port : http->options.port;
    return 0;
}

int http_start(struct http **out, struct service *service, const struct http_options *options,
               struct error *err) {
    struct http *http = array_create(1, sizeof *http);
    if (http == NULL)
        return error_memory(err, sizeof *http, "the HTTP service");
    http->service = service;
    http->options = *options;
    pthread_mutex_init(&http->mutex, NULL);
    int status = clock_cond_init(&http->changed) != 0
                     ? error_set(err, ERROR_SYSTEM, "no condition variable")
                     : start_daemon(http, err);
    if (status == 0 && pthread_create(&http->watchdog, NULL, watchdog_thread, http) != 0) {
        MHD_stop_daemon(http->daemon);
        status = error_set(err, ERROR_SYSTEM, "cannot start the watchdog's thread");
    }
    if (status != 0) {
        free(http);
        return status;
    }
    *out = http;
    return 0;
}

uint16_t http_port(const struct http *http) {
    return http->port;
}

void http_stop(struct http **http) {
    struct http *h = *http;
    if (h == NULL)
        return;
    MHD_socket listening = MHD_quiesce_daemon(h->daemon);
    int64_t until = clock_ms() + END_MS;
    pthread_mutex_lock(&h->mutex);
    h->stopping = true;
    while (h->requests != 0 && clock_ms() < until)
        clock_cond_wait(&h->changed, &h->mutex, until);
    h->ending = true;
    pthread_cond_broadcast(&h->changed);
    pthread_mutex_unlock(&h->mutex);
    pthread_join(h->watchdog, NULL);
    MHD_stop_daemon(h->daemon);
    if (listening != MHD_INVALID_SOCKET)
        close(listening);
    pthread_mutex_destroy(&h->mutex);
    pthread_cond_destroy(&h->changed);
    free(h);
    *http = NULL;
}
