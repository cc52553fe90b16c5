#include "worker/dispatcher.h"
#include "worker/clock.h"
#include "worker/link/report.h"
#include "worker/link/source.h"
#include "worker/link/wire.h"
#include "worker/log.h"
#include "worker/quiet_thread.h"
#include <math.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>

/* Growing pauses between attempts at what failed and may pass, or at what is not there yet. */

/* Remembers the length of the last pause in milliseconds; {0} at first, and after a success. */
struct backoff {
    int64_t ms;
};

enum { PAUSE_FIRST_MS = 50 };

/* Returns the next pause: up to twice the last one, at most most_ms. Its second half has a random
 * length, so that many workers do not try again at once. */
static int64_t backoff_next(struct backoff *backoff, int64_t most_ms) {
    int64_t pause = backoff->ms != 0 ? 2 * backoff->ms : PAUSE_FIRST_MS;
    backoff->ms = pause < most_ms ? pause : most_ms;
    uint32_t word = 0;
    if (getrandom(&word, sizeof word, GRND_NONBLOCK) != (ssize_t)sizeof word)
        word = 0; /* then without jitter */
    return backoff->ms / 2 + (backoff->ms / 2) * (int64_t)word / UINT32_MAX;
}

enum lease_state {
    LEASE_STOCK,   /* claimed, not begun */
    LEASE_RUNNING, /* a thread has it */
    LEASE_ENDED,   /* to be reported */
    LEASE_GONE,    /* to be freed by the dispatcher's thread */
};

/* The dispatcher's lock protects all fields but the atomic ones. */
struct lease {
    struct claimed_job job; /* owned */
    enum lease_state state;
    int64_t due_ms;   /* time of the next heartbeat, while in stock or running; NEVER: none */
    bool give_back;   /* a running one is to be released while it runs */
    int64_t begun_ms; /* when a thread took it */
    int64_t ended_ms;
    struct job_end end;           /* of an ended one; owned */
    size_t bytes;                 /* of its result, as sent */
    atomic_bool lost, given_back; /* lost, too, what was given back */
    _Atomic double done;          /* realisations, with a part of one */
    struct lease *next;
};

struct dispatcher {
    struct dispatcher_options options;
    struct source *source; /* the thread's own */
    int64_t report_ms;     /* most time between two heartbeats of a running job */
    pthread_t thread;
    pthread_mutex_t lock;  /* guards all below */
    pthread_cond_t news;   /* for the dispatcher's thread */
    pthread_cond_t offers; /* for the worker threads */
    struct lease *leases;  /* owned, in the order of claims */
    struct batch *batch;   /* owned: what is being reported, of the thread alone */
    size_t stock, ended;   /* numbers of leases in these states */
    size_t ended_bytes;    /* of their results */
    double job_seconds;    /* by the clock, mean of recent jobs; 0: not known */
    unsigned waiting;      /* threads that wait for an offer */
    uint64_t vain;         /* claims so far that found nothing */
    bool idle;             /* the last claim found nothing */
    bool due, publishing;  /* cases are to be published; some are just now */
    bool postponed;        /* the last time some cases stayed due */
    /* Of the source, as logged. */
    char other_forms[WIRE_FORMS_SIZE];
    bool drained, closing;
    bool late;            /* the next job would not be done in time */
    atomic_bool ending;   /* read without the lock by claims that wait */
    struct backoff pause; /* between claims that find nothing */
    int64_t claim_ms;     /* time of the next claim */
    struct backoff away;  /* between requests without an answer */
    int64_t away_ms;      /* no claim and no result before */
    int status;           /* of the first error that a later try cannot cure */
    struct error err;
};
static const int64_t NEVER = INT64_MAX;

enum {
    CLAIM_MOST = 100,     /* jobs at once */
    IDLE_MOST_MS = 2000,  /* longest pause between two claims that find nothing */
    AWAY_MOST_MS = 30000, /* longest pause between two requests without an answer */
    WAIT_S = 25, /* how long a claim may wait for a job, while nothing else is to be sent */
};
/* Seconds of work that are claimed at once for a thread without any, as far as known. */
static const double CLAIM_SECONDS = 2;

enum {
    REPORT_MS = 5000,
    /* Bytes of results that wait to be sent; beyond these threads wait before they hand in more. */
    ENDED_BYTES_MOST = 64 << 20,
};

