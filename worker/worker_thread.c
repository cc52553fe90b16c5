#include "worker/worker_thread.h"
#include "jobs/runner.h"
#include "worker/log.h"
#include "worker/publish.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
    lease_progress(thread->lease, done);
    return lease_is_lost(thread->lease) || atomic_load(&thread->pool->ending);
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
    if (lease_is_lost(lease))
        thread_log(thread, LEVEL_WARNING, job,
                   "dropped: the lease is lost or given back, or the study cancelled");
    else
        job_log(thread, job, &end);
    bool whole = status == 0 && end.result.count == job->count;
    thread->lease = NULL;
    dispatcher_hand_in(thread->pool->dispatcher, &lease, &end);
    if (!whole)
        runner_drop(thread); /* a failed or stopped run leaves it in an unknown state */
}

/* --- a thread --- */

static bool is_ending(void *context) {
    struct worker_thread *thread = context;
    return atomic_load(&thread->pool->ending);
}

/* What the workers did is safe by now: a case that is not published stays due. */
static void thread_publish(struct worker_thread *thread) {
    struct store *store = NULL;
    struct error err = {0};
    struct publish_counts counts = {0};
    const struct store_options existing = {.existing = true};
    int status = store_open(&store, thread->pool->options->source.database, &existing, &err);
    if (status == 0)
        status = publish_due(store, is_ending, thread, &counts, &err);
    if (status != 0 && status != ERROR_STOPPED)
        thread_log(thread, LEVEL_WARNING, NULL, "cases are not published: %s", err.text);
    store_close(&store);
    dispatcher_published(thread->pool->dispatcher, status != 0 || counts.postponed > 0);
}

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
        case OFFER_PUBLISH:
            thread_publish(thread);
            break;
        default:
            return;
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
