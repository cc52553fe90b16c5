#include "worker/hand.h"
#include "worker/log.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    IDLE_MOST_MS = 2000,  /* between two looks into an empty queue */
    AWAY_MOST_MS = 30000, /* between two tries while nobody answers */
};

/* What is to be told about a job that ended. */
enum outcome { OUTCOME_COMPLETE, OUTCOME_FAIL, OUTCOME_RELEASE };
struct report {
    enum outcome outcome;
    const struct job_kind *kind;
    struct job_result result; /* of OUTCOME_COMPLETE */
    struct error reason;      /* of OUTCOME_FAIL */
};

/* job may be NULL. Information is for those who did not ask for quiet. */
__attribute__((format(printf, 4, 5))) static void hand_log(const struct hand *hand,
                                                           enum log_level level,
                                                           const struct claimed_job *job,
                                                           const char *format, ...) {
    if (hand->crew->options->quiet && level < LEVEL_WARNING) {
        return;
    }
    char text[LOG_LINE_MOST];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    struct log_about about = {.worker = hand->name};
    if (job) {
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

static void runner_drop(struct hand *hand) {
    if (hand->runner) {
        hand->kind->runner_destroy(&hand->runner);
        hand->runner = NULL;
    }
    shared_parts_let_go(&hand->crew->parts, &hand->part);
}

/* Makes hand->runner the one of this job's case. */
static int runner_prepare(struct hand *hand, const struct claimed_job *job,
                          const struct job_kind *kind, struct error *err) {
    if (hand->runner && hand->kind == kind && hand->case_number == job->case_number &&
        strcmp(hand->study, job->study) == 0) {
        return 0;
    }
    runner_drop(hand);
    cJSON *parameters = NULL;
    int status = json_parse(job->parameters, strlen(job->parameters), NULL, &parameters, err);
    if (!status) {
        status = shared_parts_take(&hand->crew->parts, kind, job->study, job->case_number,
                                   parameters, &hand->part, err);
    }
    if (!status) {
        status = kind->runner_create(&hand->runner, parameters, shared_part_content(hand->part),
                                     job->seed, job->case_number, err);
    }
    cJSON_Delete(parameters);
    if (status) {
        runner_drop(hand);
    } else {
        hand->kind = kind;
        hand->case_number = job->case_number;
        memcpy(hand->study, job->study, sizeof hand->study);
    }
    return status;
}

static int hand_poll(void *context, uint64_t done) {
    struct hand *hand = context;
    keeper_progress(hand->crew->keeper, hand->slot, done);
    return keeper_is_lost(hand->crew->keeper, hand->slot) || atomic_load(&hand->crew->ending);
}

static int job_run(struct hand *hand, const struct claimed_job *job, struct report *report) {
    struct error *err = &report->reason;
    report->kind = kind_find(job->kind);
    if (!report->kind) {
        return error_set(err, ERROR_SYSTEM, "this worker knows no kind '%.64s'", job->kind);
    }
    struct job_control control = {.poll = hand_poll, .context = hand};
    int status = runner_prepare(hand, job, report->kind, err);
    if (!status) {
        status =
            report->kind->run(hand->runner, job->first, job->count, &control, &report->result, err);
    }
    return status;
}

static int report_send(struct hand *hand, const struct claimed_job *job,
                       const struct report *report, struct error *err) {
    switch (report->outcome) {
    case OUTCOME_COMPLETE:
        return source_complete(hand->source, job, report->kind, &report->result, err);
    case OUTCOME_FAIL:
        return source_fail(hand->source, job, report->reason.text,
                           report->reason.code == ERROR_INPUT, err);
    default:
        return source_release(hand->source, job, err);
    }
}

/* Tells how a job ended, again and again until it is taken or refused. When the worker is told to
 * end there is one try more; after that the lease runs out by itself. */
static void report_deliver(struct hand *hand, const struct claimed_job *job,
                           struct report *report) {
    struct crew *crew = hand->crew;
    struct backoff backoff = {0};
    for (;;) {
        bool last = atomic_load(&crew->ending);
        struct error err = {0};
        int status = report_send(hand, job, report, &err);
        if (status == 0) {
            return;
        }
        if (status == ERROR_STATE) {
            hand_log(hand, LEVEL_WARNING, job, "refused: %s", err.text);
            return;
        }
        if (can_wait(status) && !last) {
            if (backoff.ms == 0) {
                hand_log(hand, LEVEL_WARNING, job, "kept, to be sent again: %s", err.text);
            }
            crew_pause(crew, &backoff, AWAY_MOST_MS);
        } else if (report->outcome == OUTCOME_COMPLETE && !can_wait(status)) {
            report->outcome = OUTCOME_FAIL; /* a result that is not wanted must leave its reason */
            error_set(&report->reason, ERROR_SYSTEM, "the result was refused: %.400s", err.text);
        } else {
            hand_log(hand, LEVEL_ERROR, job, "given up, the lease runs out: %s", err.text);
            return;
        }
    }
}

static void job_log(const struct hand *hand, const struct claimed_job *job,
                    const struct report *report) {
    switch (report->outcome) {
    case OUTCOME_COMPLETE:
        hand_log(hand, LEVEL_INFO, job, "case %llu: realisations %llu to %llu took %.3g s",
                 (unsigned long long)job->case_number, (unsigned long long)job->first,
                 (unsigned long long)(job->first + job->count - 1), report->result.seconds);
        break;
    case OUTCOME_FAIL:
        hand_log(hand, LEVEL_WARNING, job, "failed: %s", report->reason.text);
        break;
    default:
        hand_log(hand, LEVEL_INFO, job, "handed back");
    }
}

/* Runs a claimed job and tells how it ended. */
static void job_work(struct hand *hand, const struct claimed_job *job) {
    struct keeper *keeper = hand->crew->keeper;
    struct report report = {.outcome = OUTCOME_COMPLETE};
    keeper_hold(keeper, hand->slot, job);
    int status = job_run(hand, job, &report);
    if (status && keeper_is_lost(keeper, hand->slot)) {
        hand_log(hand, LEVEL_WARNING, job,
                 "dropped: the lease is lost or given back, or the study cancelled");
    } else {
        if (status) {
            report.outcome = status == ERROR_STOPPED ? OUTCOME_RELEASE : OUTCOME_FAIL;
        }
        job_log(hand, job, &report);
        report_deliver(hand, job, &report);
    }
    keeper_let_go(keeper, hand->slot);
    job_result_clear(&report.result);
    if (status) {
        runner_drop(hand); /* whatever state it was left in */
    }
}

/* --- a thread --- */

/* An empty queue: waits, or tells that there is nothing left to wait for. */
static bool hand_idle(struct hand *hand, struct backoff *idle) {
    runner_drop(hand); /* its memory is not needed now */
    if (hand->crew->options->drain) {
        struct error err = {0};
        int left = 1;
        if (source_left(hand->source, &left, &err) == 0 && !left) {
            return false;
        }
    }
    crew_pause(hand->crew, idle, IDLE_MOST_MS);
    return true;
}

/* Claims and works until the end. */
static void hand_work(struct hand *hand) {
    struct backoff idle = {0}, away = {0};
    bool on = true;
    while (on && !atomic_load(&hand->crew->ending)) {
        struct claimed_job job = {0};
        struct error err = {0};
        int found = 0;
        int status = source_claim(hand->source, &job, &found, &err);
        if (can_wait(status)) {
            if (away.ms == 0) {
                hand_log(hand, LEVEL_WARNING, NULL, "waiting for jobs: %s", err.text);
            }
            crew_pause(hand->crew, &away, AWAY_MOST_MS);
            continue;
        }
        if (status) {
            crew_fail(hand->crew, &err);
            return;
        }
        if (away.ms) {
            hand_log(hand, LEVEL_INFO, NULL, "answered again");
        }
        away.ms = 0;
        if (found) {
            idle.ms = 0;
            job_work(hand, &job);
            claimed_job_clear(&job);
        } else {
            on = hand_idle(hand, &idle);
        }
    }
}

void *hand_main(void *context) {
    struct hand *hand = context;
    hand_work(hand);
    runner_drop(hand);
    pthread_mutex_lock(&hand->crew->lock);
    hand->crew->at_work--;
    pthread_cond_broadcast(&hand->crew->changed);
    pthread_mutex_unlock(&hand->crew->lock);
    return NULL;
}
