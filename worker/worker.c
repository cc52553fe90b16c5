#include "worker/worker.h"
#include "worker/clock.h"
#include "worker/hand.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/random.h>
#include <unistd.h>

enum {
    THREADS_MOST = 1024,
    STOP_POLL_MS = 100,
    TICK_MS = 500,
    PAUSE_FIRST_MS = 50,
    GRACE_MS = 2000 /* for the realisation under way, once told to end */
};

void crew_end(struct crew *crew) {
    pthread_mutex_lock(&crew->lock);
    atomic_store(&crew->ending, true);
    pthread_cond_broadcast(&crew->changed);
    pthread_mutex_unlock(&crew->lock);
}

void crew_fail(struct crew *crew, const struct error *err) {
    pthread_mutex_lock(&crew->lock);
    if (!crew->status) {
        crew->status = err->code;
        crew->err = *err;
    }
    pthread_mutex_unlock(&crew->lock);
    crew_end(crew);
}

/* The upper half of a pause is random. */
void crew_pause(struct crew *crew, struct backoff *backoff, int64_t most_ms) {
    int64_t pause = backoff->ms ? 2 * backoff->ms : PAUSE_FIRST_MS;
    backoff->ms = pause < most_ms ? pause : most_ms;
    uint32_t word = 0;
    if (getrandom(&word, sizeof word, GRND_NONBLOCK) != (ssize_t)sizeof word) {
        word = 0; /* no jitter then */
    }
    int64_t until = clock_ms() + backoff->ms / 2 + (backoff->ms / 2) * (int64_t)word / UINT32_MAX;
    pthread_mutex_lock(&crew->lock);
    while (!atomic_load(&crew->ending) && clock_ms() < until) {
        clock_cond_wait(&crew->changed, &crew->lock, until);
    }
    pthread_mutex_unlock(&crew->lock);
}

/* Watches over the threads until all have ended; true when it was told to end them. */
static bool crew_watch(struct crew *crew) {
    const struct worker_options *options = crew->options;
    int64_t tick_ms = clock_ms() + TICK_MS, give_back_ms = INT64_MAX;
    bool stopped = false, at_work = true;
    while (at_work) {
        pthread_mutex_lock(&crew->lock);
        if (crew->at_work > 0) {
            clock_cond_wait(&crew->changed, &crew->lock, clock_ms() + STOP_POLL_MS);
        }
        at_work = crew->at_work > 0;
        pthread_mutex_unlock(&crew->lock);
        bool stop = options->stop && *options->stop;
        if (options->tick && clock_ms() >= tick_ms) {
            stop = options->tick(options->context) != 0 || stop;
            tick_ms = clock_ms() + TICK_MS;
        }
        if (stop && !stopped) {
            stopped = true;
            give_back_ms = clock_ms() + GRACE_MS;
            crew_end(crew);
        }
        if (clock_ms() >= give_back_ms) {
            give_back_ms = INT64_MAX;
            keeper_give_back(crew->keeper);
        }
    }
    return stopped;
}

static int hand_start(struct hand *hand, struct error *err) {
    struct crew *crew = hand->crew;
    struct source_options options = crew->options->source;
    snprintf(hand->name, sizeof hand->name, "%.200s-%u", crew->name, hand->slot);
    options.worker = hand->name;
    int status = source_create(&hand->source, &options, err);
    if (status) {
        return status;
    }
    pthread_mutex_lock(&crew->lock);
    bool started = pthread_create(&hand->thread, NULL, hand_main, hand) == 0;
    crew->at_work += started;
    pthread_mutex_unlock(&crew->lock);
    if (!started) {
        source_destroy(&hand->source);
        return error_set(err, ERROR_SYSTEM, "cannot start a worker thread");
    }
    return 0;
}

static int crew_work(struct crew *crew, struct hand *hands, struct error *err) {
    unsigned started = 0;
    int status = 0;
    while (started < crew->options->threads && !status) {
        hands[started] = (struct hand){.crew = crew, .slot = started};
        status = hand_start(&hands[started], err);
        started += status == 0;
    }
    if (status) {
        crew_end(crew);
    }
    bool stopped = crew_watch(crew);
    for (unsigned n = 0; n < started; n++) {
        pthread_join(hands[n].thread, NULL);
        source_destroy(&hands[n].source);
    }
    if (!status && crew->status) {
        *err = crew->err;
        status = crew->status;
    }
    if (!status && stopped) {
        status = error_set(err, ERROR_STOPPED, "stopped");
    }
    return status;
}

/* The name of the process where the caller gave none. */
static void name_default(char *name, size_t size, const char *host) {
    snprintf(name, size, "%s-%ld", host, (long)getpid());
}

int workers_run(const struct worker_options *options, struct error *err) {
    if (options->threads < 1 || options->threads > THREADS_MOST) {
        return error_set(err, ERROR_INPUT, "%u worker threads; 1 to %d are allowed",
                         options->threads, THREADS_MOST);
    }
    char host[128] = "host";
    struct worker_options own = *options;
    struct crew crew = {.options = &own, .lock = PTHREAD_MUTEX_INITIALIZER};
    (void)gethostname(host, sizeof host - 1);
    own.source.host = options->source.host ? options->source.host : host;
    if (options->source.worker) {
        snprintf(crew.name, sizeof crew.name, "%.200s", options->source.worker);
    } else {
        name_default(crew.name, sizeof crew.name, own.source.host);
    }
    own.source.worker = crew.name;
    atomic_init(&crew.ending, false);
    struct hand *hands = array_create(own.threads, sizeof *hands);
    if (!hands) {
        return error_memory(err, own.threads * sizeof *hands, "threads");
    }
    if (clock_cond_init(&crew.changed) != 0) {
        free(hands);
        return error_set(err, ERROR_SYSTEM, "cannot make a condition");
    }
    int status = shared_parts_init(&crew.parts, err);
    if (!status) {
        status = keeper_create(&crew.keeper, &own.source, own.threads, err);
        status = status ? status : crew_work(&crew, hands, err);
        keeper_destroy(&crew.keeper);
        shared_parts_destroy(&crew.parts);
    }
    free(hands);
    pthread_cond_destroy(&crew.changed);
    return status;
}
