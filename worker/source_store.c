/* Jobs out of a local store, which other processes may have open as well. */
#include "worker/log.h"
#include "worker/publish.h"
#include "worker/source_backend.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct local {
    struct store *store;
    char study[STUDY_ID_SIZE]; /* "": any */
};

static void local_destroy(void *self) {
    struct local *local = self;
    if (local != NULL) {
        store_close(&local->store);
        free(local);
    }
}

static int local_create(void **self, const struct source_options *options, struct error *err) {
    struct local *local = calloc(1, sizeof *local);
    if (local == NULL)
        return error_memory(err, sizeof *local, "a source of jobs");
    if (options->study != NULL)
        snprintf(local->study, sizeof local->study, "%s", options->study);
    struct store_options store_options = {.lease_ms = options->lease_ms};
    int status = store_open(&local->store, options->database, &store_options, err);
    if (status != 0) {
        local_destroy(local);
        return status;
    }
    *self = local;
    return 0;
}

static int local_claim(void *self, const struct claim *claim, struct claimed_job *job, int *found,
                       struct error *err) {
    struct local *local = self;
    size_t count = 0;
    int status = store_claim(local->store, claim, job, &count, err);
    if (status == 0)
        *found = count > 0;
    if (status == 0 && store_claim_failed_jobs(local->store)) {
        struct error unpublished = {0}; /* which leaves the cases due */
        (void)publish_due(local->store, NULL, NULL, NULL, &unpublished);
    }
    return status;
}

/* A job that is not there was of a study that is deleted: it is lost. */
static int lost(int status, struct error *err) {
    return status == ERROR_ABSENT ? (err->code = ERROR_STATE) : status;
}

static int local_heartbeat(void *self, const struct claimed_job *job, uint64_t done,
                           struct error *err) {
    struct local *local = self;
    return lost(store_heartbeat(local->store, job->id, job->token, done, err), err);
}

/* What the worker did is safe by now: a case that is not published stays due. */
static void local_publish(struct local *local, const struct claimed_job *job) {
    struct error err = {0};
    if (publish_case(local->store, job->study, job->case_number, &err) != 0) {
        struct log_about about = {.study = job->study};
        log_line(LEVEL_WARNING, &about, "case %llu is not published: %s",
                 (unsigned long long)job->case_number, err.text);
    }
}

static int local_complete(void *self, const struct claimed_job *job,
                          const struct block_result *result, struct error *err) {
    struct local *local = self;
    bool first_time = false, case_done = false;
    int status =
        store_complete(local->store, job->id, job->token, result, &first_time, &case_done, err);
    if (status == 0 && case_done)
        local_publish(local, job);
    return lost(status, err);
}

static int local_fail(void *self, const struct claimed_job *job, const char *reason, int permanent,
                      struct error *err) {
    struct local *local = self;
    int status = store_fail(local->store, job->id, job->token, reason, permanent != 0, err);
    if (status == 0)
        local_publish(local, job);
    return lost(status, err);
}

static int local_release(void *self, const struct claimed_job *job, struct error *err) {
    struct local *local = self;
    return lost(store_release(local->store, job->id, job->token, err), err);
}

/* What is due may be a round of a case that asks for an error, which queues jobs. */
static int local_left(void *self, int *left, struct error *err) {
    struct local *local = self;
    bool due = false;
    int found = store_is_due(local->store, &due, err);
    if (found == 0 && due)
        found = publish_due(local->store, NULL, NULL, NULL, err);
    if (found != 0)
        return found;
    if (local->study[0] != '\0') {
        struct study_status study = {0};
        int status = store_status(local->store, local->study, &study, err);
        if (status == 0) {
            *left = study.jobs_waiting + study.jobs_running > 0;
            study_status_clear(&study);
        }
        return status;
    }
    struct store_metrics metrics = {0};
    int status = store_metrics(local->store, &metrics, err);
    if (status == 0)
        *left = metrics.jobs_waiting + metrics.jobs_running > 0;
    return status;
}

const struct source_backend SOURCE_STORE = {
    .create = local_create,
    .destroy = local_destroy,
    .claim = local_claim,
    .heartbeat = local_heartbeat,
    .complete = local_complete,
    .fail = local_fail,
    .release = local_release,
    .left = local_left,
};
