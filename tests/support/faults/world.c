#include "tests/support/faults/world.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const char *const ROLE_NAMES[] = {"server", "worker", "submitter", "command", "snapshot"};

int64_t world_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

unsigned world_models(const struct world *world) {
    return world->options.long_model ? WORLD_LONG_MODEL + 1 : WORLD_MODELS;
}

unsigned world_draw(struct world *world, unsigned n) {
    return (unsigned)(next_word(&world->random) % n);
}

void world_lose(atomic_uint *count, const char *format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    atomic_fetch_add(count, 1);
    fprintf(stderr, "loss: %s\n", text);
}

int world_ask(struct world *world, const char *method, const char *path, const char *body,
              char **answer) {
    atomic_fetch_add(&world->tally->requests, 1);
    return http_try(world->port, 10000,
                    &(struct http_request){method, path, world->options.headers, body}, answer);
}

/* --- start --- */

static void start_server(struct world *world, struct actor *actor) {
    const char *arguments[32] = {"serve", "--db", "store/rugo.db"};
    char listen_at[80], lease[16];
    size_t count = 3;
    snprintf(listen_at, sizeof listen_at, "%s:%u",
             world->options.listen != NULL ? world->options.listen : "127.0.0.1", world->port);
    snprintf(lease, sizeof lease, "%d", WORLD_LEASE);
    arguments[count++] = "--listen";
    arguments[count++] = listen_at;
    arguments[count++] = "--lease";
    arguments[count++] = lease;
    if (world->options.token_file != NULL) {
        arguments[count++] = "--token-file";
        arguments[count++] = world->options.token_file;
    }
    for (const char *const *more = world->options.serve; more != NULL && *more != NULL; more++)
        arguments[count++] = *more;
    process_start(&actor->process, actor->name, arguments);
}

static void start_client(struct world *world, struct actor *actor, const char *const *own) {
    const char *arguments[16] = {0};
    size_t count = 0;
    for (; *own != NULL; own++)
        arguments[count++] = *own;
    arguments[count++] = "--server";
    arguments[count++] = world->url;
    if (world->options.token_file != NULL) {
        arguments[count++] = "--token-file";
        arguments[count++] = world->options.token_file;
    }
    for (const char *const *more = world->options.client; more != NULL && *more != NULL; more++)
        arguments[count++] = *more;
    process_start(&actor->process, actor->name, arguments);
}

/* Each submission of a command has a name of its own, so that one that came twice is seen. */
static void start_command(struct world *world, struct actor *actor) {
    char file[2 * WORLD_NAME];
    unsigned model = world_draw(world, WORLD_MODELS);
    snprintf(actor->study, sizeof actor->study, "m%u-c%u", model,
             atomic_fetch_add(&world->tally->next_key, 1));
    snprintf(file, sizeof file, "%s.study", actor->name);
    char *text = model_text(model, actor->study);
    spit(file, text);
    free(text);
    ledger_add("tried", actor->study, "-");
    atomic_fetch_add(&world->tally->submitted, 1);
    start_client(world, actor, (const char *[]){"submit", file, NULL});
}

static void start_submitter(struct world *world, struct actor *actor) {
    fflush(NULL);
    actor->process.pid = fork();
    assert_true(actor->process.pid >= 0);
    if (actor->process.pid != 0)
        return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    submitter_run(world, actor);
    _exit(0);
}

void world_start(struct world *world, struct actor *actor) {
    char file[2 * WORLD_NAME];
    snprintf(file, sizeof file, "%s.db", actor->name);
    if (world->options.before != NULL)
        world->options.before(world, actor);
    actor->struck = false;
    switch (actor->role) {
    case ROLE_IS_SERVER:
        start_server(world, actor);
        break;
    case ROLE_IS_WORKER:
        start_client(world, actor, (const char *[]){"work", "--workers", "1", NULL});
        break;
    case ROLE_IS_SUBMITTER:
        start_submitter(world, actor);
        break;
    case ROLE_IS_COMMAND:
        start_command(world, actor);
        break;
    case ROLE_IS_SNAPSHOT:
        start_client(world, actor, (const char *[]){"snapshot", file, NULL});
        break;
    }
    if (world->options.after != NULL)
        world->options.after(world, actor);
}

