#include "worker/dispatcher.h"
#include "worker/dispatcher_internal.h"

#include <stdlib.h>
#include <string.h>

enum {
    REPORT_MS = 5000,
    /* Of results that wait to be sent: who hands in more waits. */
    ENDED_BYTES_MOST = 64 << 20,
};

/* --- leases --- */

const struct claimed_job *lease_job(const struct lease *lease) {
    return &lease->job;
}

void lease_progress(struct lease *lease, uint64_t done) {
    atomic_store(&lease->done, done);
}

bool lease_is_lost(const struct lease *lease) {
    return atomic_load(&lease->lost);
}

int64_t lease_interval_ms(const struct dispatcher *dispatcher, const struct lease *lease) {
    int64_t third = lease->job.lease_ms / 3;
    if (third < 1)
        return 1;
    return lease->state == LEASE_RUNNING && third > dispatcher->report_ms ? dispatcher->report_ms
                                                                          : third;
}

/* As base64, and numbers in digits. */
static size_t bytes_of(const struct block_result *result) {
    return result->size / 3 * 4 + (size_t)result->count * result->scalar_count * 24;
}

void lease_end(struct dispatcher *dispatcher, struct lease *lease, enum report_verb verb) {
    dispatcher->stock -= lease->state == LEASE_STOCK;
    lease->state = LEASE_ENDED;
    lease->end.verb = verb;
    lease->ended_ms = clock_ms();
    lease->bytes = verb == REPORT_COMPLETE ? bytes_of(&lease->end.result) : 0;
    dispatcher->ended++;
    dispatcher->ended_bytes += lease->bytes;
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

/* OFFER_NOTHING: there is none yet. */
static enum offer offer_now(struct dispatcher *dispatcher, struct lease **out) {
    if (atomic_load(&dispatcher->ending) || dispatcher->status != 0)
        return OFFER_END;
    if (dispatcher->due && !dispatcher->publishing) {
        dispatcher->publishing = true;
        dispatcher->due = false;
        return OFFER_PUBLISH;
    }
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

void dispatcher_published(struct dispatcher *dispatcher, bool postponed) {
    pthread_mutex_lock(&dispatcher->lock);
    dispatcher->publishing = false;
    dispatcher->postponed = postponed;
    pthread_cond_signal(&dispatcher->news);
    pthread_cond_broadcast(&dispatcher->offers);
    pthread_mutex_unlock(&dispatcher->lock);
}

/* The newest one counts a quarter. */
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
    dispatcher->pause.ms = 0; /* what ended may have left something to claim */
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
    if (pthread_create(&dispatcher->thread, NULL, dispatcher_thread_main, dispatcher) != 0) {
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
    int status = source_create(&dispatcher->source, options->source, err);
    status = status != 0 ? status : dispatcher_start(dispatcher, err);
    if (status != 0) {
        source_destroy(&dispatcher->source);
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
    free(gone);
    *dispatcher = NULL;
}