/* --- leases --- */

const struct claimed_job *lease_job(const struct lease *lease) {
    return &lease->job;
}

void lease_progress(struct lease *lease, double done) {
    atomic_store(&lease->done, done);
}

bool lease_is_lost(const struct lease *lease) {
    return atomic_load(&lease->lost);
}

bool lease_is_given_back(const struct lease *lease) {
    return atomic_load(&lease->given_back);
}

/* Returns the time between two heartbeats. */
static int64_t lease_interval_ms(const struct dispatcher *dispatcher, const struct lease *lease) {
    int64_t third = lease->job.lease_ms / 3;
    if (third < 1)
        return 1;
    return lease->state == LEASE_RUNNING && third > dispatcher->report_ms ? dispatcher->report_ms
                                                                          : third;
}

/* Estimates the size of a result as sent: data in base64, numbers in digits. */
static size_t bytes_of(const struct block_result *result) {
    return result->size / 3 * 4 + (size_t)result->count * result->scalar_count * 24;
}

/* Ends a lease in stock, or of a running job, and makes its report due. The caller holds the
 * lock. */
static void lease_end(struct dispatcher *dispatcher, struct lease *lease, enum report_verb verb) {
    dispatcher->stock -= lease->state == LEASE_STOCK;
    lease->state = LEASE_ENDED;
    lease->end.verb = verb;
    lease->ended_ms = clock_ms();
    lease->bytes = verb == REPORT_COMPLETE ? bytes_of(&lease->end.result) : 0;
    dispatcher->ended++;
    dispatcher->ended_bytes += lease->bytes;
}

/* --- a source that does not answer --- */

/* With claimed jobs the source is tried more often, so that leases do not run out meanwhile. */
static int64_t away_most_ms(const struct dispatcher *dispatcher) {
    int64_t most = AWAY_MOST_MS;
    for (const struct lease *lease = dispatcher->leases; lease != NULL; lease = lease->next)
        if (lease->job.lease_ms / 4 < most)
            most = lease->job.lease_ms / 4;
    return most > 1 ? most : 1;
}

/* Notes that there was no answer, or that there was one. */
static void dispatcher_note_away(struct dispatcher *dispatcher, const char *what,
                                 const struct error *err) {
    struct log_about about = {.worker = dispatcher->options.source->worker};
    if (dispatcher->away.ms == 0)
        log_line(LEVEL_WARNING, &about, "%s: %s", what, err->text);
    dispatcher->away_ms = clock_ms() + backoff_next(&dispatcher->away, away_most_ms(dispatcher));
}

static void dispatcher_note_answer(struct dispatcher *dispatcher) {
    struct log_about about = {.worker = dispatcher->options.source->worker};
    if (dispatcher->away.ms != 0)
        log_line(LEVEL_INFO, &about, "answered again");
    dispatcher->away.ms = 0;
    dispatcher->away_ms = 0;
}

/* Notes an error that no later try cures, unless there was one. The caller holds the lock. */
static void end_by(struct dispatcher *dispatcher, const struct error *err) {
    if (dispatcher->status == 0) {
        dispatcher->status = err->code;
        dispatcher->err = *err;
    }
    pthread_cond_broadcast(&dispatcher->offers);
}

/* --- reports, by the thread of the dispatcher: the lock is held, and released meanwhile --- */

/* The dispatcher's reports: heartbeats first, which are small and must not be late, and then ends
 * of jobs. */

enum {
    BATCH_MOST = 250,
    BATCH_BYTES = 1 << 20, /* of results, but for one that is larger */
    LINGER_MS = 100,       /* how long a result waits for others, while there are jobs to run */
    RETRY_PART = 4,
};

struct batch {
    struct lease *leases[BATCH_MOST];
    struct report reports[BATCH_MOST];
    size_t count;
};

static void lease_log(const struct dispatcher *dispatcher, enum log_level level,
                      const struct lease *lease, const char *what, const char *why) {
    struct log_about about = {.worker = dispatcher->options.source->worker,
                              .study = lease->job.study,
                              .job = lease->job.id,
                              .attempt = lease->job.attempt};
    log_line(level, &about, "%s: %s", what, why);
}

