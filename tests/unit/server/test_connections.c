/* Protects: at the limit the right connection goes, and one that is needed stays. */
#include "server/http/guard/connections.h"
#include "tests/support/check.h"
#include "worker/clock.h"
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { MOST = 4, RESERVE = 2, PEERS_MOST = 16 };

struct peer {
    int ours, theirs;
    struct connection *connection;
};

struct world {
    struct connections *connections;
    struct peer peers[PEERS_MOST];
    size_t count;
};

static void begin(struct world *world, unsigned per_address, int64_t deadline_ms) {
    const struct connection_limits limits = {MOST, RESERVE, per_address, deadline_ms};
    *world = (struct world){0};
    assert_int_equal(connections_create(&world->connections, &limits, NULL), 0);
}

static void end(struct world *world) {
    for (size_t i = 0; i < world->count; i++) {
        connections_remove(world->connections, &world->peers[i].connection);
        close(world->peers[i].ours);
        close(world->peers[i].theirs);
    }
    connections_destroy(&world->connections);
    assert_null(world->connections);
}

/* One more connection, some time after the last, from an address; NULL: from this machine. */
static struct peer *add_from(struct world *world, const char *address) {
    int pair[2];
    struct sockaddr_in from = {.sin_family = AF_INET};
    const struct timespec pause = {0, 2000000};
    nanosleep(&pause, NULL);
    assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, pair), 0);
    from.sin_addr.s_addr = address != NULL ? inet_addr(address) : htonl(INADDR_LOOPBACK);
    struct peer *peer = &world->peers[world->count++];
    *peer = (struct peer){pair[0], pair[1], NULL};
    peer->connection =
        connections_add(world->connections, peer->ours, (const struct sockaddr *)&from);
    return peer;
}

static struct peer *add(struct world *world) {
    return add_from(world, NULL);
}

static bool is_shut(const struct peer *peer) {
    struct pollfd end = {.fd = peer->theirs, .events = POLLRDHUP};
    return poll(&end, 1, 0) > 0;
}

static void set(struct world *world, struct peer *peer, enum connection_state state) {
    connection_set(world->connections, peer->connection, state);
}

static void the_silent_go_first(void **state) {
    (void)state;
    struct world world;
    begin(&world, 0, 1000);
    struct peer *known = add(&world), *silent = add(&world), *working = add(&world),
                *younger = add(&world);
    connection_vouch(world.connections, known->connection);
    set(&world, working, CONNECTION_WORKS);
    assert_non_null(add(&world)->connection);
    assert_true(is_shut(silent));
    assert_false(is_shut(known) || is_shut(working) || is_shut(younger));
    assert_non_null(add(&world)->connection);
    assert_true(is_shut(younger));
    assert_int_equal(connections_count(world.connections).open, MOST);
    assert_int_equal(connections_count(world.connections).evicted, 2);
    end(&world);
}

static void of_those_known_the_idlest_goes(void **state) {
    (void)state;
    struct world world;
    begin(&world, 0, 1000);
    struct peer *peers[MOST];
    for (size_t i = 0; i < MOST; i++) {
        peers[i] = add(&world);
        connection_vouch(world.connections, peers[i]->connection);
    }
    const struct timespec pause = {0, 2000000};
    nanosleep(&pause, NULL);
    set(&world, peers[0], CONNECTION_IDLE); /* it was heard of last */
    set(&world, peers[1], CONNECTION_SENDS);
    connection_leases(world.connections, peers[2]->connection, clock_ms() + 100000);
    assert_false(connection_is_reserved(add(&world)->connection));
    assert_true(is_shut(peers[3]));
    assert_false(is_shut(peers[0]) || is_shut(peers[1]) || is_shut(peers[2]));
    end(&world);
}

static void where_all_are_needed_there_is_a_reserve(void **state) {
    (void)state;
    struct world world;
    begin(&world, 0, 1000);
    for (size_t i = 0; i < MOST; i++)
        connection_leases(world.connections, add(&world)->connection, clock_ms() + 100000);
    struct peer *first = add(&world), *second = add(&world);
    assert_true(connection_is_reserved(first->connection));
    assert_true(connection_is_reserved(second->connection));
    assert_true(connection_takes_turn(world.connections, first->connection));
    assert_true(connection_takes_turn(world.connections, first->connection));
    assert_false(connection_takes_turn(world.connections, second->connection));
    set(&world, first, CONNECTION_WORKS);
    assert_non_null(add(&world)->connection);
    assert_true(is_shut(second));
    assert_false(is_shut(first));
    set(&world, &world.peers[world.count - 1], CONNECTION_WORKS);
    assert_null(add(&world)->connection); /* the reserve is needed, too */
    for (size_t i = 0; i < MOST; i++)
        assert_false(is_shut(&world.peers[i]));
    set(&world, first, CONNECTION_IDLE); /* its turn is over */
    struct peer *last = add(&world);
    assert_non_null(last->connection);
    assert_true(connection_takes_turn(world.connections, last->connection));
    end(&world);
}

static void an_address_has_a_share(void **state) {
    (void)state;
    struct world world;
    begin(&world, 2, 1000);
    struct peer *one = add_from(&world, "10.0.0.1"), *two = add_from(&world, "10.0.0.1");
    assert_non_null(add_from(&world, "10.0.0.2")->connection);
    assert_false(is_shut(one));
    set(&world, two, CONNECTION_WORKS);
    struct peer *three = add_from(&world, "10.0.0.1");
    assert_non_null(three->connection);
    assert_true(is_shut(one));
    set(&world, three, CONNECTION_WORKS);
    assert_null(add_from(&world, "10.0.0.1")->connection);
    assert_int_equal(connections_count(world.connections).refused, 1);
    for (size_t i = 0; i < 3; i++) /* peers of this machine may stand for others */
        assert_non_null(add(&world)->connection);
    end(&world);
}

static void who_is_late_is_shut(void **state) {
    (void)state;
    struct world world;
    begin(&world, 0, 1);
    struct peer *late = add(&world), *working = add(&world), *idle = add(&world);
    set(&world, working, CONNECTION_WORKS);
    set(&world, idle, CONNECTION_IDLE); /* which may last a minute */
    const struct timespec pause = {0, 5000000};
    nanosleep(&pause, NULL);
    connections_shut_late(world.connections);
    assert_true(is_shut(late));
    assert_false(is_shut(working) || is_shut(idle));
    end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_silent_go_first),
        cmocka_unit_test(of_those_known_the_idlest_goes),
        cmocka_unit_test(where_all_are_needed_there_is_a_reserve),
        cmocka_unit_test(an_address_has_a_share),
        cmocka_unit_test(who_is_late_is_shut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
