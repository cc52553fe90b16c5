#include "worker/worker.h"
#include "worker/checker.h"
#include "worker/clock.h"
#include "worker/publish.h"
#include "worker/worker_thread.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum {
    THREADS_MOST = 1024,
    STOP_POLL_MS = 100,
    TICK_MS = 500,
    GRACE_MS = 2000 /* how long a realisation under way may go on after a stop */
};

/* Makes all threads end as soon as they can. */
static void worker_pool_end(struct worker_pool *pool) {
    atomic_store(&pool->ending, true);
    dispatcher_end(pool->dispatcher);
}

/* Whether no thread has run a job for options->idle_s; *busy_ms is when one was last seen to. */
static bool worker_pool_is_idle(struct worker_pool *pool, int64_t *busy_ms) {
    if (atomic_load(&pool->computing) > 0)
        *busy_ms = clock_ms();
    return pool->options->idle_s > 0 &&
           clock_ms() - *busy_ms >= 1000 * (int64_t)pool->options->idle_s;
}

/* Waits until all threads have ended; returns true when options->stop or tick asked them to end. */
static bool worker_pool_watch(struct worker_pool *pool) {
    const struct worker_options *options = pool->options;
    int64_t tick_ms = clock_ms() + TICK_MS, give_back_ms = INT64_MAX, busy_ms = clock_ms();
    bool stopped = false, at_work = true;
    while (at_work) {
        pthread_mutex_lock(&pool->lock);
        if (pool->at_work > 0)
            clock_cond_wait(&pool->changed, &pool->lock, clock_ms() + STOP_POLL_MS);
        at_work = pool->at_work > 0;
        pthread_mutex_unlock(&pool->lock);
        bool stop = options->stop != NULL && *options->stop != 0;
        if (options->tick != NULL && clock_ms() >= tick_ms) {
            stop = options->tick(options->context) != 0 || stop;
            tick_ms = clock_ms() + TICK_MS;
        }
        if (stop && !stopped) {
            stopped = true;
            give_back_ms = clock_ms() + GRACE_MS;
            worker_pool_end(pool);
        }
        struct error failed;
        if (!stopped && worker_pool_is_idle(pool, &busy_ms))
            worker_pool_end(pool);
        if (!atomic_load(&pool->ending) && dispatcher_status(pool->dispatcher, &failed) != 0)
            worker_pool_end(pool);
        if (clock_ms() >= give_back_ms) {
            give_back_ms = INT64_MAX;
            dispatcher_give_back(pool->dispatcher);
        }
    }
    return stopped;
}

static int thread_start(struct worker_thread *thread, struct error *err) {
    struct worker_pool *pool = thread->pool;
    snprintf(thread->name, sizeof thread->name, "%.200s-%u", pool->name, thread->number);
    pthread_mutex_lock(&pool->lock);
    bool started = pthread_create(&thread->handle, NULL, worker_thread_main, thread) == 0;
    pool->at_work += started;
    pthread_mutex_unlock(&pool->lock);
    return started ? 0 : error_set(err, ERROR_SYSTEM, "cannot start a worker thread");
}

static int worker_pool_work(struct worker_pool *pool, struct worker_thread *threads,
                            struct error *err) {
    unsigned started = 0;
    int status = 0;
    while (started < pool->options->threads && status == 0) {
        threads[started] = (struct worker_thread){.pool = pool, .number = started};
        status = thread_start(&threads[started], err);
        started += status == 0;
    }
    if (status != 0)
        worker_pool_end(pool);
    bool stopped = worker_pool_watch(pool);
    for (unsigned n = 0; n < started; n++)
        pthread_join(threads[n].handle, NULL);
    if (status == 0)
        status = dispatcher_status(pool->dispatcher, err);
    if (status == 0 && stopped)
        status = error_set(err, ERROR_STOPPED, "stopped");
    return status;
}

/* Makes up the name of the process where the caller gave none. */
static void name_default(char *name, size_t size, const char *host) {
    snprintf(name, size, "%s-%ld", host, (long)getpid());
}

static bool is_stopped(void *context) {
    const struct worker_options *options = context;
    return options->stop != NULL && *options->stop != 0;
}

/* Publishes what others, or these workers themselves, left due. */
static int publish_left(struct worker_options *options, struct error *err) {
    struct store *store = NULL;
    if (options->source.database == NULL)
        return 0;
    const struct store_options existing = {.existing = true};
    int status = store_open(&store, options->source.database, &existing, err);
    if (status == 0)
        status = publish_due(store, is_stopped, options, NULL, err);
    store_close(&store);
    return status;
}

int workers_run(const struct worker_options *options, struct error *err) {
    if (options->threads < 1 || options->threads > THREADS_MOST) {
        return error_set(err, ERROR_INPUT, "%u worker threads; 1 to %d are allowed",
                         options->threads, THREADS_MOST);
    }
    char host[128] = "host";
    struct worker_options own = *options;
    struct worker_pool pool = {.options = &own, .lock = PTHREAD_MUTEX_INITIALIZER};
    (void)gethostname(host, sizeof host - 1);
    own.source.host = options->source.host != NULL ? options->source.host : host;
    if (options->source.worker != NULL)
        snprintf(pool.name, sizeof pool.name, "%.200s", options->source.worker);
    else
        name_default(pool.name, sizeof pool.name, own.source.host);
    own.source.worker = pool.name;
    atomic_init(&pool.ending, false);
    atomic_init(&pool.computing, 0);
    const struct dispatcher_options dispatching = {
        .source = &own.source, .threads = own.threads, .drain = own.drain};
    struct worker_thread *threads = array_create(own.threads, sizeof *threads);
    if (threads == NULL)
        return error_memory(err, own.threads * sizeof *threads, "threads");
    if (clock_cond_init(&pool.changed) != 0) {
        free(threads);
        return error_set(err, ERROR_SYSTEM, "cannot make a condition");
    }
    int status = shared_parts_init(&pool.parts, err);
    if (status == 0) {
        status = checker_create(&own.source.checker, err);
        if (status == 0)
            status = publish_left(&own, err);
        if (status == 0)
            status = dispatcher_create(&pool.dispatcher, &dispatching, err);
        if (status == 0)
            status = worker_pool_work(&pool, threads, err);
        dispatcher_destroy(&pool.dispatcher);
        checker_destroy(&own.source.checker);
        if (status == 0)
            status = publish_left(&own, err);
        shared_parts_destroy(&pool.parts);
    }
    free(threads);
    pthread_cond_destroy(&pool.changed);
    return status;
}