/* Returns whether a lease needs heartbeats, as that of a result does until it is taken. */
static bool beats(const struct lease *lease) {
    return lease->state == LEASE_STOCK || lease->state == LEASE_RUNNING ||
           (lease->state == LEASE_ENDED && lease->end.verb == REPORT_COMPLETE);
}

/* Results are sent at once if a thread has nothing to do or there are many, else soon. */
static int64_t ended_due_ms(const struct dispatcher *dispatcher, int64_t first_ms) {
    if (atomic_load(&dispatcher->ending))
        return 0;
    bool now = (dispatcher->waiting > 0 && dispatcher->stock == 0) ||
               dispatcher->ended >= BATCH_MOST || dispatcher->ended_bytes >= BATCH_BYTES;
    int64_t due_ms = now ? 0 : first_ms + LINGER_MS;
    return due_ms > dispatcher->away_ms ? due_ms : dispatcher->away_ms;
}

/* Returns when the next report is due; NEVER where there is none. */
static int64_t dispatcher_report_ms(const struct dispatcher *dispatcher, int64_t now_ms) {
    int64_t due_ms = NEVER, first_ms = now_ms;
    for (const struct lease *lease = dispatcher->leases; lease != NULL; lease = lease->next) {
        if (beats(lease) && lease->due_ms < due_ms)
            due_ms = lease->due_ms;
        if (lease->state == LEASE_ENDED && lease->ended_ms < first_ms)
            first_ms = lease->ended_ms;
    }
    if (dispatcher->ended == 0)
        return due_ms;
    int64_t ended_ms = ended_due_ms(dispatcher, first_ms);
    return ended_ms < due_ms ? ended_ms : due_ms;
}

static void batch_add(struct batch *batch, struct lease *lease, enum report_verb verb) {
    batch->leases[batch->count] = lease;
    batch->reports[batch->count++] = (struct report){
        .verb = verb,
        .job = &lease->job,
        .done = atomic_load(&lease->done),
        .result = &lease->end.result,
        .reason = lease->end.reason.text,
        .permanent = lease->end.reason.code == ERROR_INPUT,
    };
}

/* Adds heartbeats, if one is due, with those that will soon be. */
static void batch_beats(const struct dispatcher *dispatcher, int64_t now_ms, struct batch *batch) {
    bool due = false;
    for (struct lease *lease = dispatcher->leases; lease != NULL; lease = lease->next)
        due = due || (beats(lease) && lease->due_ms <= now_ms);
    for (struct lease *lease = dispatcher->leases;
         due && lease != NULL && batch->count < BATCH_MOST; lease = lease->next)
        if (beats(lease) && lease->due_ms != NEVER &&
            lease->due_ms <= now_ms + lease_interval_ms(dispatcher, lease) / 4)
            batch_add(batch, lease,
                      lease->give_back && lease->state == LEASE_RUNNING ? REPORT_RELEASE
                                                                        : REPORT_HEARTBEAT);
}

static void batch_ended(const struct dispatcher *dispatcher, struct batch *batch) {
    size_t bytes = 0;
    for (struct lease *lease = dispatcher->leases; lease != NULL && batch->count < BATCH_MOST;
         lease = lease->next) {
        bool fits = batch->count == 0 || bytes + lease->bytes <= BATCH_BYTES;
        if (lease->state != LEASE_ENDED || !fits)
            continue;
        batch_add(batch, lease, lease->end.verb);
        bytes += lease->bytes;
    }
}

static void lose(struct dispatcher *dispatcher, struct lease *lease) {
    atomic_store(&lease->lost, true);
    lease->due_ms = NEVER;
    if (lease->state == LEASE_STOCK) {
        dispatcher->stock--;
        lease->state = LEASE_GONE;
    }
}

/* Handles the answer to a heartbeat, unless the job has ended meanwhile, which has a report of its
 * own. */
static void settle_beat(struct dispatcher *dispatcher, struct lease *lease,
                        const struct report *report) {
    bool released = report->verb == REPORT_RELEASE && report->status == 0;
    if (!beats(lease))
        return;
    int64_t interval = lease_interval_ms(dispatcher, lease);
    atomic_store(&lease->given_back, released);
    if (report->status == ERROR_STATE || released)
        lose(dispatcher, lease);
    else
        lease->due_ms = clock_ms() + (report->status != 0 ? interval / RETRY_PART + 1 : interval);
}