/* --- tending --- */

/* Keeps what a process said in its last life. */
static void keep_log(const struct actor *actor) {
    char file[2 * WORLD_NAME];
    if (actor->process.err[0] == '\0' || access(actor->process.err, R_OK) != 0)
        return;
    snprintf(file, sizeof file, "%s.log", actor->name);
    char *text = slurp(actor->process.err);
    FILE *log = fopen(file, "ab");
    if (log != NULL) {
        fputs(text, log);
        fclose(log);
    }
    free(text);
}

/* What a submission that ended well has promised. */
static void actor_done(struct world *world, struct actor *actor) {
    char id[17] = "";
    if (actor->role != ROLE_IS_COMMAND)
        return;
    char *text = slurp(actor->process.out);
    if (sscanf(text, "%16[0-9a-f]", id) == 1) {
        ledger_add("acked", actor->study, id);
        atomic_fetch_add(&world->tally->acknowledged, 1);
    }
    free(text);
}

static void actor_reap(struct world *world, struct actor *actor) {
    int status = 0;
    if (actor->process.pid == 0 || waitpid(actor->process.pid, &status, WNOHANG) == 0)
        return;
    actor->process.pid = 0;
    actor->wake_at = 0;
    actor->start_at = world_now() + world_draw(world, actor->role == ROLE_IS_SERVER ? 300 : 600);
    keep_log(actor);
    bool well = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (actor->role == ROLE_IS_SNAPSHOT)
        world_judge_snapshot(world, actor, well);
    else if (well)
        actor_done(world, actor);
    if (WIFSIGNALED(status) && !(actor->struck && WTERMSIG(status) == SIGKILL))
        world_lose(&world->tally->crashes, "%s ended by signal %d", actor->name, WTERMSIG(status));
}

/* Notes the most memory that the server has had. */
static void weigh(struct world *world, const struct actor *actor) {
    char path[64], line[128];
    long kb = 0;
    snprintf(path, sizeof path, "/proc/%d/status", (int)actor->process.pid);
    FILE *file = fopen(path, "r");
    while (file != NULL && fgets(line, sizeof line, file) != NULL)
        if (sscanf(line, "VmHWM: %ld", &kb) == 1 && kb > world->server_kb)
            world->server_kb = kb;
    if (file != NULL)
        fclose(file);
}

void world_tend(struct world *world) {
    for (int a = 0; a < world->actor_count; a++) {
        struct actor *actor = &world->actors[a];
        actor_reap(world, actor);
        if (actor->wake_at != 0 && world_now() >= actor->wake_at) {
            process_kill(&actor->process, SIGCONT);
            actor->wake_at = 0;
        }
        bool kept = actor->role <= ROLE_IS_WORKER || !world->ending;
        if (actor->process.pid == 0 && kept && world_now() >= actor->start_at)
            world_start(world, actor);
        else if (actor->process.pid != 0 && actor->role == ROLE_IS_SERVER)
            weigh(world, actor);
    }
}

int world_end(struct actor *actor, int signal_number, int seconds) {
    if (actor->process.pid == 0)
        return 0;
    process_kill(&actor->process, SIGCONT);
    process_kill(&actor->process, signal_number);
    int status = process_wait(&actor->process, seconds);
    keep_log(actor);
    return status;
}

/* --- strikes --- */

struct actor *world_pick(struct world *world) {
    for (int tries = 0; tries < 100; tries++) {
        struct actor *actor = &world->actors[world_draw(world, (unsigned)world->actor_count)];
        if (actor->process.pid != 0)
            return actor;
    }
    return NULL;
}

void world_kill(struct world *world, struct actor *actor) {
    actor->struck = true;
    process_kill(&actor->process, SIGKILL);
    atomic_fetch_add(&world->tally->kills, 1);
}

void world_stop(struct world *world, struct actor *actor, long milliseconds) {
    if (actor->wake_at != 0)
        return;
    process_kill(&actor->process, SIGSTOP);
    actor->wake_at = world_now() + milliseconds;
    world_count_fault(world);
}

void world_count_fault(struct world *world) {
    atomic_fetch_add(&world->tally->faults, 1);
}

