#include "server/http/http.h"
#include "server/http/http_internal.h"
#include "worker/clock.h"
#include "worker/log.h"
#include <arpa/inet.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

enum {
    HEADERS_MOST = 32 << 10, /* the library's memory a connection */
    STACK = 512 << 10,       /* of a connection's thread: handlers have used 76 KiB of it */
    RESERVE = 32,            /* connections beyond the limit */
    CLOSING_MOST = 512,      /* shut ones whose threads have not ended */
    OTHER_FILES = 512,       /* descriptors of the store, its readers, workers' connections */
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

/* Says that connections were closed for want of room; false where none were since it was told. */
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

/* --- the daemon --- */

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
    /* The server's own certificate tells its names as well. */
    return http->options.certificate != NULL && certificate_names(http->options.certificate, name);
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
    bool tls = http->options.certificate != NULL;
    if (tls)
        flags |= MHD_USE_TLS;
    http->daemon = MHD_start_daemon(
        flags, http->options.port, NULL, NULL, exchange_on_request, http,
        MHD_OPTION_EXTERNAL_LOGGER, no_library_log, NULL, MHD_OPTION_SOCK_ADDR,
        (struct sockaddr *)&address, MHD_OPTION_CONNECTION_LIMIT,
        http->options.connections + RESERVE + CLOSING_MOST, MHD_OPTION_THREAD_STACK_SIZE,
        (size_t)STACK, MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)HEADERS_MOST,
        MHD_OPTION_NOTIFY_CONNECTION, on_connection, http, MHD_OPTION_NOTIFY_COMPLETED,
        exchange_on_completed, http, MHD_OPTION_STRICT_FOR_CLIENT, 1, MHD_OPTION_UNESCAPE_CALLBACK,
        unescape, NULL, MHD_OPTION_LISTEN_BACKLOG_SIZE, 1024u,
        /* without TLS the options end here */
        tls ? MHD_OPTION_HTTPS_PRIORITIES : MHD_OPTION_END, CERTIFICATE_PRIORITIES,
        MHD_OPTION_HTTPS_CERT_CALLBACK2, certificate_retrieve, MHD_OPTION_END);
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
    if (status == 0 && pthread_create(&http->watchdog, NULL, watchdog_thread, http) != 0) {
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