static void settled(struct dispatcher *dispatcher, struct lease *lease) {
    dispatcher->ended--;
    dispatcher->ended_bytes -= lease->bytes;
    lease->state = LEASE_GONE;
}

/* Handles a result that was refused: its job fails with the reason. The job is released if the
 * result is a part of it, which an older server does not take, or too large for a limit of this
 * process. */
static void refuse_result(struct dispatcher *dispatcher, struct lease *lease,
                          const struct error *why) {
    bool back = lease->end.result.count < lease->job.count || why->code == ERROR_LIMIT;
    dispatcher->ended--;
    dispatcher->ended_bytes -= lease->bytes;
    block_result_clear(&lease->end.result);
    error_set(&lease->end.reason, ERROR_SYSTEM, "the result was refused: %.400s", why->text);
    lease_end(dispatcher, lease, back ? REPORT_RELEASE : REPORT_FAIL);
    lease_log(dispatcher, LEVEL_WARNING, lease, back ? "given back" : "failed",
              lease->end.reason.text);
}

/* Returns whether the source could not take a report, and is not to blame the report for it. */
static bool is_hindered(int status) {
    return status == ERROR_SYSTEM || status == ERROR_MEMORY || status == ERROR_LIMIT;
}

static void settle_ended(struct dispatcher *dispatcher, struct lease *lease,
                         const struct report *report) {
    bool later = is_hindered(report->status) && report->status != ERROR_LIMIT;
    if (report->status == 0) {
        settled(dispatcher, lease);
    } else if (report->status == ERROR_STATE) {
        lease_log(dispatcher, LEVEL_WARNING, lease, "refused", report->err.text);
        settled(dispatcher, lease);
    } else if (!later && report->verb == REPORT_COMPLETE) {
        refuse_result(dispatcher, lease, &report->err);
    } else if (!later || atomic_load(&dispatcher->ending)) {
        lease_log(dispatcher, LEVEL_ERROR, lease, "given up, the lease runs out", report->err.text);
        settled(dispatcher, lease);
    }
}

/* Sends a batch, after which its reports have their answers. */
static void send_batch(struct dispatcher *dispatcher, struct batch *batch, bool *due,
                       struct error *err) {
    pthread_mutex_unlock(&dispatcher->lock);
    int status = source_report(dispatcher->source, batch->reports, batch->count, due, err);
    for (size_t n = 0; n < batch->count && status != 0; n++) {
        batch->reports[n].status = status;
        batch->reports[n].err = *err;
    }
    pthread_mutex_lock(&dispatcher->lock);
}

static bool any_hindered(const struct batch *batch, const struct error **err) {
    for (size_t n = 0; n < batch->count; n++) {
        *err = &batch->reports[n].err;
        if (is_hindered(batch->reports[n].status))
            return true;
    }
    return false;
}

static void dispatcher_report(struct dispatcher *dispatcher) {
    struct batch *batch = dispatcher->batch;
    const struct error *why = NULL;
    struct error err = {0};
    bool due = false;
    batch->count = 0;
    batch_beats(dispatcher, clock_ms(), batch);
    bool beating = batch->count > 0;
    if (!beating)
        batch_ended(dispatcher, batch);
    if (batch->count > 0)
        send_batch(dispatcher, batch, &due, &err);
    if (!any_hindered(batch, &why))
        dispatcher_note_answer(dispatcher);
    else if (why->code == ERROR_LIMIT)
        end_by(dispatcher, why);
    else
        dispatcher_note_away(dispatcher, "not taken, to be sent again", why);
    for (size_t n = 0; n < batch->count; n++) {
        if (beating)
            settle_beat(dispatcher, batch->leases[n], &batch->reports[n]);
        else
            settle_ended(dispatcher, batch->leases[n], &batch->reports[n]);
    }
    dispatcher->due |= due;
    pthread_cond_broadcast(&dispatcher->offers);
}

/* --- claims --- */

static int claim_is_over(void *context) {
    const struct dispatcher *dispatcher = context;
    return atomic_load(&dispatcher->ending);
}

