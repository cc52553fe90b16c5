/* The queue: changes of a job under its lease, and the end of attempts without a result.
 * schema/README.md draws the states. */
#include "schema/store/store_internal.h"
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

void claimed_job_clear(struct claimed_job *job) {
    free(job->kind);
    cJSON_Delete(job->parameters);
    *job = (struct claimed_job){0};
}

int job_read(struct store *store, int64_t id, const char *token, struct job_row *job,
             struct error *err) {
    unsigned char digest[DIGEST_SIZE] = {0};
    sqlite3_stmt *row = NULL;
    if (token != NULL)
        digest_text(token, digest);
    int status =
        store_query(store, &row, err,
                    "SELECT study_id, case_number, first, count, attempts, state = 'running', "
                    "state = 'done', state = 'cancelled', token IS ?, losses FROM job WHERE id = ?",
                    "bi", (const void *)digest, token != NULL ? sizeof digest : 0, id);
    if (status == 0)
        status = store_step(store, row, err);
    if (status == 0)
        return error_set(err, ERROR_ABSENT, "there is no job %lld", (long long)id);
    if (status < 0)
        return status;
    *job = (struct job_row){.id = id,
                            .study = sqlite3_column_int64(row, 0),
                            .case_number = sqlite3_column_int64(row, 1),
                            .first = sqlite3_column_int64(row, 2),
                            .count = sqlite3_column_int64(row, 3),
                            .attempts = sqlite3_column_int64(row, 4),
                            .running = sqlite3_column_int(row, 5),
                            .done = sqlite3_column_int(row, 6),
                            .cancelled = sqlite3_column_int(row, 7),
                            .owned = sqlite3_column_int(row, 8),
                            .losses = sqlite3_column_int64(row, 9)};
    sqlite3_reset(row);
    return 0;
}

int job_check_lease(const struct job_row *job, struct error *err) {
    if (job->owned && job->cancelled)
        return error_set(err, ERROR_STATE, "the study of job %lld was cancelled",
                         (long long)job->id);
    if (!job->running || !job->owned)
        return error_set(err, ERROR_STATE, "the lease of job %lld is lost", (long long)job->id);
    return 0;
}

/* Reads a job, if the token is that of its live lease. */
static int read_leased(struct store *store, int64_t id, const char *token, struct job_row *job,
                       struct error *err) {
    int status = job_read(store, id, token, job, err);
    return status != 0 ? status : job_check_lease(job, err);
}

/* --- attempts without a result --- */

/* Requeues the job. Only a failed run counts as an attempt. pause_ms: until it may be claimed
 * again. */
static int job_requeue(struct store *store, const struct job_row *job, const char *reason,
                       bool failed, int64_t pause_ms, struct error *err) {
    int status =
        store_run(store, err,
                  "UPDATE job SET state = 'waiting', token = NULL, reported = 0, attempts = "
                  "attempts - ?, losses = ?, not_before = ?, error = coalesce(?, error) WHERE id = "
                  "?",
                  "iiiti", (int64_t)!failed, job->losses,
                  pause_ms > 0 ? store_now(store) + pause_ms : 0, reason, job->id);
    if (status == 0)
        status = store_run(store, err,
                           "UPDATE study SET jobs_running = jobs_running - 1, jobs_waiting = "
                           "jobs_waiting + 1, realisations_waiting = realisations_waiting + ?, "
                           "revision = revision + 1 WHERE id = ?",
                           "ii", job->count, job->study);
    return status;
}

int job_fail(struct store *store, const struct job_row *job, const char *reason,
             struct error *err) {
    int status =
        store_run(store, err,
                  "UPDATE job SET state = 'failed', reported = 0, attempts = ?, losses = ?, error "
                  "= ?, ended = ? WHERE id = ?",
                  "iitti", job->attempts, job->losses, reason, store_time(store), job->id);
    if (status == 0)
        status =
            store_run(store, err,
                      "UPDATE study SET jobs_running = jobs_running - 1, jobs_failed = "
                      "jobs_failed + 1, realisations_failed = realisations_failed + ? WHERE id = ?",
                      "ii", job->count, job->study);
    if (status == 0)
        status = store_run(store, err,
                           "UPDATE study_case SET jobs_left = jobs_left - 1 WHERE study_id = ?1 "
                           "AND number IN (?2, " CASE_PARENT ")",
                           "ii", job->study, job->case_number);
    return status != 0 ? status : study_settle(store, job->study, err);
}

static int job_give_up(struct store *store, const struct job_row *job, const char *reason,
                       bool permanent, struct error *err) {
    if (permanent || job->attempts >= ATTEMPTS_MOST)
        return job_fail(store, job, reason, err);
    return job_requeue(store, job, reason, true, 0, err);
}

/* Returns a second after the first loss, twice as long after each further one, up to about a
 * minute. */
static int64_t pause_after(int64_t losses) {
    enum { PAUSE_MS = 1000, DOUBLINGS = 6 };
    return PAUSE_MS << (losses <= DOUBLINGS ? losses - 1 : DOUBLINGS);
}

int job_lose(struct store *store, const struct job_row *job, const char *worker, bool *failed,
             struct error *err) {
    struct job_row lost = *job;
    char reason[256];
    lost.losses++;
    *failed = lost.losses >= LOSSES_MOST;
    if (!*failed) {
        snprintf(reason, sizeof reason, "lease ran out on worker %.100s", worker);
        return job_requeue(store, &lost, reason, false, pause_after(lost.losses), err);
    }
    lost.attempts--;
    snprintf(reason, sizeof reason,
             "lost with its worker %d times: killed, cut off or out of memory; the last lease ran "
             "out on worker %.100s",
             LOSSES_MOST, worker);
    return job_fail(store, &lost, reason, err);
}

