/* What the dispatcher tells its source: heartbeats first, which are small and must not be late, and
 * then what became of jobs. */
#include "worker/dispatcher_internal.h"
#include "worker/log.h"

#include <stdlib.h>

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

/* --- when --- */

/* A result that nobody takes for a while keeps its lease, too. */
static bool beats(const struct lease *lease) {
    return lease->state == LEASE_STOCK || lease->state == LEASE_RUNNING ||
           (lease->state == LEASE_ENDED && lease->end.verb == REPORT_COMPLETE);
}

/* Results go at once where a thread has nothing to do or many have come, and soon otherwise. */
static int64_t ended_due_ms(const struct dispatcher *dispatcher, int64_t first_ms) {
    if (atomic_load(&dispatcher->ending))
        return 0;
    bool now = (dispatcher->waiting > 0 && dispatcher->stock == 0) ||
               dispatcher->ended >= BATCH_MOST || dispatcher->ended_bytes >= BATCH_BYTES;
    int64_t due_ms = now ? 0 : first_ms + LINGER_MS;
    return due_ms > dispatcher->away_ms ? due_ms : dispatcher->away_ms;
}

int64_t dispatcher_report_ms(const struct dispatcher *dispatcher, int64_t now_ms) {
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

/* --- what --- */

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

/* With a heartbeat that is due go those that soon would be. */
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

/* --- what became of it --- */

static void lose(struct dispatcher *dispatcher, struct lease *lease) {
    atomic_store(&lease->lost, true);
    lease->due_ms = NEVER;
    if (lease->state == LEASE_STOCK) {
        dispatcher->stock--;
        lease->state = LEASE_GONE;
    }
}

/* The job may have ended meanwhile: then its own report tells. */
static void settle_beat(struct dispatcher *dispatcher, struct lease *lease,
                        const struct report *report) {
    bool released = report->verb == REPORT_RELEASE;
    if (!beats(lease))
        return;
    int64_t interval = lease_interval_ms(dispatcher, lease);
    if (report->status == ERROR_STATE || (released && report->status == 0))
        lose(dispatcher, lease);
    else
        lease->due_ms = clock_ms() + (report->status != 0 ? interval / RETRY_PART + 1 : interval);
}

static void settled(struct dispatcher *dispatcher, struct lease *lease) {
    dispatcher->ended--;
    dispatcher->ended_bytes -= lease->bytes;
    lease->state = LEASE_GONE;
}

/* A result that is refused fails its job, with the reason; a part of one, which an older server
 * does not take, is given up and the job released. */
static void refuse_result(struct dispatcher *dispatcher, struct lease *lease,
                          const struct error *why) {
    bool part = lease->end.result.count < lease->job.count;
    dispatcher->ended--;
    dispatcher->ended_bytes -= lease->bytes;
    block_result_clear(&lease->end.result);
    error_set(&lease->end.reason, ERROR_SYSTEM, "the result was refused: %.400s", why->text);
    lease_end(dispatcher, lease, part ? REPORT_RELEASE : REPORT_FAIL);
    lease_log(dispatcher, LEVEL_WARNING, lease, part ? "given back" : "failed",
              lease->end.reason.text);
}

static void settle_ended(struct dispatcher *dispatcher, struct lease *lease,
                         const struct report *report) {
    bool later = report->status == ERROR_SYSTEM || report->status == ERROR_MEMORY;
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

/* Sends a batch; the reports have their answers then. */
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

static bool any_later(const struct batch *batch, const struct error **err) {
    for (size_t n = 0; n < batch->count; n++) {
        *err = &batch->reports[n].err;
        if (batch->reports[n].status == ERROR_SYSTEM || batch->reports[n].status == ERROR_MEMORY)
            return true;
    }
    return false;
}

void dispatcher_report(struct dispatcher *dispatcher) {
    struct batch *batch = calloc(1, sizeof *batch);
    const struct error *why = NULL;
    struct error err = {0};
    bool due = false;
    if (batch == NULL) {
        error_memory(&err, sizeof *batch, "reports");
        dispatcher_note_away(dispatcher, "reports wait", &err);
        return;
    }
    batch_beats(dispatcher, clock_ms(), batch);
    bool beating = batch->count > 0;
    if (!beating)
        batch_ended(dispatcher, batch);
    if (batch->count > 0)
        send_batch(dispatcher, batch, &due, &err);
    if (any_later(batch, &why))
        dispatcher_note_away(dispatcher, "not taken, to be sent again", why);
    else
        dispatcher_note_answer(dispatcher);
    for (size_t n = 0; n < batch->count; n++) {
        if (beating)
            settle_beat(dispatcher, batch->leases[n], &batch->reports[n]);
        else
            settle_ended(dispatcher, batch->leases[n], &batch->reports[n]);
    }
    dispatcher->due |= due;
    pthread_cond_broadcast(&dispatcher->offers);
    free(batch);
}