/* Takes the jobs. One without memory for it is lost, and its lease runs out. */
static void stock_add(struct dispatcher *dispatcher, struct claimed_job *jobs, size_t count) {
    struct lease **last = &dispatcher->leases;
    while (*last != NULL)
        last = &(*last)->next;
    for (size_t n = 0; n < count; n++) {
        struct lease *lease = array_create(1, sizeof *lease);
        if (lease == NULL) {
            claimed_job_clear(&jobs[n]);
            continue;
        }
        lease->job = jobs[n];
        lease->state = LEASE_STOCK;
        lease->due_ms = clock_ms() + lease_interval_ms(dispatcher, lease);
        atomic_init(&lease->lost, false);
        atomic_init(&lease->given_back, false);
        atomic_init(&lease->done, 0);
        *last = lease;
        last = &lease->next;
        dispatcher->stock++;
    }
}

/* Handles a claim that found nothing: checks whether anything may still come, or waits. waited: the
 * claim itself did. */
static void claim_was_vain(struct dispatcher *dispatcher, bool waited) {
    int left = 1;
    bool due = false;
    if (dispatcher->options.drain) {
        struct error ignored = {0};
        pthread_mutex_unlock(&dispatcher->lock);
        if (source_left(dispatcher->source, &left, &due, &ignored) != 0)
            left = 1;
        pthread_mutex_lock(&dispatcher->lock);
    }
    /* what cannot be published now, as on a full disk, is published when the store is opened
     * next */
    dispatcher->drained = left == 0 && (!due || dispatcher->postponed) && !dispatcher->publishing &&
                          dispatcher->leases == NULL;
    dispatcher->due |= due && !dispatcher->drained;
    dispatcher->idle = true;
    dispatcher->vain++;
    if (!waited)
        dispatcher->claim_ms = clock_ms() + backoff_next(&dispatcher->pause, IDLE_MOST_MS);
}

/* Returns how long a claim may wait at the server: only if the process has nothing else to send. */
static unsigned wait_wanted(const struct dispatcher *dispatcher) {
    bool nothing_else = dispatcher->idle && !dispatcher->options.drain &&
                        dispatcher->leases == NULL && !dispatcher->due &&
                        dispatcher->waiting == dispatcher->options.threads;
    return nothing_else ? WAIT_S : 0;
}

/* Memory that others take may come back; where nothing is at work here, and it did not come while
 * the pauses grew to their longest, it will not. */
static bool is_out_of_memory(const struct dispatcher *dispatcher) {
    return dispatcher->leases == NULL && dispatcher->away.ms >= away_most_ms(dispatcher);
}

/* Logs which kinds the source keeps from this program, each time that they change. */
static void note_other_forms(struct dispatcher *dispatcher) {
    struct log_about about = {.worker = dispatcher->options.source->worker};
    const char *forms = source_other_forms(dispatcher->source);
    if (strcmp(forms, dispatcher->other_forms) == 0)
        return;
    snprintf(dispatcher->other_forms, sizeof dispatcher->other_forms, "%s", forms);
    if (forms[0] != '\0')
        log_line(LEVEL_WARNING, &about,
                 "no jobs of %s: the server reads their results in another form than this program "
                 "makes; use one version of rugo for both",
                 forms);
    else
        log_line(LEVEL_INFO, &about,
                 "jobs of all kinds again: the server has this program's forms");
}

static void claim(struct dispatcher *dispatcher) {
    struct claimed_job jobs[CLAIM_MOST];
    struct wish wish = {
        .count = CLAIM_MOST,
        .seconds = CLAIM_SECONDS * (double)(dispatcher->waiting - dispatcher->stock),
        .threads = dispatcher->options.threads,
        .wait_s = wait_wanted(dispatcher),
        .stop = claim_is_over,
        .context = dispatcher,
    };
    struct error err = {0};
    size_t count = 0;
    bool due = false;
    pthread_mutex_unlock(&dispatcher->lock);
    int64_t start_ms = clock_ms();
    int status = source_claim(dispatcher->source, &wish, jobs, &count, &due, &err);
    bool waited = wish.wait_s > 0 && clock_ms() - start_ms >= 500 * (int64_t)wish.wait_s;
    pthread_mutex_lock(&dispatcher->lock);
    if (status == ERROR_STOPPED)
        return;
    if (status == ERROR_SYSTEM || (status == ERROR_MEMORY && !is_out_of_memory(dispatcher))) {
        dispatcher_note_away(dispatcher, "waiting for jobs", &err);
        return;
    }
    if (status != 0) {
        err.code = status;
        end_by(dispatcher, &err);
        return;
    }
    dispatcher_note_answer(dispatcher);
    note_other_forms(dispatcher);
    dispatcher->due |= due;
    if (count == 0) {
        claim_was_vain(dispatcher, waited);
    } else {
        dispatcher->idle = false;
        dispatcher->pause.ms = 0;
        stock_add(dispatcher, jobs, count);
    }
    pthread_cond_broadcast(&dispatcher->offers);
}

