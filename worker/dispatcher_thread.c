/* The dispatcher's own thread: claims, and turns with reports. */
#include "worker/dispatcher_internal.h"
#include "worker/log.h"

#include <math.h>
#include <stdlib.h>

enum {
    CLAIM_MOST = 100,     /* jobs at once */
    IDLE_MOST_MS = 2000,  /* longest pause between two claims that find nothing */
    AWAY_MOST_MS = 30000, /* longest pause between two requests that nobody answers */
    WAIT_S = 25, /* how long a claim may wait for a job, while nothing else is to be sent */
};
/* Work that is claimed at once for a thread without any, as far as it is known. */
static const double CLAIM_SECONDS = 2;

/* --- away --- */

/* With jobs in hand the source is asked more often, so that leases do not run out meanwhile. */
static int64_t away_most_ms(const struct dispatcher *dispatcher) {
    int64_t most = AWAY_MOST_MS;
    for (const struct lease *lease = dispatcher->leases; lease != NULL; lease = lease->next)
        if (lease->job.lease_ms / 4 < most)
            most = lease->job.lease_ms / 4;
    return most > 1 ? most : 1;
}

void dispatcher_note_away(struct dispatcher *dispatcher, const char *what,
                          const struct error *err) {
    struct log_about about = {.worker = dispatcher->options.source->worker};
    if (dispatcher->away.ms == 0)
        log_line(LEVEL_WARNING, &about, "%s: %s", what, err->text);
    dispatcher->away_ms = clock_ms() + backoff_next(&dispatcher->away, away_most_ms(dispatcher));
}

void dispatcher_note_answer(struct dispatcher *dispatcher) {
    struct log_about about = {.worker = dispatcher->options.source->worker};
    if (dispatcher->away.ms != 0)
        log_line(LEVEL_INFO, &about, "answered again");
    dispatcher->away.ms = 0;
    dispatcher->away_ms = 0;
}

/* --- claims --- */

static int claim_is_over(void *context) {
    const struct dispatcher *dispatcher = context;
    return atomic_load(&dispatcher->ending);
}

/* Takes the jobs; those for which there is no memory are lost, and their leases run out. */
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
        atomic_init(&lease->done, 0);
        *last = lease;
        last = &lease->next;
        dispatcher->stock++;
    }
}

/* After a claim that found nothing: asks whether anything may still come, or waits. waited: the
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
    /* what cannot be published now, as on a full disk, waits for whoever opens the store next */
    dispatcher->drained = left == 0 && (!due || dispatcher->postponed) && !dispatcher->publishing &&
                          dispatcher->leases == NULL;
    dispatcher->due |= due && !dispatcher->drained;
    dispatcher->idle = true;
    dispatcher->vain++;
    if (!waited)
        dispatcher->claim_ms = clock_ms() + backoff_next(&dispatcher->pause, IDLE_MOST_MS);
}

/* A claim may wait at the server while it is all that the process has to say. */
static unsigned wait_wanted(const struct dispatcher *dispatcher) {
    bool nothing_else = dispatcher->idle && !dispatcher->options.drain &&
                        dispatcher->leases == NULL && !dispatcher->due &&
                        dispatcher->waiting == dispatcher->options.threads;
    return nothing_else ? WAIT_S : 0;
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
    if (status == ERROR_SYSTEM || status == ERROR_MEMORY) {
        dispatcher_note_away(dispatcher, "waiting for jobs", &err);
        return;
    }
    if (status != 0) {
        dispatcher->status = status;
        dispatcher->err = err;
        pthread_cond_broadcast(&dispatcher->offers);
        return;
    }
    dispatcher_note_answer(dispatcher);
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
    if (atomic_load(&dispatcher->ending) || dispatcher->drained || dispatcher->status != 0 ||
        dispatcher->waiting <= dispatcher->stock)
        return NEVER;
    return dispatcher->claim_ms > dispatcher->away_ms ? dispatcher->claim_ms : dispatcher->away_ms;
}

/* --- the stock --- */

/* How many jobs may be kept that nobody has begun: those of a few seconds, as measured. */
static size_t stock_most(const struct dispatcher *dispatcher) {
    if (atomic_load(&dispatcher->ending))
        return 0;
    if (!(dispatcher->job_seconds > 0))
        return SIZE_MAX;
    double jobs = ceil(CLAIM_SECONDS / dispatcher->job_seconds) * dispatcher->options.threads;
    return jobs < CLAIM_MOST ? (size_t)jobs : CLAIM_MOST;
}

/* Gives back what is more than that, of the end of the stock, and frees what is gone. */
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

void *dispatcher_thread_main(void *context) {
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
