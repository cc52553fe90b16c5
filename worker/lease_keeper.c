#include "worker/lease_keeper.h"
#include "worker/clock.h"
#include "worker/log.h"

#include <stdatomic.h>
#include <stdlib.h>

enum { REPORT_MS = 5000, RETRY_PART = 4 };
static const int64_t NEVER = INT64_MAX;

/* The keeper's lock protects all fields but the atomic ones. */
struct slot {
    struct claimed_job job; /* has id, study, token and lease_ms; its owned strings are NULL */
    uint64_t hold;          /* counts jobs: an answer to an earlier job's heartbeat is recognised */
    int64_t due_ms;         /* time of the next heartbeat; NEVER while the slot holds no job */
    bool give_back;         /* the next request releases the job */
    atomic_bool lost;
    atomic_uint_fast64_t done;
};

struct lease_keeper {
    struct source *source; /* used by the keeper's thread alone */
    pthread_mutex_t lock;
    pthread_cond_t changed; /* signalled when a slot or `closing` changes */
    bool closing;
    bool away; /* the last heartbeat had no answer; used by the keeper's thread alone */
    const char *worker;
    int64_t report_ms; /* most time between two heartbeats of a job */
    pthread_t handle;
    unsigned slot_count;
    struct slot slots[];
};

static struct slot *slot_due_first(struct lease_keeper *keeper) {
    struct slot *first = &keeper->slots[0];
    for (unsigned n = 1; n < keeper->slot_count; n++)
        if (keeper->slots[n].due_ms < first->due_ms)
            first = &keeper->slots[n];
    return first;
}

static int64_t interval_ms(const struct lease_keeper *keeper, const struct claimed_job *job) {
    int64_t third = job->lease_ms / 3;
    return third < 1 ? 1 : third > keeper->report_ms ? keeper->report_ms : third;
}

/* Logs the first of several heartbeats without an answer. */
static void note_answer(struct lease_keeper *keeper, const struct claimed_job *job, bool answered,
                        const struct error *err) {
    if (!answered && !keeper->away) {
        struct log_about about = {.worker = keeper->worker, .study = job->study, .job = job->id};
        log_line(LEVEL_WARNING, &about, "no answer to a heartbeat: %s", err->text);
    }
    keeper->away = !answered;
}

/* Sends one heartbeat, or gives the job back. The caller holds the lock, which is released while
 * the request is under way. */
static void beat(struct lease_keeper *keeper, struct slot *slot) {
    struct claimed_job job = slot->job;
    uint64_t hold = slot->hold, done = atomic_load(&slot->done);
    bool give_back = slot->give_back;
    pthread_mutex_unlock(&keeper->lock);
    struct error err = {0};
    int status = give_back ? source_release(keeper->source, &job, &err)
                           : source_heartbeat(keeper->source, &job, done, &err);
    note_answer(keeper, &job, status == 0 || status == ERROR_STATE, &err);
    pthread_mutex_lock(&keeper->lock);
    if (slot->hold != hold || slot->due_ms == NEVER)
        return; /* the job has ended meanwhile, and the answer is about it */
    if (status == ERROR_STATE || (status == 0 && give_back)) {
        atomic_store(&slot->lost, true);
        slot->due_ms = NEVER;
    } else {
        slot->due_ms = clock_ms() + (status != 0 ? interval_ms(keeper, &job) / RETRY_PART + 1
                                                 : interval_ms(keeper, &job));
    }
}

static void *lease_keeper_main(void *context) {
    struct lease_keeper *keeper = context;
    pthread_mutex_lock(&keeper->lock);
    while (!keeper->closing) {
        struct slot *slot = slot_due_first(keeper);
        if (slot->due_ms == NEVER)
            pthread_cond_wait(&keeper->changed, &keeper->lock);
        else if (slot->due_ms > clock_ms())
            clock_cond_wait(&keeper->changed, &keeper->lock, slot->due_ms);
        else
            beat(keeper, slot);
    }
    pthread_mutex_unlock(&keeper->lock);
    return NULL;
}

