#include "server/http/guard/connections.h"
#include "worker/clock.h"
#include <netinet/in.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { IDLE_MS = 60000 }; /* between two requests of a connection */

/* Where peers come from: an IPv4 address, or the 64 bits of an IPv6 one that a site has; zeros on
 * this machine, whose peers may stand for others (a proxy). */
struct origin_address {
    unsigned char bytes[8];
};

struct connection {
    struct certificate_identity *identity; /* kept for the caller */
    int socket;
    struct origin_address address;
    enum connection_state state;
    bool vouched, reserved, shut;
    int64_t deadline_ms;
    int64_t since_ms;       /* it was opened, or its last request was over */
    int64_t lease_until_ms; /* its worker may hold a lease; 0: none */
    struct connection *next, **link;
};

struct connections {
    struct connection_limits limits;
    pthread_mutex_t mutex; /* guards all below, and what the connections hold */
    struct connection *first;
    struct connection *turn;     /* the one of the reserve that may ask for anything; NULL: none */
    unsigned ordinary, reserved; /* but those shut */
    uint64_t evicted, refused;
};

static struct origin_address address_of(const struct sockaddr *address) {
    struct origin_address origin = {{0}};
    if (address != NULL && address->sa_family == AF_INET) {
        const struct sockaddr_in *v4 = (const void *)address;
        if (ntohl(v4->sin_addr.s_addr) >> 24 != 127)
            memcpy(origin.bytes, &v4->sin_addr, 4);
    } else if (address != NULL && address->sa_family == AF_INET6) {
        const struct in6_addr *v6 =
            &((const struct sockaddr_in6 *)(const void *)address)->sin6_addr;
        if (IN6_IS_ADDR_V4MAPPED(v6) && v6->s6_addr[12] != 127)
            memcpy(origin.bytes, v6->s6_addr + 12, 4);
        else if (!IN6_IS_ADDR_LOOPBACK(v6) && !IN6_IS_ADDR_V4MAPPED(v6))
            memcpy(origin.bytes, v6->s6_addr, 8);
    }
    return origin;
}

static bool same_address(const struct origin_address *a, const struct origin_address *b) {
    return memcmp(a->bytes, b->bytes, sizeof a->bytes) == 0;
}

static bool is_here(const struct origin_address *address) {
    static const struct origin_address HERE = {{0}};
    return same_address(address, &HERE);
}

/* --- who goes --- */

static bool is_needed(const struct connection *connection, int64_t now_ms) {
    return connection->state == CONNECTION_WORKS || connection->lease_until_ms > now_ms ||
           (connection->state == CONNECTION_SENDS && connection->vouched);
}

/* Returns whether one goes rather than the candidate so far, which may be NULL. The list has the
 * newest in front: of equally old ones the last goes. */
static bool goes_rather(const struct connection *one, const struct connection *candidate) {
    if (candidate == NULL || one->vouched != candidate->vouched)
        return candidate == NULL || !one->vouched;
    return one->since_ms <= candidate->since_ms;
}

struct candidates {
    struct connection *ordinary, *reserved, *neighbour; /* to go; NULL: all are needed */
    unsigned neighbours;                                /* of the same address */
};

static struct candidates find_candidates(const struct connections *connections,
                                         const struct origin_address *address) {
    struct candidates found = {0};
    int64_t now_ms = clock_ms();
    for (struct connection *one = connections->first; one != NULL; one = one->next) {
        if (one->shut)
            continue;
        bool neighbour = same_address(&one->address, address);
        found.neighbours += neighbour;
        if (is_needed(one, now_ms))
            continue;
        struct connection **of_kind = one->reserved ? &found.reserved : &found.ordinary;
        if (goes_rather(one, *of_kind))
            *of_kind = one;
        if (neighbour && goes_rather(one, found.neighbour))
            found.neighbour = one;
    }
    return found;
}

/* Its thread finds the socket shut, and ends. */
static void shut(struct connections *connections, struct connection *connection) {
    if (connection->shut)
        return;
    connection->shut = true;
    shutdown(connection->socket, SHUT_RDWR);
    if (connection->reserved)
        connections->reserved--;
    else
        connections->ordinary--;
}

/* --- who comes --- */

/* Makes room for a new one; false where there is none. */
static bool make_room(struct connections *connections, struct connection *entry) {
    const struct connection_limits *limits = &connections->limits;
    bool full = connections->ordinary >= limits->most;
    bool share = limits->per_address != 0 && !is_here(&entry->address);
    if (!full && !share)
        return true;
    struct candidates found = find_candidates(connections, &entry->address);
    struct connection *going = NULL;
    if (share && found.neighbours >= limits->per_address) {
        going = found.neighbour;
        if (going == NULL)
            return false;
    } else if (full && found.ordinary != NULL) {
        going = found.ordinary;
    } else if (full && connections->reserved >= limits->reserve) {
        going = found.reserved;
        if (going == NULL)
            return false;
    }
    if (going != NULL) {
        shut(connections, going);
        connections->evicted++;
    }
    entry->reserved = connections->ordinary >= limits->most;
    return true;
}