/* Returns when the next claim is due; NEVER where none is. */
static int64_t claim_due_ms(const struct dispatcher *dispatcher) {
    if (atomic_load(&dispatcher->ending) || dispatcher->drained || dispatcher->late ||
        dispatcher->status != 0 || dispatcher->waiting <= dispatcher->stock)
        return NEVER;
    return dispatcher->claim_ms > dispatcher->away_ms ? dispatcher->claim_ms : dispatcher->away_ms;
}

/* --- the stock --- */

/* Returns how many jobs may be in stock: those of a few seconds, as measured. */
static size_t stock_most(const struct dispatcher *dispatcher) {
    if (atomic_load(&dispatcher->ending) || dispatcher->late)
        return 0;
    if (!(dispatcher->job_seconds > 0))
        return SIZE_MAX;
    double jobs = ceil(CLAIM_SECONDS / dispatcher->job_seconds) * dispatcher->options.threads;
    return jobs < CLAIM_MOST ? (size_t)jobs : CLAIM_MOST;
}

/* Releases jobs at the end of the stock beyond that number, and frees leases that are gone. */
static void sweep(struct dispatcher *dispatcher) {
    size_t most = stock_most(dispatcher), kept = 0;
    for (struct lease **at = &dispatcher->leases; *at != NULL;) {
        struct lease *lease = *at;
        if (lease->state == LEASE_STOCK && kept++ >= most)
            lease_end(dispatcher, lease, REPORT_RELEASE);
        if (lease->state != LEASE_GONE) {
            at = &lease->next;
            continue;
        }
        *at = lease->next;
        claimed_job_clear(&lease->job);
        block_result_clear(&lease->end.result);
        free(lease);
    }
}

/* --- the thread --- */

/* The thread's body. */
static void *dispatcher_thread_main(void *context) {
    struct dispatcher *dispatcher = context;
    pthread_mutex_lock(&dispatcher->lock);
    for (;;) {
        sweep(dispatcher);
        int64_t now = clock_ms(), report_ms = dispatcher_report_ms(dispatcher, now);
        int64_t claim_ms = claim_due_ms(dispatcher);
        if (report_ms <= now)
            dispatcher_report(dispatcher);
        else if (dispatcher->closing)
            break;
        else if (claim_ms <= now)
            claim(dispatcher);
        else if (report_ms == NEVER && claim_ms == NEVER)
            pthread_cond_wait(&dispatcher->news, &dispatcher->lock);
        else
            clock_cond_wait(&dispatcher->news, &dispatcher->lock,
                            report_ms < claim_ms ? report_ms : claim_ms);
    }
    for (struct lease *lease = dispatcher->leases; lease != NULL; lease = lease->next)
        lease->state = LEASE_GONE;
    sweep(dispatcher);
    pthread_mutex_unlock(&dispatcher->lock);
    return NULL;
}

/* --- for the worker threads --- */

static struct lease *stock_first(const struct dispatcher *dispatcher) {
    struct lease *lease = dispatcher->leases;
    while (lease != NULL && lease->state != LEASE_STOCK)
        lease = lease->next;
    return lease;
}

static struct lease *stock_take(struct dispatcher *dispatcher) {
    struct lease *lease = stock_first(dispatcher);
    dispatcher->stock--;
    lease->state = LEASE_RUNNING;
    lease->begun_ms = clock_ms();
    int64_t due_ms = lease->begun_ms + lease_interval_ms(dispatcher, lease);
    lease->due_ms = due_ms < lease->due_ms ? due_ms : lease->due_ms;
    return lease;
}