/* --- under a lease --- */

int store_heartbeat(struct store *store, int64_t job, const char *token, double done,
                    struct error *err) {
    struct job_row row;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = read_leased(store, job, token, &row, err);
    if (status == 0) {
        double reported = done < (double)row.count ? done : (double)row.count;
        status = store_run(store, err,
                           "UPDATE job SET lease_until = ?1 + ?2, reported_ms = CASE WHEN reported "
                           "< ?3 THEN ?1 - coalesce(claimed_ms, ?1) ELSE reported_ms END, reported "
                           "= ?3 WHERE id = ?4",
                           "iidi", store_now(store), store->options.lease_ms, reported, job);
    }
    return change_end(store, status, err);
}

int store_fail(struct store *store, int64_t job, const char *token, const char *reason,
               bool permanent, struct error *err) {
    struct job_row row;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = read_leased(store, job, token, &row, err);
    if (status == 0)
        status = job_give_up(store, &row, reason, permanent, err);
    return change_end(store, status, err);
}

int store_release(struct store *store, int64_t job, const char *token, struct error *err) {
    struct job_row row;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = read_leased(store, job, token, &row, err);
    if (status == 0)
        status = job_requeue(store, &row, NULL, false, 0, err);
    return change_end(store, status, err);
}

static int copy_study(struct store *store, int64_t study, struct claimed_job *job,
                      struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(
        store, &row, err,
        "SELECT s.public, s.kind, s.seed, c.parameters, s.random, c.sequence FROM study s JOIN "
        "study_case c ON c.study_id = s.id WHERE s.id = ? AND c.number = ?",
        "ii", study, (int64_t)job->case_number);
    if (status == 0)
        status = store_step(store, row, err);
    if (status <= 0)
        return status != 0
                   ? status
                   : error_set(err, ERROR_SYSTEM, "job %lld has no case", (long long)job->id);
    snprintf(job->study, sizeof job->study, "%s", (const char *)sqlite3_column_text(row, 0));
    job->kind = column_copy(row, 1);
    job->seed = strtoull((const char *)sqlite3_column_text(row, 2), NULL, 10);
    job->sequence = study_sequence(column_random(row, 4), job->case_number);
    if (sqlite3_column_type(row, 5) != SQLITE_NULL)
        job->sequence = (uint64_t)sqlite3_column_int64(row, 5);
    status = column_json(row, 3, &job->parameters, err);
    sqlite3_reset(row);
    return job->kind != NULL || status != 0 ? status : error_memory(err, 0, "a job's kind");
}

int store_job(struct store *store, int64_t job, const char *token, struct claimed_job *out,
              struct error *err) {
    struct job_row row;
    int status = job_read(store, job, token, &row, err);
    if (status == 0 && !(row.owned && (row.running || row.done)))
        status = error_set(err, ERROR_STATE, "the lease of job %lld is lost", (long long)job);
    if (status != 0)
        return status;
    *out = (struct claimed_job){.id = job,
                                .case_number = (uint64_t)row.case_number,
                                .first = (uint64_t)row.first,
                                .count = (uint64_t)row.count,
                                .attempt = (uint64_t)row.attempts,
                                .lease_ms = store->options.lease_ms};
    snprintf(out->token, sizeof out->token, "%s", token);
    status = copy_study(store, row.study, out, err);
    if (status != 0)
        claimed_job_clear(out);
    return status;
}

/* Whether a claim would find a job, without claiming. */

int store_jobs_wait(struct store *store, bool *wait, struct error *err) {
    int64_t found = 0;
    int status = store_integer(
        store, &found, err,
        "SELECT EXISTS (SELECT 1 FROM study WHERE state IN ('queued', 'running') AND jobs_waiting "
        "> 0 AND EXISTS (SELECT 1 FROM job INDEXED BY job_waiting WHERE study_id = study.id AND "
        "job.state = 'waiting' AND not_before <= ?1)) OR EXISTS (SELECT 1 FROM job WHERE state = "
        "'running' AND lease_until <= ?1)",
        "i", store_now(store));
    if (status == 0)
        *wait = found != 0;
    return status;
}

int64_t store_changes(const struct store *store) {
    return sqlite3_total_changes64(store->db);
}

/* Figures about the store itself. */

static uint64_t file_bytes(const char *path, const char *suffix) {
    char name[4096];
    struct stat info;
    snprintf(name, sizeof name, "%s%s", path, suffix);
    return stat(name, &info) != 0 ? 0 : (uint64_t)info.st_size;
}

int store_metrics(struct store *store, struct store_metrics *out, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status =
        store_query(store, &row, err,
                    "SELECT count(*), total(jobs_waiting), total(jobs_running), "
                    "total(jobs_done), total(jobs_failed), total(jobs_cancelled) FROM study "
                    "WHERE id NOT IN " DELETED_STUDIES,
                    "");
    if (status == 0)
        status = store_step(store, row, err);
    if (status < 0)
        return status;
    uint64_t *const counts[] = {&out->studies,   &out->jobs_waiting, &out->jobs_running,
                                &out->jobs_done, &out->jobs_failed,  &out->jobs_cancelled};
    for (int c = 0; c < 6; c++)
        *counts[c] = (uint64_t)sqlite3_column_int64(row, c);
    sqlite3_reset(row);
    out->wal_bytes = file_bytes(store->path, "-wal");
    out->database_bytes = file_bytes(store->path, "");
    return 0;
}