static void insert(struct connections *connections, struct connection *entry) {
    entry->next = connections->first;
    entry->link = &connections->first;
    if (entry->next != NULL)
        entry->next->link = &entry->next;
    connections->first = entry;
    if (entry->reserved)
        connections->reserved++;
    else
        connections->ordinary++;
}

struct connection *connections_add(struct connections *connections, int socket,
                                   const struct sockaddr *address) {
    struct connection *entry = calloc(1, sizeof *entry);
    if (entry == NULL)
        return NULL; /* it would have no deadline */
    entry->socket = socket;
    entry->address = address_of(address);
    entry->since_ms = clock_ms();
    entry->deadline_ms = entry->since_ms + connections->limits.deadline_ms;
    pthread_mutex_lock(&connections->mutex);
    bool room = make_room(connections, entry);
    if (room)
        insert(connections, entry);
    else
        connections->refused++;
    pthread_mutex_unlock(&connections->mutex);
    if (!room) {
        free(entry);
        return NULL;
    }
    return entry;
}

void connections_remove(struct connections *connections, struct connection **connection) {
    struct connection *entry = *connection;
    if (entry == NULL)
        return;
    pthread_mutex_lock(&connections->mutex);
    *entry->link = entry->next;
    if (entry->next != NULL)
        entry->next->link = entry->link;
    if (connections->turn == entry)
        connections->turn = NULL;
    if (!entry->shut && entry->reserved)
        connections->reserved--;
    else if (!entry->shut)
        connections->ordinary--;
    pthread_mutex_unlock(&connections->mutex);
    free(entry);
    *connection = NULL;
}

/* --- what becomes of them --- */

void connection_set(struct connections *connections, struct connection *connection,
                    enum connection_state state) {
    int64_t now_ms = clock_ms();
    pthread_mutex_lock(&connections->mutex);
    if (state == CONNECTION_IDLE) {
        connection->since_ms = now_ms;
        if (connections->turn == connection)
            connections->turn = NULL;
    }
    connection->state = state;
    connection->deadline_ms = state == CONNECTION_WORKS  ? INT64_MAX
                              : state == CONNECTION_IDLE ? now_ms + IDLE_MS
                                                         : now_ms + connections->limits.deadline_ms;
    pthread_mutex_unlock(&connections->mutex);
}

void connection_vouch(struct connections *connections, struct connection *connection) {
    pthread_mutex_lock(&connections->mutex);
    connection->vouched = true;
    pthread_mutex_unlock(&connections->mutex);
}

void connection_leases(struct connections *connections, struct connection *connection,
                       int64_t until_ms) {
    pthread_mutex_lock(&connections->mutex);
    connection->lease_until_ms = until_ms;
    pthread_mutex_unlock(&connections->mutex);
}

struct certificate_identity **connection_identity(struct connection *connection) {
    return &connection->identity;
}

bool connection_is_reserved(const struct connection *connection) {
    return connection->reserved; /* never changes */
}

bool connection_takes_turn(struct connections *connections, struct connection *connection) {
    pthread_mutex_lock(&connections->mutex);
    if (connections->turn == NULL)
        connections->turn = connection;
    bool taken = connections->turn == connection;
    pthread_mutex_unlock(&connections->mutex);
    return taken;
}

void connections_shut_late(struct connections *connections) {
    int64_t now_ms = clock_ms();
    pthread_mutex_lock(&connections->mutex);
    for (struct connection *one = connections->first; one != NULL; one = one->next)
        if (one->deadline_ms <= now_ms)
            shut(connections, one);
    pthread_mutex_unlock(&connections->mutex);
}

struct connection_counts connections_count(struct connections *connections) {
    pthread_mutex_lock(&connections->mutex);
    struct connection_counts counts = {connections->ordinary + connections->reserved,
                                       connections->evicted, connections->refused};
    pthread_mutex_unlock(&connections->mutex);
    return counts;
}

int connections_create(struct connections **out, const struct connection_limits *limits,
                       struct error *err) {
    struct connections *connections = array_create(1, sizeof *connections);
    if (connections == NULL)
        return error_memory(err, sizeof *connections, "a list of connections");
    connections->limits = *limits;
    pthread_mutex_init(&connections->mutex, NULL);
    *out = connections;
    return 0;
}

void connections_destroy(struct connections **connections) {
    if (*connections != NULL)
        pthread_mutex_destroy(&(*connections)->mutex);
    free(*connections);
    *connections = NULL;
}