/* Makes lock, condition and thread; after a failure none of them is left. */
static int lease_keeper_start(struct lease_keeper *keeper, struct error *err) {
    if (pthread_mutex_init(&keeper->lock, NULL) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot make a lock");
    if (clock_cond_init(&keeper->changed) != 0) {
        pthread_mutex_destroy(&keeper->lock);
        return error_set(err, ERROR_SYSTEM, "cannot make a condition");
    }
    if (pthread_create(&keeper->handle, NULL, lease_keeper_main, keeper) != 0) {
        pthread_cond_destroy(&keeper->changed);
        pthread_mutex_destroy(&keeper->lock);
        return error_set(err, ERROR_SYSTEM, "cannot start the heartbeat thread");
    }
    return 0;
}

int lease_keeper_create(struct lease_keeper **out, const struct source_options *options,
                        unsigned slots, struct error *err) {
    size_t size = sizeof(struct lease_keeper) + slots * sizeof(struct slot);
    struct lease_keeper *keeper = slots != 0 ? calloc(1, size) : NULL;
    if (keeper == NULL)
        return error_memory(err, size, "leases");
    keeper->slot_count = slots;
    keeper->worker = options->worker;
    keeper->report_ms = options->report_ms > 0 ? options->report_ms : REPORT_MS;
    for (unsigned n = 0; n < slots; n++) {
        keeper->slots[n].due_ms = NEVER;
        atomic_init(&keeper->slots[n].lost, false);
        atomic_init(&keeper->slots[n].done, 0);
    }
    int status = source_create(&keeper->source, options, err);
    status = status != 0 ? status : lease_keeper_start(keeper, err);
    if (status != 0) {
        source_destroy(&keeper->source);
        free(keeper);
        return status;
    }
    *out = keeper;
    return 0;
}

void lease_keeper_destroy(struct lease_keeper **keeper) {
    struct lease_keeper *gone = *keeper;
    if (gone == NULL)
        return;
    pthread_mutex_lock(&gone->lock);
    gone->closing = true;
    pthread_cond_signal(&gone->changed);
    pthread_mutex_unlock(&gone->lock);
    pthread_join(gone->handle, NULL);
    pthread_cond_destroy(&gone->changed);
    pthread_mutex_destroy(&gone->lock);
    source_destroy(&gone->source);
    free(gone);
    *keeper = NULL;
}

void lease_keeper_hold(struct lease_keeper *keeper, unsigned slot, const struct claimed_job *job) {
    struct slot *held = &keeper->slots[slot];
    pthread_mutex_lock(&keeper->lock);
    held->job = *job;
    held->job.kind = NULL;
    held->job.parameters = NULL;
    held->hold++;
    held->due_ms = clock_ms() + interval_ms(keeper, job);
    held->give_back = false;
    atomic_store(&held->lost, false);
    atomic_store(&held->done, 0);
    pthread_cond_signal(&keeper->changed);
    pthread_mutex_unlock(&keeper->lock);
}

void lease_keeper_let_go(struct lease_keeper *keeper, unsigned slot) {
    pthread_mutex_lock(&keeper->lock);
    keeper->slots[slot].due_ms = NEVER;
    pthread_mutex_unlock(&keeper->lock);
}

void lease_keeper_progress(struct lease_keeper *keeper, unsigned slot, uint64_t done) {
    atomic_store(&keeper->slots[slot].done, done);
}

bool lease_keeper_is_lost(struct lease_keeper *keeper, unsigned slot) {
    return atomic_load(&keeper->slots[slot].lost);
}

void lease_keeper_give_back(struct lease_keeper *keeper) {
    pthread_mutex_lock(&keeper->lock);
    for (unsigned n = 0; n < keeper->slot_count; n++) {
        if (keeper->slots[n].due_ms != NEVER) {
            keeper->slots[n].give_back = true;
            keeper->slots[n].due_ms = 0;
        }
    }
    pthread_cond_signal(&keeper->changed);
    pthread_mutex_unlock(&keeper->lock);
}
