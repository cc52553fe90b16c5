#include "worker/worker_thread.h"
#include "jobs/runner.h"
#include "worker/log.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    IDLE_MOST_MS = 2000,  /* longest pause between two claims while the queue is empty */
    AWAY_MOST_MS = 30000, /* longest pause between two requests while nobody answers */
};

/* The source is to learn that a job ended in one of these ways. */
enum outcome { OUTCOME_COMPLETE, OUTCOME_FAIL, OUTCOME_RELEASE };
struct job_report {
    enum outcome outcome;
    const struct job_kind *kind;
    struct block_result result; /* valid for OUTCOME_COMPLETE */
    struct error reason;        /* valid for OUTCOME_FAIL */
};

/* Logs a line about the job, or about the thread when job is NULL. The option quiet suppresses what
 * is less than a warning. */
__attribute__((format(printf, 4, 5))) static void thread_log(const struct worker_thread *thread,
                                                             enum log_level level,
                                                             const struct claimed_job *job,
                                                             const char *format, ...) {
    if (thread->pool->options->quiet && level < LEVEL_WARNING)
        return;
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

static bool can_wait(int status) {
    return status == ERROR_SYSTEM || status == ERROR_MEMORY;
}

/* --- one job --- */

static void runner_drop(struct worker_thread *thread) {
    if (thread->runner != NULL) {
        runner_destroy(&thread->runner);
        thread->runner = NULL;
    }
    shared_parts_let_go(&thread->pool->parts, &thread->part);
}

/* Makes thread->runner a runner of this job's case. */
static int runner_prepare(struct worker_thread *thread, const struct claimed_job *job,
                          const struct job_kind *kind, struct error *err) {
    if (thread->runner != NULL && thread->kind == kind && thread->case_number == job->case_number &&
        strcmp(thread->study, job->study) == 0)
        return 0;
    runner_drop(thread);
    int status = shared_parts_take(&thread->pool->parts, kind, job->study, job->case_number,
                                   job->parameters, &thread->part, err);
    if (status == 0)
        status = runner_create(&thread->runner, kind, job->parameters,
                               shared_part_content(thread->part), job->seed, job->sequence, err);
    if (status != 0) {
        runner_drop(thread);
    } else {
        thread->kind = kind;
        thread->case_number = job->case_number;
        memcpy(thread->study, job->study, sizeof thread->study);
    }
    return status;
}

static int thread_poll(void *context, uint64_t done) {
    struct worker_thread *thread = context;
    lease_keeper_progress(thread->pool->keeper, thread->slot, done);
    return lease_keeper_is_lost(thread->pool->keeper, thread->slot) ||
           atomic_load(&thread->pool->ending);
}

static int job_run(struct worker_thread *thread, const struct claimed_job *job,
                   struct job_report *report) {
    struct error *err = &report->reason;
    report->kind = kind_find(job->kind);
    if (report->kind == NULL)
        return error_set(err, ERROR_SYSTEM, "this worker knows no kind '%.64s'", job->kind);
    struct job_control control = {.poll = thread_poll, .context = thread};
    int status = runner_prepare(thread, job, report->kind, err);
    if (status == 0)
        status = runner_run(thread->runner, job->first, job->count, &control, &report->result, err);
    return status;
}

static int report_send(struct worker_thread *thread, const struct claimed_job *job,
                       const struct job_report *report, struct error *err) {
    switch (report->outcome) {
    case OUTCOME_COMPLETE:
        return source_complete(thread->source, job, &report->result, err);
    case OUTCOME_FAIL:
        return source_fail(thread->source, job, report->reason.text,
                           report->reason.code == ERROR_INPUT, err);
    default:
        return source_release(thread->source, job, err);
    }
}

/* Reports how a job ended, and repeats it until it is accepted or refused. Once the pool ends, one
 * more request is sent; if that fails too, the lease expires by itself. */
static void report_deliver(struct worker_thread *thread, const struct claimed_job *job,
                           struct job_report *report) {
    struct worker_pool *pool = thread->pool;
    struct backoff backoff = {0};
    for (;;) {
        bool last = atomic_load(&pool->ending);
        struct error err = {0};
        int status = report_send(thread, job, report, &err);
        if (status == 0)
            return;
        if (status == ERROR_STATE) {
            thread_log(thread, LEVEL_WARNING, job, "refused: %s", err.text);
            return;
        }
        if (can_wait(status) && !last) {
            if (backoff.ms == 0)
                thread_log(thread, LEVEL_WARNING, job, "kept, to be sent again: %s", err.text);
            worker_pool_pause(pool, &backoff, AWAY_MOST_MS);
        } else if (report->outcome == OUTCOME_COMPLETE && !can_wait(status)) {
            report->outcome = OUTCOME_FAIL; /* the store must learn why the result was refused */
            error_set(&report->reason, ERROR_SYSTEM, "the result was refused: %.400s", err.text);
        } else {
            thread_log(thread, LEVEL_ERROR, job, "given up, the lease runs out: %s", err.text);
            return;
        }
    }
}

static void job_log(const struct worker_thread *thread, const struct claimed_job *job,
                    const struct job_report *report) {
    switch (report->outcome) {
    case OUTCOME_COMPLETE:
        thread_log(thread, LEVEL_INFO, job,
                   "case %llu: realisations %llu to %llu took %.3g s, %.3g s of CPU time",
                   (unsigned long long)job->case_number, (unsigned long long)job->first,
                   (unsigned long long)(job->first + job->count - 1), report->result.seconds,
                   report->result.cpu_seconds);
        break;
    case OUTCOME_FAIL:
        thread_log(thread, LEVEL_WARNING, job, "failed: %s", report->reason.text);
        break;
    default:
        thread_log(thread, LEVEL_INFO, job, "handed back");
    }
}

/* Runs a claimed job and reports how it ended. */
static void job_work(struct worker_thread *thread, const struct claimed_job *job) {
    struct lease_keeper *keeper = thread->pool->keeper;
    struct job_report report = {.outcome = OUTCOME_COMPLETE};
    lease_keeper_hold(keeper, thread->slot, job);
    int status = job_run(thread, job, &report);
    if (status != 0 && lease_keeper_is_lost(keeper, thread->slot)) {
        thread_log(thread, LEVEL_WARNING, job,
                   "dropped: the lease is lost or given back, or the study cancelled");
    } else {
        if (status != 0)
            report.outcome = status == ERROR_STOPPED ? OUTCOME_RELEASE : OUTCOME_FAIL;
        job_log(thread, job, &report);
        report_deliver(thread, job, &report);
    }
    lease_keeper_let_go(keeper, thread->slot);
    block_result_clear(&report.result);
    if (status != 0)
        runner_drop(thread); /* a failed or stopped run leaves it in an unknown state */
}

/* --- a thread --- */

/* Waits after a claim that found no job. Returns false when, with the option drain, no job can
 * appear any more. */
static bool thread_idle(struct worker_thread *thread, struct backoff *idle) {
    runner_drop(thread); /* frees its memory while the thread waits */
    if (thread->pool->options->drain) {
        struct error err = {0};
        int left = 1;
        if (source_left(thread->source, &left, &err) == 0 && left == 0)
            return false;
    }
    worker_pool_pause(thread->pool, idle, IDLE_MOST_MS);
    return true;
}

/* Claims and runs jobs until the pool ends or the queue is drained. */
static void thread_work(struct worker_thread *thread) {
    struct backoff idle = {0}, away = {0};
    bool on = true;
    while (on && !atomic_load(&thread->pool->ending)) {
        struct claimed_job job = {0};
        struct error err = {0};
        int found = 0;
        int status = source_claim(thread->source, &job, &found, &err);
        if (can_wait(status)) {
            if (away.ms == 0)
                thread_log(thread, LEVEL_WARNING, NULL, "waiting for jobs: %s", err.text);
            worker_pool_pause(thread->pool, &away, AWAY_MOST_MS);
            continue;
        }
        if (status != 0) {
            worker_pool_fail(thread->pool, &err);
            return;
        }
        if (away.ms != 0)
            thread_log(thread, LEVEL_INFO, NULL, "answered again");
        away.ms = 0;
        if (found != 0) {
            idle.ms = 0;
            job_work(thread, &job);
            claimed_job_clear(&job);
        } else {
            on = thread_idle(thread, &idle);
        }
    }
}

void *worker_thread_main(void *context) {
    struct worker_thread *thread = context;
    thread_work(thread);
    runner_drop(thread);
    pthread_mutex_lock(&thread->pool->lock);
    thread->pool->at_work--;
    pthread_cond_broadcast(&thread->pool->changed);
    pthread_mutex_unlock(&thread->pool->lock);
    return NULL;
}
