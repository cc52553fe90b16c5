/* Protects: networks that are cut, cut in one direction, so that answers or requests alone are
 * lost, or slow, between the server and its workers and submitters, lose nothing and count nothing
 * twice. */
#include "tests/support/check.h"
#include "tests/support/faults/namespace.h"
#include "tests/support/faults/world.h"
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* The test and the server live at one end of a pair of interfaces, workers and commands at the
 * other. */
#define NEAR "10.9.0.1"
#define FAR "10.9.0.2"
#define NEAR_MAC "02:00:00:00:09:01"
#define FAR_MAC "02:00:00:00:09:02"
#define NOBODY_MAC "02:00:00:00:09:99" /* who sends there sends into the void */

struct link {
    int near, far;    /* files of the two namespaces */
    int64_t until_ms; /* end of the present fault */
};

static void enter(int namespace) {
    assert_int_equal(setns(namespace, CLONE_NEWNET), 0);
}

/* Runs a line at the far end. */
static bool far_shell(const struct link *link, const char *line) {
    enter(link->far);
    bool good = shell_quietly("%s", line);
    enter(link->near);
    return good;
}

/* A process that keeps the far namespace until it has a file; *keeper is ended by the caller. */
static bool far_open(struct link *link, pid_t *keeper) {
    int ready[2];
    char path[64], byte;
    assert_int_equal(pipe(ready), 0);
    *keeper = fork();
    assert_true(*keeper >= 0);
    if (*keeper == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (unshare(CLONE_NEWNET) == 0 && write(ready[1], "", 1) == 1)
            pause();
        _exit(1);
    }
    close(ready[1]);
    bool good = read(ready[0], &byte, 1) == 1;
    close(ready[0]);
    snprintf(path, sizeof path, "/proc/%d/ns/net", (int)*keeper);
    link->far = good ? open(path, O_RDONLY | O_CLOEXEC) : -1;
    return link->far >= 0;
}

/* Addresses are set beforehand, so that none has to be asked for. */
static bool link_open(struct link *link) {
    pid_t keeper = 0;
    if (!namespace_enter(CLONE_NEWNET))
        return false;
    link->near = open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC);
    bool good = link->near >= 0 && far_open(link, &keeper) &&
                shell_quietly("ip link set lo up && ip link add v0 address " NEAR_MAC
                              " type veth peer name v1 address " FAR_MAC
                              " && ip link set v1 netns %d && ip addr add " NEAR
                              "/24 dev v0 && ip link set v0 up && ip neigh replace " FAR
                              " lladdr " FAR_MAC " dev v0 nud permanent",
                              (int)keeper) &&
                far_shell(link, "ip link set lo up && ip addr add " FAR
                                "/24 dev v1 && ip link set v1 up && ip neigh replace " NEAR
                                " lladdr " NEAR_MAC " dev v1 nud permanent");
    if (keeper > 0) {
        kill(keeper, SIGKILL);
        waitpid(keeper, NULL, 0);
    }
    return good;
}

/* --- faults --- */

static void cut_answers(const struct link *link, bool cut) {
    (void)link;
    assert_true(shell_quietly("ip neigh replace " FAR " lladdr %s dev v0 nud permanent",
                              cut ? NOBODY_MAC : FAR_MAC));
}

static void cut_requests(const struct link *link, bool cut) {
    assert_true(far_shell(
        link, cut ? "ip neigh replace " NEAR " lladdr " NOBODY_MAC " dev v1 nud permanent"
                  : "ip neigh replace " NEAR " lladdr " NEAR_MAC " dev v1 nud permanent"));
}

/* In both directions, by a bucket of tokens; without the module of the kernel links are cut
 * alone. */
static void slow_down(const struct link *link, unsigned kilobits) {
    char line[160];
    snprintf(line, sizeof line, "tc qdisc replace dev v1 root tbf rate %ukbit burst 3kb latency 2s",
             kilobits);
    far_shell(link, line);
    shell_quietly("tc qdisc replace dev v0 root tbf rate %ukbit burst 3kb latency 2s", kilobits);
}

static void heal(struct world *world) {
    const struct link *link = world->options.context;
    cut_answers(link, false);
    cut_requests(link, false);
    shell_quietly("tc qdisc del dev v0 root");
    far_shell(link, "tc qdisc del dev v1 root");
}

static void strike(struct world *world) {
    struct link *link = world->options.context;
    if (world_now() < link->until_ms)
        return;
    heal(world);
    switch (world_draw(world, 6)) {
    case 0:
        cut_answers(link, true);
        break;
    case 1:
        cut_requests(link, true);
        break;
    case 2:
        cut_answers(link, true);
        cut_requests(link, true);
        break;
    case 3:
        slow_down(link, 30 + world_draw(world, 1000));
        break;
    default: /* a calm while */
        link->until_ms = world_now() + 200 + world_draw(world, 1500);
        return;
    }
    world_count_fault(world);
    bool briefly = world_draw(world, 2) == 0;
    link->until_ms = world_now() + world_draw(world, briefly ? 500 : WORLD_LEASE * 2000);
}

/* --- who lives where --- */

static void before(struct world *world, const struct actor *actor) {
    const struct link *link = world->options.context;
    if (actor->role != ROLE_IS_SERVER && actor->role != ROLE_IS_SUBMITTER)
        enter(link->far);
}

static void after(struct world *world, const struct actor *actor) {
    const struct link *link = world->options.context;
    (void)actor;
    enter(link->near);
}

static void bad_networks_lose_nothing(void **state) {
    (void)state;
    struct link link = {.near = -1, .far = -1};
    if (!link_open(&link)) {
        print_message("SKIP: no namespaces of networks are permitted here, or there is no ip "
                      "(Debian: iproute2)\n");
        skip();
    }
    spit("tokens", "admin:token-of-the-test-0\nwork:token-of-the-test-1\n");
    chmod("tokens", 0600);
    world_test(&(struct world_options){.program = "links",
                                       .workers = 3,
                                       .submitters = 1,
                                       .commands = 2,
                                       .snapshots = 1,
                                       .headers = "Content-Type: application/json\r\n"
                                                  "Authorization: Bearer token-of-the-test-0\r\n",
                                       .token_file = "tokens",
                                       .serve = (const char *[]){"--insecure", NULL},
                                       .client = (const char *[]){"--insecure", NULL},
                                       .listen = "0.0.0.0",
                                       .ask = NEAR,
                                       .before = before,
                                       .after = after,
                                       .strike = strike,
                                       .pause_ms = 50,
                                       .heal = heal,
                                       .context = &link},
               20);
    close(link.near);
    close(link.far);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(bad_networks_lose_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
