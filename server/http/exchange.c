/* What routes ask of a request, and of the connection that it came by. */
#include "server/http/exchange.h"
#include "server/http/http_internal.h"
#include <arpa/inet.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

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

/* Those of the lists that the server reads. */
static const char *const LIST_NAMES[HEADER_LISTS] = {"Accept", "Accept-Encoding", "If-None-Match",
                                                     "Prefer"};

static size_t list_of(const char *name) {
    size_t l = 0;
    while (l < HEADER_LISTS && strcasecmp(LIST_NAMES[l], name) != 0)
        l++;
    return l;
}

/* For want of memory a list ends early. */
void exchange_join(struct exchange *exchange, const char *name, const char *value) {
    size_t l = list_of(name);
    const char *before = l < HEADER_LISTS ? exchange_header(exchange, name) : NULL;
    char *both;
    if (before == NULL || value == NULL || value == before)
        return;
    if (asprintf(&both, "%s, %s", before, value) < 0)
        return;
    free(exchange->lists[l]);
    exchange->lists[l] = both;
}

/* A connection of the reserve is not kept waiting, as a claim may ask for. */
const char *exchange_header(const struct exchange *exchange, const char *name) {
    if (connection_is_reserved(exchange->peer) && strcasecmp(name, "Prefer") == 0)
        return NULL;
    size_t l = list_of(name);
    if (l < HEADER_LISTS && exchange->lists[l] != NULL)
        return exchange->lists[l];
    return MHD_lookup_connection_value(exchange->connection, MHD_HEADER_KIND, name);
}

int exchange_socket(const struct exchange *exchange) {
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(exchange->connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    return info != NULL ? info->connect_fd : -1;
}

/* Writes the name in a Host header without its port and brackets. */
static void host_name(const char *host, char *name, size_t size) {
    size_t length = *host == '[' ? strcspn(host + 1, "]") : strcspn(host, ":");
    snprintf(name, size, "%.*s", (int)length, host + (*host == '['));
}

bool exchange_host_allowed(const struct exchange *exchange, const char *host) {
    const struct http_options *options = &exchange->http->options;
    unsigned char address[sizeof(struct in6_addr)];
    char name[256];
    host_name(host, name, sizeof name);
    /* An address is no name that somebody else's DNS could have pointed here. */
    if (strcasecmp(name, "localhost") == 0 || inet_pton(AF_INET, name, address) == 1 ||
        inet_pton(AF_INET6, name, address) == 1)
        return true;
    for (const char *const *allowed = options->hosts; allowed != NULL && *allowed != NULL;
         allowed++)
        if (strcasecmp(*allowed, name) == 0)
            return true;
    /* The server's own certificate has its names as well. */
    return options->certificate != NULL && certificate_names(options->certificate, name);
}
