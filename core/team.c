#include "core/team.h"
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <time.h>

enum { THREADS_MOST = 1024 };

struct member {
    struct team *team;
    size_t number;
    pthread_t thread;
};

struct team {
    size_t threads;
    pthread_mutex_t mutex;
    pthread_cond_t begins, ends;
    /* under the mutex */
    size_t tasks;   /* begun so far */
    size_t working; /* members who have not ended the last one */
    bool closed;
    /* of the last task, unchanged while members work */
    team_work *work;
    void *context;
    size_t parts;
    atomic_size_t next; /* part that nobody has taken */
    struct member members[];
};

static void take_parts(struct team *team, size_t thread) {
    for (;;) {
        size_t part = atomic_fetch_add(&team->next, 1);
        if (part >= team->parts)
            return;
        team->work(team->context, part, thread);
    }
}

static void *run(void *argument) {
    const struct member *member = argument;
    struct team *team = member->team;
    size_t seen = 0;
    pthread_mutex_lock(&team->mutex);
    for (;;) {
        while (team->tasks == seen && !team->closed)
            pthread_cond_wait(&team->begins, &team->mutex);
        if (team->closed)
            break;
        seen = team->tasks;
        pthread_mutex_unlock(&team->mutex);
        take_parts(team, member->number);
        pthread_mutex_lock(&team->mutex);
        if (--team->working == 0)
            pthread_cond_signal(&team->ends);
    }
    pthread_mutex_unlock(&team->mutex);
    return NULL;
}

/* Members from 1 on have threads; team->threads counts those that the system gave. */
static void start(struct team *team, size_t threads) {
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    for (size_t n = 1; n < threads; n++) {
        struct member *member = &team->members[n];
        *member = (struct member){.team = team, .number = n};
        if (pthread_create(&member->thread, NULL, run, member) != 0)
            break;
        team->threads = n + 1;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

int team_create(struct team **out, size_t threads, struct error *err) {
    *out = NULL;
    if (threads <= 1)
        return 0;
    threads = threads < THREADS_MOST ? threads : THREADS_MOST;
    size_t size = sizeof(struct team) + threads * sizeof(struct member);
    struct team *team = array_create(1, size);
    if (team == NULL)
        return error_memory(err, size, "a team of threads");
    team->threads = 1;
    pthread_mutex_init(&team->mutex, NULL);
    pthread_cond_init(&team->begins, NULL);
    pthread_cond_init(&team->ends, NULL);
    start(team, threads);
    *out = team;
    return 0;
}

void team_destroy(struct team **team) {
    struct team *t = *team;
    if (t == NULL)
        return;
    pthread_mutex_lock(&t->mutex);
    t->closed = true;
    pthread_cond_broadcast(&t->begins);
    pthread_mutex_unlock(&t->mutex);
    for (size_t n = 1; n < t->threads; n++)
        pthread_join(t->members[n].thread, NULL);
    pthread_cond_destroy(&t->ends);
    pthread_cond_destroy(&t->begins);
    pthread_mutex_destroy(&t->mutex);
    free(t);
    *team = NULL;
}

size_t team_threads(const struct team *team) {
    return team != NULL ? team->threads : 1;
}

double team_cpu_seconds(const struct team *team) {
    double seconds = 0;
    for (size_t n = 1; n < team_threads(team); n++) {
        clockid_t clock;
        struct timespec spent;
        if (pthread_getcpuclockid(team->members[n].thread, &clock) == 0 &&
            clock_gettime(clock, &spent) == 0)
            seconds += (double)spent.tv_sec + 1e-9 * (double)spent.tv_nsec;
    }
    return seconds;
}

void team_share(struct team *team, size_t parts, team_work *work, void *context) {
    if (team_threads(team) == 1 || parts == 1) {
        for (size_t part = 0; part < parts; part++)
            work(context, part, 0);
        return;
    }
    pthread_mutex_lock(&team->mutex);
    team->work = work;
    team->context = context;
    team->parts = parts;
    atomic_store(&team->next, 0);
    team->working = team->threads - 1;
    team->tasks++;
    pthread_cond_broadcast(&team->begins);
    pthread_mutex_unlock(&team->mutex);
    take_parts(team, 0);
    pthread_mutex_lock(&team->mutex);
    while (team->working > 0)
        pthread_cond_wait(&team->ends, &team->mutex);
    pthread_mutex_unlock(&team->mutex);
}

size_t team_parts(size_t count, size_t size) {
    return count / size + (count % size != 0);
}

struct ranges {
    size_t count, size;
    team_range_work *work;
    void *context;
};

static void work_range(void *context, size_t part, size_t thread) {
    const struct ranges *ranges = context;
    size_t first = part * ranges->size, rest = ranges->count - first;
    ranges->work(ranges->context, first, first + (rest < ranges->size ? rest : ranges->size),
                 thread);
}

void team_share_ranges(struct team *team, size_t count, size_t size, team_range_work *work,
                       void *context) {
    struct ranges ranges = {count, size, work, context};
    team_share(team, team_parts(count, size), work_range, &ranges);
}
