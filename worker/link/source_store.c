/* Jobs of a local store, which other processes may have open as well. */
#include "worker/checker.h"
#include "worker/link/source_backend.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct local {
    struct store *store;
    struct checker *checker;   /* that of all sources, or `own` */
    struct checker *own;       /* NULL: none */
    char study[STUDY_ID_SIZE]; /* "": any */
};

static void local_destroy(void *self) {
    struct local *local = self;
    if (local != NULL) {
        store_close(&local->store);
        checker_destroy(&local->own);
        free(local);
    }
}

static int local_create(void **self, const struct source_options *options, struct error *err) {
    struct local *local = calloc(1, sizeof *local);
    if (local == NULL)
        return error_memory(err, sizeof *local, "a source of jobs");
    if (options->study != NULL)
        snprintf(local->study, sizeof local->study, "%s", options->study);
    struct store_options store_options = {.lease_ms = options->lease_ms, .existing = true};
    int status = store_open(&local->store, options->database, &store_options, err);
    local->checker = options->checker;
    if (status == 0 && local->checker == NULL) {
        status = checker_create(&local->own, err);
        local->checker = local->own;
    }
    if (status != 0) {
        local_destroy(local);
        return status;
    }
    *self = local;
    return 0;
}

static int local_claim(void *self, const struct claim *claim, const struct wish *wish,
                       struct claimed_job *jobs, size_t *count, bool *due, struct error *err) {
    struct local *local = self;
    (void)wish;
    int status = store_claim(local->store, claim, jobs, count, err);
    *due |= status == 0 && store_claim_failed_jobs(local->store);
    return status;
}

/* Performs one report, within a change of all. */
static int perform_report(struct local *local, const struct report *report, bool *due,
                          struct error *err) {
    const struct claimed_job *job = report->job;
    bool first_time = false, case_done = false;
    int status = 0;
    switch (report->verb) {
    case REPORT_HEARTBEAT:
        return store_heartbeat(local->store, job->id, job->token, report->done, err);
    case REPORT_COMPLETE:
        status = store_complete(local->store, job->id, job->token, report->result, &first_time,
                                &case_done, err);
        *due |= status == 0 && case_done;
        return status;
    case REPORT_FAIL:
        status =
            store_fail(local->store, job->id, job->token, report->reason, report->permanent, err);
        *due |= status == 0;
        return status;
    default:
        return store_release(local->store, job->id, job->token, err);
    }
}

/* A job that is absent belonged to a study that was deleted: it is lost. */
static int local_report(void *self, struct report *reports, size_t count, bool *due,
                        struct error *err) {
    struct local *local = self;
    for (size_t n = 0; n < count; n++)
        if (reports[n].verb == REPORT_COMPLETE)
            reports[n].status =
                checker_check(local->checker, reports[n].job, reports[n].result, &reports[n].err);
    int status = store_begin(local->store, err);
    if (status != 0)
        return status;
    for (size_t n = 0; n < count; n++) {
        struct report *report = &reports[n];
        if (report->status == 0)
            report->status = perform_report(local, report, due, &report->err);
        if (report->status == ERROR_ABSENT)
            report->status = report->err.code = ERROR_STATE;
    }
    return store_commit(local->store, err);
}

/* A case that is due may ask for an error: publishing it may queue another round. */
static int local_left(void *self, int *left, bool *due, struct error *err) {
    struct local *local = self;
    int found = store_is_due(local->store, due, err);
    if (found != 0)
        return found;
    if (local->study[0] != '\0') {
        struct study_status study = {0};
        int status = store_status_counted(local->store, local->study, &study, err);
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
    .report = local_report,
    .left = local_left,
};