/* Notes whether the next job would not be done in time. */
static void look_at_time(struct dispatcher *dispatcher) {
    const struct lease *next = stock_first(dispatcher);
    if (dispatcher->late || dispatcher->options.until_ms == 0 || next == NULL ||
        next->job.count > 1 || !(dispatcher->job_seconds > 0))
        return;
    double left_s = 1e-3 * (double)(dispatcher->options.until_ms - clock_ms());
    if (dispatcher->job_seconds <= left_s)
        return;
    struct log_about about = {.worker = dispatcher->options.source->worker};
    log_line(LEVEL_INFO, &about, "no time is left for another job: they take about %.3g s",
             dispatcher->job_seconds);
    dispatcher->late = true;
    pthread_cond_signal(&dispatcher->news);
    pthread_cond_broadcast(&dispatcher->offers);
}

/* Returns what a thread may do now; OFFER_NOTHING: nothing yet. */
static enum offer offer_now(struct dispatcher *dispatcher, struct lease **out) {
    look_at_time(dispatcher);
    if (atomic_load(&dispatcher->ending) || dispatcher->late || dispatcher->status != 0)
        return OFFER_END;
    if (dispatcher->stock > 0) {
        *out = stock_take(dispatcher);
        return OFFER_JOB;
    }
    return dispatcher->drained ? OFFER_END : OFFER_NOTHING;
}

enum offer dispatcher_take(struct dispatcher *dispatcher, bool patient, struct lease **out) {
    pthread_mutex_lock(&dispatcher->lock);
    uint64_t vain = dispatcher->vain;
    enum offer offer = offer_now(dispatcher, out);
    dispatcher->waiting++;
    while (offer == OFFER_NOTHING && (patient || vain == dispatcher->vain)) {
        pthread_cond_signal(&dispatcher->news);
        pthread_cond_wait(&dispatcher->offers, &dispatcher->lock);
        offer = offer_now(dispatcher, out);
    }
    dispatcher->waiting--;
    pthread_mutex_unlock(&dispatcher->lock);
    return offer;
}

bool dispatcher_await_due(struct dispatcher *dispatcher) {
    pthread_mutex_lock(&dispatcher->lock);
    while (!dispatcher->due && !dispatcher->drained && dispatcher->status == 0 &&
           !atomic_load(&dispatcher->ending))
        pthread_cond_wait(&dispatcher->offers, &dispatcher->lock);
    bool due = dispatcher->due && dispatcher->status == 0 && !atomic_load(&dispatcher->ending);
    dispatcher->publishing = due;
    dispatcher->due = dispatcher->due && !due;
    pthread_mutex_unlock(&dispatcher->lock);
    return due;
}

void dispatcher_published(struct dispatcher *dispatcher, bool postponed) {
    pthread_mutex_lock(&dispatcher->lock);
    dispatcher->publishing = false;
    dispatcher->postponed = postponed;
    dispatcher->pause.ms = 0; /* the queue may be drained, or longer */
    dispatcher->claim_ms = 0;
    pthread_cond_signal(&dispatcher->news);
    pthread_cond_broadcast(&dispatcher->offers);
    pthread_mutex_unlock(&dispatcher->lock);
}

/* Updates the mean seconds of a job, in which the newest one counts a quarter. */
static void measure(struct dispatcher *dispatcher, const struct lease *lease) {
    double seconds = 1e-3 * (double)(clock_ms() - lease->begun_ms);
    double before = dispatcher->job_seconds > 0 ? dispatcher->job_seconds : seconds;
    dispatcher->job_seconds = 0.75 * before + 0.25 * seconds;
}

void dispatcher_hand_in(struct dispatcher *dispatcher, struct lease **lease, struct job_end *end) {
    struct lease *ended = *lease;
    pthread_mutex_lock(&dispatcher->lock);
    while (dispatcher->ended_bytes > ENDED_BYTES_MOST && !atomic_load(&dispatcher->ending))
        pthread_cond_wait(&dispatcher->offers, &dispatcher->lock);
    ended->end = *end;
    if (end->verb == REPORT_COMPLETE)
        measure(dispatcher, ended);
    if (lease_is_lost(ended))
        ended->state = LEASE_GONE;
    else
        lease_end(dispatcher, ended, end->verb);
    dispatcher->pause.ms = 0; /* the end may have queued more to claim */
    dispatcher->claim_ms = 0;
    pthread_cond_signal(&dispatcher->news);
    pthread_mutex_unlock(&dispatcher->lock);
    end->result = (struct block_result){0};
    *lease = NULL;
}