/* --- the whole --- */

static void add_actors(struct world *world, enum role role, int count) {
    for (int number = 0; number < count; number++) {
        assert_true(world->actor_count < WORLD_ACTORS);
        struct actor *actor = &world->actors[world->actor_count++];
        *actor = (struct actor){.role = role, .number = number};
        snprintf(actor->name, sizeof actor->name, "%s-%d", ROLE_NAMES[role], number);
    }
}

static void world_open(struct world *world, const struct world_options *options, double usual) {
    const char *seconds = getenv("RUGO_SECONDS");
    *world = (struct world){.options = *options, .seed = seed_of_now()};
    world->random = world->seed;
    world->seconds = seconds != NULL ? strtod(seconds, NULL) : usual;
    world->port = free_port();
    snprintf(world->url, sizeof world->url, "http://%s:%u",
             options->ask != NULL ? options->ask : "127.0.0.1", world->port);
    if (options->headers == NULL)
        world->options.headers = "Content-Type: application/json\r\n";
    world->tally =
        mmap(NULL, sizeof *world->tally, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(world->tally != MAP_FAILED);
    prctl(PR_SET_CHILD_SUBREAPER, 1); /* what a killed process leaves behind is seen */
    mkdir("store", 0700);
    mkdir("scratch", 0700);
    setenv("TMPDIR", "scratch", 1);
    models_run(world_models(world));
    bool usual_ones = options->workers == 0;
    add_actors(world, ROLE_IS_SERVER, 1);
    add_actors(world, ROLE_IS_WORKER, usual_ones ? 3 : options->workers);
    add_actors(world, ROLE_IS_SUBMITTER, usual_ones ? 2 : options->submitters);
    add_actors(world, ROLE_IS_COMMAND, usual_ones ? 1 : options->commands);
    add_actors(world, ROLE_IS_SNAPSHOT, usual_ones ? 1 : options->snapshots);
}

/* Something was acknowledged that could be lost, and something struck. */
static bool has_happened(const struct world *world) {
    const struct world_tally *tally = world->tally;
    return tally->acknowledged > 0 && tally->kills + tally->faults > 0;
}

/* A machine on which nothing has happened in the time gets more. */
static void world_run(struct world *world) {
    enum { MORE_MS = 120000 };
    int64_t end = world_now() + (int64_t)(1000 * world->seconds), next = world_now();
    int64_t late = end + MORE_MS;
    for (; world_now() < end || (world_now() < late && !has_happened(world)); sleep_ms(5)) {
        world_tend(world);
        if (world_now() < next)
            continue;
        world->options.strike(world);
        next = world_now() + world_draw(world, (unsigned)(2 * world->options.pause_ms));
    }
}

static unsigned world_report(const struct world *world) {
    struct world_tally *tally = world->tally;
    unsigned losses = tally->lost + tally->doubled + tally->differing + tally->unfinished +
                      tally->damaged + tally->leftovers + tally->crashes;
    printf("seed %" PRIu64 " of %s, seconds %.0f, kills %u, faults %u, requests %u, studies %u, "
           "retried %u, server MiB %ld, losses %u\n",
           world->seed, world->options.program, world->seconds, tally->kills, tally->faults,
           tally->requests, tally->acknowledged, tally->retried, world->server_kb / 1024, losses);
    if (losses != 0)
        printf("lost %u, doubled %u, differing %u, unfinished %u, damaged %u, left over %u, "
               "crashed %u\n",
               tally->lost, tally->doubled, tally->differing, tally->unfinished, tally->damaged,
               tally->leftovers, tally->crashes);
    fflush(stdout);
    return losses;
}

void world_test(const struct world_options *options, double usual) {
    struct world world;
    world_open(&world, options, usual);
    world_run(&world);
    world_judge(&world);
    world_judge_files(&world);
    unsigned losses = world_report(&world), acknowledged = world.tally->acknowledged;
    unsigned struck = world.tally->kills + world.tally->faults;
    munmap(world.tally, sizeof *world.tally);
    assert_int_equal(losses, 0);
    assert_true(acknowledged > 0); /* something was there to lose */
    assert_true(struck > 0);
}
