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

struct found_study {
    int64_t id;
    bool queued;
    enum study_random random;
    char owner[OWNER_SIZE];
};

/* The kinds of a claim as " one two ", the caller's to free; *out is NULL for any. */
static int kinds_text(const char *const *kinds, char **out, struct error *err) {
    size_t size = 2;
    *out = NULL;
    for (size_t k = 0; kinds != NULL && kinds[k] != NULL; k++)
        size += strlen(kinds[k]) + 1;
    char *text = kinds != NULL ? array_create(size, 1) : NULL;
    if (kinds != NULL && text == NULL)
        return error_memory(err, size, "the kinds of a claim");
    for (size_t k = 0, used = 0; text != NULL && (k == 0 || kinds[k - 1] != NULL); k++)
        used += (size_t)snprintf(text + used, size - used, "%s ", k > 0 ? kinds[k - 1] : "");
    *out = text;
    return 0;
}

#define FOUND_COLUMNS "id, public, kind, seed, state = 'queued', random, owner"
/* Studies that a worker may have: ?1 those of independent cases alone, ?2 of these kinds. */
#define CLAIMABLE                                                                                  \
    "state IN ('queued', 'running') AND jobs_waiting > 0 AND (NOT ?1 OR random = 'independent' "   \
    "OR (cases = 1 AND realisations > 0)) AND (?2 IS NULL OR instr(?2, ' ' || kind || ' ') > 0)"
/* A study that a worker may have: of this owner the first in line, or the one that is asked for.
 * Fills job's study, kind and seed. 1, or 0 when there is none. */
static int first_study(struct store *store, const struct claim *claim, int64_t only,
                       const char *kinds, struct found_study *found, struct claimed_job *job,
                       struct error *err) {
    sqlite3_stmt *row = NULL;
    int64_t independent = claim->independent_only;
    int status =
        only != 0
            ? store_query(store, &row, err,
                          "SELECT " FOUND_COLUMNS " FROM study WHERE " CLAIMABLE " AND id = ?3",
                          "iti", independent, kinds, only)
            : store_query(store, &row, err,
                          "SELECT " FOUND_COLUMNS " FROM study INDEXED BY study_line WHERE "
                          "owner = ?3 AND " CLAIMABLE " ORDER BY priority DESC, id LIMIT 1",
                          "itt", independent, kinds, found->owner);
    if (status == 0)
        status = store_step(store, row, err);
    if (status <= 0)
        return status;
    found->id = sqlite3_column_int64(row, 0);
    found->queued = sqlite3_column_int(row, 4);
    found->random = column_random(row, 5);
    snprintf(found->owner, sizeof found->owner, "%s", (const char *)sqlite3_column_text(row, 6));
    snprintf(job->study, sizeof job->study, "%s", (const char *)sqlite3_column_text(row, 1));
    job->seed = strtoull((const char *)sqlite3_column_text(row, 3), NULL, 10);
    job->kind = column_copy(row, 2);
    sqlite3_reset(row);
    return job->kind != NULL ? 1 : error_memory(err, 0, "a kind");
}

/* Asks owner after owner, whose clock is least first. */
static int next_study(struct store *store, const struct claim *claim, const char *kinds,
                      struct found_study *found, struct claimed_job *job, struct error *err) {
    sqlite3_stmt *turn = NULL;
    int status = store_query(store, &turn, err,
                             "SELECT owner FROM share ORDER BY max(served, (SELECT max(begun) FROM "
                             "share)), begun, owner",
                             "");
    while (status == 0 && (status = store_step(store, turn, err)) == 1) {
        snprintf(found->owner, sizeof found->owner, "%s",
                 (const char *)sqlite3_column_text(turn, 0));
        status = first_study(store, claim, 0, kinds, found, job, err);
        if (status != 0)
            sqlite3_reset(turn);
    }
    return status;
}

static int find_study(struct store *store, const struct claim *claim, int64_t only,
                      struct found_study *found, struct claimed_job *job, struct error *err) {
    char *kinds = NULL;
    int status = kinds_text(claim->kinds, &kinds, err);
    if (status == 0)
        status = only != 0 ? first_study(store, claim, only, kinds, found, job, err)
                           : next_study(store, claim, kinds, found, job, err);
    free(kinds);
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

/* *seconds: that the job takes, as measured of its case or, before, as estimated. */
static int copy_case(struct store *store, int64_t study, struct claimed_job *job, double *seconds,
                     struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(store, &row, err,
                             "SELECT parameters, sequence, CASE WHEN seconds > 0 AND "
                             "realisations_done > 0 THEN seconds / realisations_done ELSE estimate "
                             "END FROM study_case WHERE study_id = ? AND number = ?",
                             "ii", study, (int64_t)job->case_number);
    if (status == 0)
        status = store_step(store, row, err);
    if (status <= 0)
        return status != 0
                   ? status
                   : error_set(err, ERROR_SYSTEM, "job %lld has no case", (long long)job->id);
    if (sqlite3_column_type(row, 1) != SQLITE_NULL)
        job->sequence = (uint64_t)sqlite3_column_int64(row, 1);
    *seconds = sqlite3_column_double(row, 2) * (double)job->count;
    status = column_json(row, 0, &job->parameters, err);
    sqlite3_reset(row);
    return status;
}

/* Moves the clock of the study's owner on. Jobs that take no time count a little, so that owners of
 * such take turns, too. */
static int count_share(struct store *store, const struct found_study *study, double seconds,
                       struct error *err) {
    static const double LEAST = 1e-3;
    return store_run(store, err,
                     "UPDATE share SET begun = start, served = start + ?1 / weight FROM (SELECT "
                     "max(served, (SELECT max(begun) FROM share)) AS start FROM share WHERE owner "
                     "= ?2) WHERE owner = ?2",
                     "dt", seconds > LEAST ? seconds : LEAST, study->owner);
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
    double seconds = 0;
    int status = find_study(store, claim, only, &study, job, err);
    if (status <= 0)
        return status;
    status = lease_job(store, claim, &study, job, err);
    if (status == 0)
        status = count_claim(store, &study, err);
    if (status == 0)
        status = copy_case(store, study.id, job, &seconds, err);
    if (status == 0)
        status = count_share(store, &study, seconds, err);
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