/* --- the end --- */

void dispatcher_end(struct dispatcher *dispatcher) {
    pthread_mutex_lock(&dispatcher->lock);
    atomic_store(&dispatcher->ending, true);
    pthread_cond_signal(&dispatcher->news);
    pthread_cond_broadcast(&dispatcher->offers);
    pthread_mutex_unlock(&dispatcher->lock);
}

void dispatcher_give_back(struct dispatcher *dispatcher) {
    pthread_mutex_lock(&dispatcher->lock);
    for (struct lease *lease = dispatcher->leases; lease != NULL; lease = lease->next) {
        if (lease->state == LEASE_RUNNING && lease->due_ms != NEVER) {
            lease->give_back = true;
            lease->due_ms = 0;
        }
    }
    pthread_cond_signal(&dispatcher->news);
    pthread_mutex_unlock(&dispatcher->lock);
}

void dispatcher_fail(struct dispatcher *dispatcher, const struct error *err) {
    pthread_mutex_lock(&dispatcher->lock);
    end_by(dispatcher, err);
    pthread_mutex_unlock(&dispatcher->lock);
}

int dispatcher_status(struct dispatcher *dispatcher, struct error *err) {
    pthread_mutex_lock(&dispatcher->lock);
    int status = dispatcher->status;
    if (status != 0)
        *err = dispatcher->err;
    pthread_mutex_unlock(&dispatcher->lock);
    return status;
}

/* --- life --- */

/* Makes lock, conditions and thread; after a failure none of them is left. */
static int dispatcher_start(struct dispatcher *dispatcher, struct error *err) {
    if (clock_cond_init(&dispatcher->news) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot make a condition");
    if (clock_cond_init(&dispatcher->offers) != 0) {
        pthread_cond_destroy(&dispatcher->news);
        return error_set(err, ERROR_SYSTEM, "cannot make a condition");
    }
    pthread_mutex_init(&dispatcher->lock, NULL);
    if (quiet_thread_start(&dispatcher->thread, dispatcher_thread_main, dispatcher) != 0) {
        pthread_mutex_destroy(&dispatcher->lock);
        pthread_cond_destroy(&dispatcher->offers);
        pthread_cond_destroy(&dispatcher->news);
        return error_set(err, ERROR_SYSTEM, "cannot start the dispatcher's thread");
    }
    return 0;
}

int dispatcher_create(struct dispatcher **out, const struct dispatcher_options *options,
                      struct error *err) {
    struct dispatcher *dispatcher = array_create(1, sizeof *dispatcher);
    if (dispatcher == NULL)
        return error_memory(err, sizeof *dispatcher, "a dispatcher");
    dispatcher->options = *options;
    dispatcher->report_ms = options->source->report_ms > 0 ? options->source->report_ms : REPORT_MS;
    atomic_init(&dispatcher->ending, false);
    dispatcher->batch = array_create(1, sizeof *dispatcher->batch);
    int status = dispatcher->batch != NULL
                     ? source_create(&dispatcher->source, options->source, err)
                     : error_memory(err, sizeof *dispatcher->batch, "reports");
    status = status != 0 ? status : dispatcher_start(dispatcher, err);
    if (status != 0) {
        source_destroy(&dispatcher->source);
        free(dispatcher->batch);
        free(dispatcher);
        return status;
    }
    *out = dispatcher;
    return 0;
}

void dispatcher_destroy(struct dispatcher **dispatcher) {
    struct dispatcher *gone = *dispatcher;
    if (gone == NULL)
        return;
    pthread_mutex_lock(&gone->lock);
    gone->closing = true;
    atomic_store(&gone->ending, true);
    pthread_cond_signal(&gone->news);
    pthread_mutex_unlock(&gone->lock);
    pthread_join(gone->thread, NULL); /* which frees all leases */
    pthread_mutex_destroy(&gone->lock);
    pthread_cond_destroy(&gone->offers);
    pthread_cond_destroy(&gone->news);
    source_destroy(&gone->source);
    free(gone->batch);
    free(gone);
    *dispatcher = NULL;
}
