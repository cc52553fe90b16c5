#include "worker/worker.h"
#include "jobs/runner.h"
#include "worker/checker.h"
#include "worker/clock.h"
#include "worker/dispatcher.h"
#include "worker/log.h"
#include "worker/memory_budget.h"
#include "worker/publish/publish.h"
#include "worker/quiet_thread.h"
#include "worker/shared_parts.h"
#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { NAME_MOST = 256 };

/* What the worker threads of one workers_run share. */
struct worker_pool {
    const struct worker_options *options; /* borrowed */
    char name[NAME_MOST];          /* of the process; a thread's name is this and its number */
    struct dispatcher *dispatcher; /* owned */
    struct shared_parts parts;     /* what the runners of a case share; has its own lock */
    struct memory_budget memory;   /* of what runners need; likewise */
    pthread_mutex_t lock;
    pthread_cond_t changed; /* signalled when a thread ends */
    atomic_bool ending;
    atomic_uint computing; /* threads that run a job, not those that wait for an answer */
    pthread_t publisher;   /* publishes what is due in a local store */
    bool publishes;        /* it was started */
    unsigned at_work;      /* threads that have not ended; protected by the lock */
};

/* One worker thread, which takes jobs, runs them and hands in how they ended, until its pool ends.
 *
 *     take -> runner of the case -> run -> complete  (with what is done, where the pool ends)
 *                                       -> fail      (with the reason)
 *                                       -> release   (the pool ends, and nothing is done)
 *                                       -> nothing   (the lease is lost or the study cancelled) */

struct worker_thread {
    struct worker_pool *pool; /* borrowed */
    unsigned number;
    pthread_t handle;
    char name[NAME_MOST + 16];
    struct lease *lease; /* the job that it runs; NULL: none */
    /* The runner of the last job, or NULL. It is kept because all jobs of a case use the same
     * Fourier transform plans and matrix factorisations. */
    struct job_runner *runner;
    struct shared_part *part; /* what the runner borrows; NULL: nothing */
    double bytes;             /* of the memory budget, for the runner */
    struct team *team;        /* of the runner; NULL: this thread alone */
    /* The kind, study and case of the runner. */
    const struct job_kind *kind;
    char study[STUDY_ID_SIZE];
    uint64_t case_number;
};

/* Logs a line about the job, or about the thread when job is NULL. */
__attribute__((format(printf, 4, 5))) static void thread_log(const struct worker_thread *thread,
                                                             enum log_level level,
                                                             const struct claimed_job *job,
                                                             const char *format, ...) {
    char text[LOG_LINE_MOST];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    struct log_about about = {.worker = thread->name};
    if (job != NULL) {
        about.study = job->study;
        about.job = job->id;
        about.attempt = job->attempt;
    }
    log_line(level, &about, "%s", length < 0 ? "" : text);
}

/* --- one job --- */

static void runner_drop(struct worker_thread *thread) {
    if (thread->runner != NULL) {
        runner_destroy(&thread->runner);
        thread->runner = NULL;
    }
    team_destroy(&thread->team);
    shared_parts_let_go(&thread->pool->parts, &thread->part);
    memory_budget_give(&thread->pool->memory, thread->bytes);
    thread->bytes = 0;
}

static int thread_poll(void *context, double done) {
    struct worker_thread *thread = context;
    lease_progress(thread->lease, done);
    return lease_is_lost(thread->lease) || atomic_load(&thread->pool->ending);
}

static int is_over(void *context) {
    return thread_poll(context, 0);
}

/* Takes what a runner of the job's case needs from the budget, once it is free. */
static int memory_take(struct worker_thread *thread, const struct claimed_job *job,
                       const struct job_kind *kind, struct error *err) {
    void *study = NULL;
    struct study_cost cost = {0};
    int status = kind_case_create(&study, kind, job->parameters, NULL, err);
    if (status != 0)
        return status;
    kind->estimate(study, &cost);
    kind_case_destroy(kind, &study);
    int64_t start_ms = clock_ms();
    status = memory_budget_take(&thread->pool->memory, cost.memory_bytes, is_over, thread, err);
    thread->bytes = status == 0 ? cost.memory_bytes : 0;
    if (status == 0 && clock_ms() - start_ms >= 1000)
        thread_log(thread, LEVEL_INFO, job, "waited %.3g s for %.3g GB of memory of other jobs",
                   1e-3 * (double)(clock_ms() - start_ms), cost.memory_bytes / 1e9);
    return status;
}

/* Where fewer realisations of the case fit into memory at once than there are threads, the others'
 * processors share each of them. */
static int team_make(struct worker_thread *thread, const struct claimed_job *job,
                     struct error *err) {
    const struct worker_pool *pool = thread->pool;
    double at_once = fmax(1, floor(pool->memory.limit / thread->bytes));
    unsigned threads = pool->options->threads;
    if (!(pool->memory.limit > 0 && thread->bytes > 0 && at_once < threads))
        return 0;
    int status = team_create(&thread->team, (size_t)(threads / at_once), err);
    if (status == 0 && thread->team != NULL)
        thread_log(thread, LEVEL_INFO, job,
                   "%zu threads share a realisation, since memory holds %.0f at once",
                   team_threads(thread->team), at_once);
    return status != 0 ? status : runner_set_team(thread->runner, thread->team, err);
}

