#include "server/http/http.h"
#include "server/http/http_internal.h"
#include "server/http/route/route.h"
#include "worker/clock.h"
#include "worker/log.h"
#include "worker/quiet_thread.h"
#include <arpa/inet.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum {
    HEADERS_MOST = 32 << 10, /* the library's memory a connection */
    STACK = 512 << 10,       /* of a connection's thread: handlers have used 76 KiB of it */
    RESERVE = 32,            /* connections beyond the limit */
    CLOSING_MOST = 512,      /* shut ones whose threads have not ended */
    OTHER_FILES = 512,       /* descriptors of the store, its readers, workers' connections */
    FILES_LEAST = 128,       /* of the store and a few connections beside the reserve */
    LATE_MS = 500,           /* by which a connection may pass its deadline */
    END_MS = 1200,           /* for running requests when the server ends */
};

/* --- connections --- */

/* Before the handshake. The session of a connection that is shut has none, and ends with it. */
static void lend_identity(struct http *http, struct MHD_Connection *connection,
                          struct connection *entry) {
    if (http->options.certificate == NULL)
        return;
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_GNUTLS_SESSION);
    if (entry == NULL)
        gnutls_session_set_ptr(info->tls_session, NULL);
    else
        *connection_identity(entry) =
            certificate_lend(http->options.certificate, info->tls_session);
}

static void on_connection(void *context, struct MHD_Connection *connection, void **slot,
                          enum MHD_ConnectionNotificationCode code) {
    struct http *http = context;
    struct connection *entry = *slot;
    if (code == MHD_CONNECTION_NOTIFY_CLOSED) {
        if (entry != NULL)
            certificate_give_back(http->options.certificate, *connection_identity(entry));
        atomic_fetch_sub(&http->service->connections, entry != NULL);
        connections_remove(http->connections, &entry);
        *slot = NULL;
        return;
    }
    const union MHD_ConnectionInfo *file =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    int socket = file->connect_fd;
    const union MHD_ConnectionInfo *address =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
    *slot =
        connections_add(http->connections, socket, address != NULL ? address->client_addr : NULL);
    lend_identity(http, connection, *slot);
    if (*slot == NULL)
        shutdown(socket, SHUT_RDWR);
    else
        atomic_fetch_add(&http->service->connections, 1);
}

/* Says that connections were closed for want of room; false where none were since the last such
 * report. */
static bool log_crowding(const struct http *http, const struct connection_counts *now,
                         struct connection_counts *told) {
    if (now->evicted == told->evicted && now->refused == told->refused)
        return false;
    log_line(LEVEL_ERROR, NULL,
             "%u connections are open, of %u (--connections): %llu silent ones were closed to make "
             "room, %llu new ones were refused",
             now->open, http->options.connections,
             (unsigned long long)(now->evicted - told->evicted),
             (unsigned long long)(now->refused - told->refused));
    *told = *now;
    return true;
}

/* The library's own timeout counts idleness only: one byte a second would hold a connection for
 * ever. */
static void *watchdog_thread(void *context) {
    enum { CROWDING_MS = 60000 };
    struct http *http = context;
    struct connection_counts told = {0};
    int64_t tell_ms = 0;
    pthread_mutex_lock(&http->mutex);
    while (!http->ending) {
        connections_shut_late(http->connections);
        struct connection_counts counts = connections_count(http->connections);
        atomic_store(&http->service->crowded_out, counts.evicted + counts.refused);
        if (clock_ms() >= tell_ms && log_crowding(http, &counts, &told))
            tell_ms = clock_ms() + CROWDING_MS;
        clock_cond_wait(&http->changed, &http->mutex, clock_ms() + LATE_MS);
    }
    pthread_mutex_unlock(&http->mutex);
    return NULL;
}

/* --- one request and its answer: from its headers, over its body, to its end --- */

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

static struct connection *peer_of(struct MHD_Connection *connection) {
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    return info != NULL ? info->socket_context : NULL;
}

/* A target may be in absolute form, with scheme and host before the path (RFC 9112, 3.2.2): the
 * host is the one that is asked then, whatever the header says. One too long to be a name is cut.
 */
