/* Claims: jobs handed out, and taken back from those whose lease ran out. */
#include "schema/store/store_internal.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One job whose lease ran out waits again, or has failed. 1 when there was one. */
static int expire_one(struct store *store, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(store, &row, err,
                             "SELECT id, coalesce(worker, '?') FROM job WHERE state = 'running' "
                             "AND lease_until <= ? ORDER BY lease_until LIMIT 1",
                             "i", store_now(store));
    if (status == 0)
        status = store_step(store, row, err);
    if (status <= 0)
        return status;
    int64_t id = sqlite3_column_int64(row, 0);
    char reason[160];
    snprintf(reason, sizeof reason, "lease ran out on worker %.100s",
             (const char *)sqlite3_column_text(row, 1));
    sqlite3_reset(row);
    struct job_row job;
    status = job_read(store, id, NULL, &job, err);
    if (status == 0)
        status = job_give_up(store, &job, reason, false, err);
    store->claim_failed_jobs |= status == 0 && job.attempts >= ATTEMPTS_MOST;
    return status != 0 ? status : 1;
}

static bool is_wanted(const char *const *kinds, const char *kind) {
    for (; kinds != NULL && *kinds != NULL; kinds++)
        if (strcmp(*kinds, kind) == 0)
            return true;
    return kinds == NULL;
}

struct found_study {
    int64_t id;
    bool queued;
    enum study_random random;
};

/* The oldest study with a job that waits and is wanted; only: 0, or the one that may be. Fills
 * job's study, kind and seed. 1, or 0 when there is none. */
static int find_study(struct store *store, const struct claim *claim, int64_t only,
                      struct found_study *found, struct claimed_job *job, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(
        store, &row, err,
        "SELECT id, public, kind, seed, state = 'queued', random FROM study WHERE "
        "state IN ('queued', 'running') AND jobs_waiting > 0 AND (?1 = 0 OR id = ?1) "
        "AND (NOT ?2 OR random = 'independent' OR (cases = 1 AND realisations > 0)) ORDER "
        "BY id",
        "ii", only, (int64_t)claim->independent_only);
    while (status == 0 && (status = store_step(store, row, err)) == 1) {
        const char *kind = (const char *)sqlite3_column_text(row, 2);
        status = 0;
        if (!is_wanted(claim->kinds, kind))
            continue;
        *found = (struct found_study){.id = sqlite3_column_int64(row, 0),
                                      .queued = sqlite3_column_int(row, 4),
                                      .random = column_random(row, 5)};
        snprintf(job->study, sizeof job->study, "%s", (const char *)sqlite3_column_text(row, 1));
        job->seed = strtoull((const char *)sqlite3_column_text(row, 3), NULL, 10);
        job->kind = strdup(kind);
        status = job->kind != NULL ? 1 : error_memory(err, 0, "a kind");
        sqlite3_reset(row);
        break;
    }
    return status;
}

/* Leases the study's first job that waits. */
static int lease_job(struct store *store, const struct claim *claim,
                     const struct found_study *study, struct claimed_job *job, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status =
        store_query(store, &row, err,
                    "SELECT id, case_number, first, count, attempts + 1 FROM job WHERE state = "
                    "'waiting' AND study_id = ? ORDER BY id LIMIT 1",
                    "i", study->id);
    if (status == 0)
        status = store_step(store, row, err);
    if (status == 0)
        return error_set(err, ERROR_SYSTEM, "study %s counts waiting jobs that are not there",
                         job->study);
    if (status < 0)
        return status;
    job->id = sqlite3_column_int64(row, 0);
    job->case_number = (uint64_t)sqlite3_column_int64(row, 1);
    job->sequence = study_sequence(study->random, job->case_number);
    job->first = (uint64_t)sqlite3_column_int64(row, 2);
    job->count = (uint64_t)sqlite3_column_int64(row, 3);
    job->attempt = (uint64_t)sqlite3_column_int64(row, 4);
    job->lease_ms = store->options.lease_ms;
    sqlite3_reset(row);
    status = random_text(job->token, TOKEN_SIZE - 1, err);
    if (status != 0)
        return status;
    return store_run(
        store, err,
        "UPDATE job SET state = 'running', attempts = attempts + 1, token = ?, worker = ?, "
        "host = ?, program = ?, claimed_ms = ?5, lease_until = ?5 + ?6, reported = 0, reported_ms "
        "= 0, claimed = ?7 WHERE id = ?8",
        "ttttiiti", job->token, claim->worker, claim->host, claim->program, store_now(store),
        store->options.lease_ms, store_time(store), job->id);
}

static int copy_parameters(struct store *store, int64_t study, struct claimed_job *job,
                           struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(store, &row, err,
                             "SELECT parameters, sequence FROM study_case WHERE study_id = ? AND "
                             "number = ?",
                             "ii", study, (int64_t)job->case_number);
    if (status == 0)
        status = store_step(store, row, err);
    if (status <= 0)
        return status != 0
                   ? status
                   : error_set(err, ERROR_SYSTEM, "job %lld has no case", (long long)job->id);
    if (sqlite3_column_type(row, 1) != SQLITE_NULL)
        job->sequence = (uint64_t)sqlite3_column_int64(row, 1);
    status = column_json(row, 0, &job->parameters, err);
    sqlite3_reset(row);
    return status;
}

/* The counters change with every claim; the state only with the first, as it is indexed. */
static int count_claim(struct store *store, const struct found_study *study, struct error *err) {
    int status = store_run(store, err,
                           "UPDATE study SET jobs_waiting = jobs_waiting - 1, jobs_running = "
                           "jobs_running + 1, revision = revision + 1 WHERE id = ?",
                           "i", study->id);
    if (status == 0 && study->queued)
        status = store_run(store, err, "UPDATE study SET state = 'running' WHERE id = ?", "i",
                           study->id);
    return status;
}

/* Claims one job: returns 1, or 0 when nothing waits. */
static int claim_one(struct store *store, const struct claim *claim, int64_t only,
                     struct claimed_job *job, struct error *err) {
    struct found_study study = {0};
    int status = find_study(store, claim, only, &study, job, err);
    if (status <= 0)
        return status;
    status = lease_job(store, claim, &study, job, err);
    if (status == 0)
        status = count_claim(store, &study, err);
    if (status == 0)
        status = copy_parameters(store, study.id, job, err);
    return status != 0 ? status : 1;
}

int store_claim(struct store *store, const struct claim *claim, struct claimed_job *jobs,
                size_t *count, struct error *err) {
    int64_t only = 0;
    size_t n = 0;
    *count = 0;
    store->claim_failed_jobs = false;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    if (claim->study != NULL)
        status = study_row(store, claim->study, &only, err);
    while (status == 0 && (status = expire_one(store, err)) == 1)
        status = 0;
    while (status == 0 && n < claim->count) {
        jobs[n] = (struct claimed_job){0};
        status = claim_one(store, claim, only, &jobs[n], err);
        if (status == 0)
            break;
        n++; /* also after an error: what it holds is cleared below */
        status = status == 1 ? 0 : status;
    }
    status = change_end(store, status, err);
    for (size_t i = 0; status != 0 && i < n; i++)
        claimed_job_clear(&jobs[i]);
    *count = status != 0 ? 0 : n;
    return status;
}

bool store_claim_failed_jobs(const struct store *store) {
    return store->claim_failed_jobs;
}