/* Makes thread->runner a runner of this job's case. */
static int runner_prepare(struct worker_thread *thread, const struct claimed_job *job,
                          const struct job_kind *kind, struct error *err) {
    if (thread->runner != NULL && thread->kind == kind && thread->case_number == job->case_number &&
        strcmp(thread->study, job->study) == 0)
        return 0;
    runner_drop(thread);
    int status = memory_take(thread, job, kind, err);
    if (status == 0)
        status = shared_parts_take(&thread->pool->parts, kind, job->study, job->case_number,
                                   job->parameters, &thread->part, err);
    if (status == 0)
        status = runner_create(&thread->runner, kind, job->parameters,
                               shared_part_content(thread->part), job->seed, job->sequence, err);
    if (status == 0)
        status = team_make(thread, job, err);
    if (status != 0) {
        runner_drop(thread);
    } else {
        thread->kind = kind;
        thread->case_number = job->case_number;
        memcpy(thread->study, job->study, sizeof thread->study);
    }
    return status;
}

static int job_run(struct worker_thread *thread, const struct claimed_job *job,
                   struct block_result *result, struct error *err) {
    const struct job_kind *kind = kind_find(job->kind);
    if (kind == NULL)
        return error_set(err, ERROR_SYSTEM, "this worker knows no kind '%.64s'", job->kind);
    struct job_control control = {.poll = thread_poll, .context = thread};
    int status = runner_prepare(thread, job, kind, err);
    if (status == 0)
        status = runner_run(thread->runner, job->first, job->count, &control, result, err);
    return status;
}

static void job_log(const struct worker_thread *thread, const struct claimed_job *job,
                    const struct job_end *end) {
    const struct block_result *result = &end->result;
    switch (end->verb) {
    case REPORT_COMPLETE:
        thread_log(thread, LEVEL_INFO, job,
                   "case %llu: realisations %llu to %llu took %.3g s, %.3g s of CPU time%s",
                   (unsigned long long)job->case_number, (unsigned long long)result->first,
                   (unsigned long long)(result->first + result->count - 1), result->seconds,
                   result->cpu_seconds,
                   result->count < job->count ? ", the others are handed back" : "");
        break;
    case REPORT_FAIL:
        thread_log(thread, LEVEL_WARNING, job, "failed: %s", end->reason.text);
        break;
    default:
        thread_log(thread, LEVEL_INFO, job, "handed back");
    }
}

/* Runs a job and hands in how it ended. */
static void job_work(struct worker_thread *thread, struct lease *lease) {
    const struct claimed_job *job = lease_job(lease);
    struct job_end end = {.verb = REPORT_COMPLETE};
    thread->lease = lease;
    atomic_fetch_add(&thread->pool->computing, 1);
    int status = job_run(thread, job, &end.result, &end.reason);
    atomic_fetch_sub(&thread->pool->computing, 1);
    if (status != 0)
        end.verb = status == ERROR_STOPPED ? REPORT_RELEASE : REPORT_FAIL;
    if (lease_is_given_back(lease))
        thread_log(thread, LEVEL_INFO, job, "given back; it runs again when a worker takes it");
    else if (lease_is_lost(lease))
        thread_log(thread, LEVEL_WARNING, job,
                   "dropped: the lease is lost, or the study cancelled");
    else
        job_log(thread, job, &end);
    bool whole = status == 0 && end.result.count == job->count;
    thread->lease = NULL;
    dispatcher_hand_in(thread->pool->dispatcher, &lease, &end);
    if (!whole)
        runner_drop(thread); /* a failed or stopped run leaves it in an unknown state */
}

/* --- a thread --- */

/* Takes and runs jobs until the pool ends or the queue is drained. */
static void thread_work(struct worker_thread *thread) {
    for (;;) {
        struct lease *lease = NULL;
        bool patient = thread->runner == NULL;
        switch (dispatcher_take(thread->pool->dispatcher, patient, &lease)) {
        case OFFER_JOB:
            job_work(thread, lease);
            break;
        case OFFER_NOTHING:
            runner_drop(thread); /* frees its memory while the thread waits */
            break;
        default:
            return;
        }
    }
}

/* The thread's body; context is a struct worker_thread with pool, number and name set. */
static void *worker_thread_main(void *context) {
    struct worker_thread *thread = context;
    thread_work(thread);
    runner_drop(thread);
    pthread_mutex_lock(&thread->pool->lock);
    thread->pool->at_work--;
    pthread_cond_broadcast(&thread->pool->changed);
    pthread_mutex_unlock(&thread->pool->lock);
    return NULL;
}

/* --- the thread that publishes --- */