static void read_target(struct exchange *exchange, const char *target) {
    static const char *const SCHEMES[] = {"http://", "https://"};
    const char *host = NULL;
    exchange->path = target;
    for (size_t s = 0; s < sizeof SCHEMES / sizeof *SCHEMES; s++)
        if (strncasecmp(target, SCHEMES[s], strlen(SCHEMES[s])) == 0)
            host = target + strlen(SCHEMES[s]);
    if (host == NULL || *host == '\0' || *host == '/')
        return;
    size_t length = strcspn(host, "/");
    snprintf(exchange->host, sizeof exchange->host, "%.*s", (int)length, host);
    exchange->path = host[length] != '\0' ? host + length : "/";
}

static struct exchange *exchange_create(struct http *http, struct MHD_Connection *connection,
                                        const char *method, const char *target) {
    struct connection *peer = peer_of(connection);
    struct exchange *exchange = peer != NULL ? calloc(1, sizeof *exchange) : NULL;
    if (exchange == NULL)
        return NULL;
    exchange->peer = peer;
    exchange->service = http->service;
    exchange->http = http;
    exchange->connection = connection;
    exchange->method = method;
    read_target(exchange, target);
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

/* Stand in the slot of a request, before its headers are read, where its target is none, and where
 * its path has an escaped slash, which would be two segments once it is read. What else is escaped
 * there, as a letter of "studies", hides nothing from who looks for that alone. */
static char bad_target, slashed_target;

/* The exchange of a request; NULL before it has one. */
static struct exchange *exchange_of(void *slot) {
    return slot != &bad_target && slot != &slashed_target ? slot : NULL;
}

static bool has_escaped_slash(const char *target) {
    const char *slash = strcasestr(target, "%2F");
    return slash != NULL && (size_t)(slash - target) < strcspn(target, "?");
}

/* The library would refuse a space in the target, and a request without a Host, too; but of some
 * refusals of its own it sends the head twice. A target ends where its line has the version. */
static void *on_target(void *context, const char *target, struct MHD_Connection *connection) {
    (void)context;
    (void)connection;
    bool good =
        strchr(target, ' ') == NULL && strncmp(target + strlen(target) + 1, "HTTP/", 5) == 0;
    if (!good)
        return &bad_target;
    return has_escaped_slash(target) ? &slashed_target : NULL;
}

static void on_completed(void *context, struct MHD_Connection *connection, void **slot,
                         enum MHD_RequestTerminationCode code) {
    struct http *http = context;
    struct exchange *exchange = exchange_of(*slot);
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
    for (size_t l = 0; l < HEADER_LISTS; l++)
        free(exchange->lists[l]);
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
                             const char *method, const char *target, const char *version,
                             void **slot) {
    struct exchange *exchange = exchange_create(http, connection, method, target);
    bool is_bad = *slot == &bad_target, is_slashed = *slot == &slashed_target;
    *slot = exchange;
    if (exchange == NULL)
        return MHD_NO;
    exchange->bad_target = is_bad;
    exchange->slashed_target = is_slashed;
    exchange->needs_host = strcmp(version, "HTTP/1.1") == 0;
    route_refuse_early(exchange);
    if (exchange->status == 0)
        reserve_body(exchange);
    /* An answer before the body closes the connection: what an early refusal wants. */
    return exchange->status != 0 ? send_answer(exchange) : MHD_YES;
}

static enum MHD_Result on_request(void *context, struct MHD_Connection *connection,
                                  const char *target, const char *method, const char *version,
                                  const char *data, size_t *size, void **slot) {
    struct exchange *exchange = exchange_of(*slot);
    if (exchange == NULL)
        return begin(context, connection, method, target, version, slot);
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

/* --- the daemon --- */

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
    bool tls = http->options.certificate != NULL;
    if (tls)
        flags |= MHD_USE_TLS;
    sigset_t before;
    quiet_threads_begin(&before);
    http->daemon = MHD_start_daemon(
        flags, http->options.port, NULL, NULL, on_request, http, MHD_OPTION_EXTERNAL_LOGGER,
        no_library_log, NULL, MHD_OPTION_SOCK_ADDR, (struct sockaddr *)&address,
        MHD_OPTION_CONNECTION_LIMIT, http->options.connections + RESERVE + CLOSING_MOST,
        MHD_OPTION_THREAD_STACK_SIZE, (size_t)STACK, MHD_OPTION_CONNECTION_MEMORY_LIMIT,
        (size_t)HEADERS_MOST, MHD_OPTION_NOTIFY_CONNECTION, on_connection, http,
        MHD_OPTION_NOTIFY_COMPLETED, on_completed, http, MHD_OPTION_STRICT_FOR_CLIENT, 0,
        MHD_OPTION_URI_LOG_CALLBACK, on_target, NULL, MHD_OPTION_UNESCAPE_CALLBACK, unescape, NULL,
        MHD_OPTION_LISTEN_BACKLOG_SIZE, 1024u,
        /* without TLS the options end here */
        tls ? MHD_OPTION_HTTPS_PRIORITIES : MHD_OPTION_END, CERTIFICATE_PRIORITIES,
        MHD_OPTION_HTTPS_CERT_CALLBACK2, certificate_retrieve, MHD_OPTION_END);
    quiet_threads_end(&before);
    if (http->daemon == NULL)
        return error_set(err, ERROR_SYSTEM, "cannot listen on %s port %u (in use?)",
                         http->options.address, http->options.port);
    const union MHD_DaemonInfo *info = MHD_get_daemon_info(http->daemon, MHD_DAEMON_INFO_BIND_PORT);
    http->port = info != NULL ? info->port : http->options.port;
    return 0;
}

/* Asks the system for as many files as connections need; where it gives fewer, there are fewer
 * connections. */
static int limit_connections(struct http *http, struct error *err) {
    struct rlimit files;
    const rlim_t others = RESERVE + CLOSING_MOST + OTHER_FILES;
    const rlim_t wanted = http->options.connections + others;
    if (getrlimit(RLIMIT_NOFILE, &files) != 0)
        return error_set(err, ERROR_SYSTEM, "no limit of open files is known: %s", strerror(errno));
    if (files.rlim_cur < wanted) {
        files.rlim_cur = wanted < files.rlim_max ? wanted : files.rlim_max;
        if (setrlimit(RLIMIT_NOFILE, &files) != 0)
            (void)getrlimit(RLIMIT_NOFILE, &files);
    }
    if (files.rlim_cur >= wanted)
        return 0;
    if (files.rlim_cur < FILES_LEAST)
        return error_set(err, ERROR_SYSTEM,
                         "%llu open files are too few for a server, which needs %d: see ulimit -n",
                         (unsigned long long)files.rlim_cur, FILES_LEAST);
    unsigned left =
        files.rlim_cur > others + RESERVE ? (unsigned)(files.rlim_cur - others) : RESERVE;
    if (left < http->options.connections)
        log_line(LEVEL_ERROR, NULL,
                 "%u connections at a time, not %u: the limit of open files is %llu (ulimit -n)",
                 left, http->options.connections, (unsigned long long)files.rlim_cur);
    http->options.connections = left < http->options.connections ? left : http->options.connections;
    return 0;
}

static int start(struct http *http, struct error *err) {
    int status = limit_connections(http, err);
    const struct connection_limits limits = {.most = http->options.connections,
                                             .reserve = RESERVE,
                                             .per_address = http->options.per_address,
                                             .deadline_ms =
                                                 1000 * (int64_t)http->options.deadline_s};
    if (status == 0)
        status = connections_create(&http->connections, &limits, err);
    if (status == 0 && clock_cond_init(&http->changed) != 0)
        status = error_set(err, ERROR_SYSTEM, "no condition variable");
    if (status == 0)
        status = start_daemon(http, err);
    if (status == 0 && quiet_thread_start(&http->watchdog, watchdog_thread, http) != 0) {
        MHD_stop_daemon(http->daemon);
        status = error_set(err, ERROR_SYSTEM, "cannot start the watchdog's thread");
    }
    if (status != 0)
        connections_destroy(&http->connections);
    return status;
}

int http_start(struct http **out, struct service *service, const struct http_options *options,
               struct error *err) {
    struct http *http = array_create(1, sizeof *http);
    if (http == NULL)
        return error_memory(err, sizeof *http, "the HTTP service");
    http->service = service;
    http->options = *options;
    pthread_mutex_init(&http->mutex, NULL);
    int status = start(http, err);
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
    connections_destroy(&h->connections);
    pthread_mutex_destroy(&h->mutex);
    pthread_cond_destroy(&h->changed);
    free(h);
    *http = NULL;
}
