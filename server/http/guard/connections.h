/* The open connections of a server, and which of them may stay: each has a deadline, all have a
 * limit, each address has a share, and beyond the limit there is a reserve.
 *
 * At the limit a new connection replaces the one that is missed least: first of those that nobody
 * has vouched for (no request of theirs was let in), then of those without a request, in both the
 * one silent longest. It never replaces one whose request is being answered, or whose worker holds
 * a lease. Where all are needed the new one is of the reserve: its requests are answered as far as
 * route.c lets them in there, and it ends with its answer.
 *
 * Safe from many threads. At the limit a new connection costs a walk over all others. */
#ifndef RUGO_SERVER_HTTP_GUARD_CONNECTIONS_H
#define RUGO_SERVER_HTTP_GUARD_CONNECTIONS_H

#include "core/error.h"
#include <stdbool.h>
#include <stdint.h>
#include <sys/socket.h>

struct connection_limits {
    unsigned most, reserve;
    unsigned per_address; /* of peers beyond this machine; 0: no limit */
    int64_t deadline_ms;  /* for a request */
};

enum connection_state {
    CONNECTION_IDLE,  /* no request, or not all of its headers */
    CONNECTION_TAKES, /* a body */
    CONNECTION_WORKS, /* the answer is being made: the time is the server's */
    CONNECTION_SENDS,
};

struct certificate_identity;
struct connections;
struct connection;

int connections_create(struct connections **out, const struct connection_limits *limits,
                       struct error *err);
/* Of no connections any more. */
void connections_destroy(struct connections **connections);

/* Takes a new connection in, whose socket stays the caller's; NULL where it is to be shut. */
struct connection *connections_add(struct connections *connections, int socket,
                                   const struct sockaddr *address);
void connections_remove(struct connections *connections, struct connection **connection);

/* Each change begins the deadline of its state anew. */
void connection_set(struct connections *connections, struct connection *connection,
                    enum connection_state state);
void connection_vouch(struct connections *connections, struct connection *connection);
/* Its worker has had an answer about its jobs now, and may hold leases until then. */
void connection_leases(struct connections *connections, struct connection *connection,
                       int64_t until_ms);
/* What its TLS session was lent, kept here for the caller; NULL at first. */
struct certificate_identity **connection_identity(struct connection *connection);
bool connection_is_reserved(const struct connection *connection);
/* Of all connections of the reserve one at a time may ask for anything, until it is idle. */
bool connection_takes_turn(struct connections *connections, struct connection *connection);

/* Shuts the sockets of those past their deadlines. */
void connections_shut_late(struct connections *connections);
struct connection_counts {
    unsigned open;             /* but those shut */
    uint64_t evicted, refused; /* for want of room, since the start */
};
struct connection_counts connections_count(struct connections *connections);

#endif