static bool is_ending(void *context) {
    struct worker_pool *pool = context;
    return atomic_load(&pool->ending);
}

/* Publishes what is due; returns whether some stays due. A failure loses nothing, as results are
 * stored by now and cases stay due. The next time the store is opened anew then. */
static bool pool_publish(struct worker_pool *pool, struct store **store) {
    const struct store_options existing = {.existing = true};
    struct error err = {0};
    struct publish_counts counts = {0};
    int status =
        *store != NULL ? 0 : store_open(store, pool->options->source.database, &existing, &err);
    if (status == 0)
        status = publish_due(*store, is_ending, pool, &counts, &err);
    if (status == ERROR_LIMIT) {
        dispatcher_fail(pool->dispatcher, &err);
    } else if (status != 0 && status != ERROR_STOPPED) {
        const struct log_about about = {.worker = pool->name};
        log_line(LEVEL_WARNING, &about, "cases are not published: %s", err.text);
    }
    if (status != 0 || counts.postponed > 0)
        store_close(store);
    return status != 0 || counts.postponed > 0;
}

/* The thread's body; context is the pool. */
static void *publisher_main(void *context) {
    struct worker_pool *pool = context;
    struct store *store = NULL;
    while (dispatcher_await_due(pool->dispatcher))
        dispatcher_published(pool->dispatcher, pool_publish(pool, &store));
    store_close(&store);
    return NULL;
}

enum {
    THREADS_MOST = 1024,
    STOP_POLL_MS = 100,
    TICK_MS = 500,
    GRACE_MS = 2000 /* how long a realisation that runs may go on after a stop, unless given */
};

/* Makes all threads end as soon as they can. */
static void worker_pool_end(struct worker_pool *pool) {
    atomic_store(&pool->ending, true);
    dispatcher_end(pool->dispatcher);
}

/* Returns whether no thread has run a job for options->idle_s; *busy_ms is when one last ran a
 * job. */
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
            give_back_ms = clock_ms() + (options->grace_ms > 0 ? options->grace_ms : GRACE_MS);
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
    bool started = quiet_thread_start(&thread->handle, worker_thread_main, thread) == 0;
    pool->at_work += started;
    pthread_mutex_unlock(&pool->lock);
    return started ? 0 : error_set(err, ERROR_SYSTEM, "cannot start a worker thread");
}

/* Starts the threads; *started of the workers'. */
static int worker_pool_start(struct worker_pool *pool, struct worker_thread *threads,
                             unsigned *started, struct error *err) {
    int status = 0;
    if (pool->options->source.database != NULL) {
        pool->publishes = quiet_thread_start(&pool->publisher, publisher_main, pool) == 0;
        if (!pool->publishes)
            status = error_set(err, ERROR_SYSTEM, "cannot start the thread that publishes");
    }
    while (*started < pool->options->threads && status == 0) {
        threads[*started] = (struct worker_thread){.pool = pool, .number = *started};
        status = thread_start(&threads[*started], err);
        *started += status == 0;
    }
    return status;
}

static int worker_pool_work(struct worker_pool *pool, struct worker_thread *threads,
                            struct error *err) {
    unsigned started = 0;
    int status = worker_pool_start(pool, threads, &started, err);
    if (status != 0)
        worker_pool_end(pool);
    bool stopped = worker_pool_watch(pool);
    for (unsigned n = 0; n < started; n++)
        pthread_join(threads[n].handle, NULL);
    worker_pool_end(pool);
    if (pool->publishes)
        pthread_join(pool->publisher, NULL);
    if (status == 0)
        status = dispatcher_status(pool->dispatcher, err);
    if (status == 0 && stopped)
        status = error_set(err, ERROR_STOPPED, "stopped");
    return status;
}

/* Makes a name for the process where the caller gave none. */
static void name_default(char *name, size_t size, const char *host) {
    snprintf(name, size, "%s-%ld", host, (long)getpid());
}

static bool is_stopped(void *context) {
    const struct worker_options *options = context;
    return options->stop != NULL && *options->stop != 0;
}

/* Publishes what other processes, or these workers, left due. */
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
    const struct dispatcher_options dispatching = {.source = &own.source,
                                                   .threads = own.threads,
                                                   .drain = own.drain,
                                                   .until_ms = own.until_ms};
    struct worker_thread *threads = array_create(own.threads, sizeof *threads);
    if (threads == NULL)
        return error_memory(err, own.threads * sizeof *threads, "threads");
    if (clock_cond_init(&pool.changed) != 0) {
        free(threads);
        return error_set(err, ERROR_SYSTEM, "cannot make a condition");
    }
    int status = memory_budget_init(&pool.memory, kind_memory_limit(), err);
    if (status == 0 && (status = shared_parts_init(&pool.parts, err)) != 0)
        memory_budget_destroy(&pool.memory);
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
        memory_budget_destroy(&pool.memory);
    }
    free(threads);
    pthread_cond_destroy(&pool.changed);
    return status;
}
