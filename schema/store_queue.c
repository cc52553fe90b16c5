/* The queue: claims, heartbeats and the ends of attempts. schema/README.md draws the states. */
#include "schema/store_internal.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void claimed_job_clear(struct claimed_job *job) {
    free(job->kind);
    free(job->parameters);
    *job = (struct claimed_job){0};
}

/* What a change of a job needs to know of it. */
struct job_row {
    int64_t id, study, case_number, first, count, attempts;
    bool running, done, cancelled;
    bool owned; /* the token given is that of its last lease */
};

static int read_job(struct store *store, int64_t id, const char *token, struct job_row *job,
                    struct error *err) {
    sqlite3_stmt *row = NULL;
    int status =
        store_query(store, &row, err,
                    "SELECT study_id, case_number, first, count, attempts, state = 'running', "
                    "state = 'done', state = 'cancelled', token IS ? FROM job WHERE id = ?",
                    "ti", token, id);
    if (!status)
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
                            .owned = sqlite3_column_int(row, 8)};
    sqlite3_reset(row);
    return 0;
}

/* The job, if the token is that of its live lease. */
static int read_leased(struct store *store, int64_t id, const char *token, struct job_row *job,
                       struct error *err) {
    int status = read_job(store, id, token, job, err);
    if (status)
        return status;
    if (job->owned && job->cancelled)
        return error_set(err, ERROR_STATE, "the study of job %lld was cancelled", (long long)id);
    if (!job->running || !job->owned)
        return error_set(err, ERROR_STATE, "the lease of job %lld is lost", (long long)id);
    return 0;
}

/* --- the end of an attempt that gave no result --- */

static int job_requeue(struct store *store, const struct job_row *job, const char *reason,
                       bool counts, struct error *err) {
    int status =
        store_run(store, err,
                  "UPDATE job SET state = 'waiting', token = NULL, reported = 0, attempts = "
                  "attempts - ?, error = coalesce(?, error) WHERE id = ?",
                  "iti", (int64_t)!counts, reason, job->id);
    if (!status)
        status = store_run(store, err,
                           "UPDATE study SET jobs_running = jobs_running - 1, jobs_waiting = "
                           "jobs_waiting + 1, revision = revision + 1 WHERE id = ?",
                           "i", job->study);
    return status;
}

static int job_fail(struct store *store, const struct job_row *job, const char *reason,
                    struct error *err) {
    int status =
        store_run(store, err,
                  "UPDATE job SET state = 'failed', reported = 0, error = ?, ended = " UTC_NOW
                  " WHERE id = ?",
                  "ti", reason, job->id);
    if (!status)
        status =
            store_run(store, err,
                      "UPDATE study SET jobs_running = jobs_running - 1, jobs_failed = "
                      "jobs_failed + 1, realisations_failed = realisations_failed + ? WHERE id = ?",
                      "ii", job->count, job->study);
    if (!status)
        status = store_run(store, err,
                           "UPDATE study_case SET jobs_left = jobs_left - 1 WHERE study_id = ? AND "
                           "number = ?",
                           "ii", job->study, job->case_number);
    return status ? status : study_settle(store, job->study, err);
}

static int job_give_up(struct store *store, const struct job_row *job, const char *reason,
                       bool permanent, struct error *err) {
    if (permanent || job->attempts >= ATTEMPTS_MOST)
        return job_fail(store, job, reason, err);
    return job_requeue(store, job, reason, true, err);
}

/* --- claim --- */

/* One job whose lease ran out waits again, or has failed. 1 when there was one. */
static int expire_one(struct store *store, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status =
        store_query(store, &row, err,
                    "SELECT id, coalesce(worker, '?') FROM job WHERE state = 'running' AND "
                    "(lease_until <= ? OR lease_boot <> ?) ORDER BY lease_until LIMIT 1",
                    "it", store_now(store), store->boot);
    if (!status)
        status = store_step(store, row, err);
    if (status <= 0)
        return status;
    int64_t id = sqlite3_column_int64(row, 0);
    char reason[160];
    snprintf(reason, sizeof reason, "lease ran out on worker %.100s",
             (const char *)sqlite3_column_text(row, 1));
    sqlite3_reset(row);
    struct job_row job;
    status = read_job(store, id, NULL, &job, err);
    if (!status)
        status = job_give_up(store, &job, reason, false, err);
    return status ? status : 1;
}

static int copy_study(struct store *store, int64_t study, struct claimed_job *job,
                      struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(store, &row, err,
                             "SELECT s.public, s.kind, s.seed, c.parameters FROM study s JOIN "
                             "study_case c ON c.study_id = s.id WHERE s.id = ? AND c.number = ?",
                             "ii", study, (int64_t)job->case_number);
    if (!status)
        status = store_step(store, row, err);
    if (status <= 0)
        return status ? status
                      : error_set(err, ERROR_SYSTEM, "job %lld has no case", (long long)job->id);
    snprintf(job->study, sizeof job->study, "%s", (const char *)sqlite3_column_text(row, 0));
    job->kind = column_copy(row, 1);
    job->seed = strtoull((const char *)sqlite3_column_text(row, 2), NULL, 10);
    job->parameters = column_copy(row, 3);
    sqlite3_reset(row);
    return job->kind && job->parameters ? 0 : error_memory(err, 0, "a job's parameters");
}

/* 1 and a job, or 0 when nothing waits. */
static int claim_one(struct store *store, const struct claim *claim, int64_t only,
                     const char *kinds, struct claimed_job *job, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = random_text(job->token, TOKEN_SIZE - 1, err);
    if (!status)
        status = store_query(
            store, &row, err,
            "UPDATE job SET state = 'running', attempts = attempts + 1, token = ?1, worker = ?2, "
            "host = ?3, lease_until = ?4, lease_boot = ?5, reported = 0, claimed = " UTC_NOW
            " WHERE id = (SELECT id FROM job WHERE state = 'waiting' AND (?6 = 0 OR study_id = ?6) "
            "AND (?7 IS NULL OR (SELECT kind FROM study WHERE study.id = study_id) IN (SELECT "
            "value "
            "FROM json_each(?7))) ORDER BY study_id, id LIMIT 1) "
            "RETURNING id, study_id, case_number, first, count, attempts",
            "tttitit", job->token, claim->worker, claim->host,
            store_now(store) + store->options.lease_ms, store->boot, only, kinds);
    if (!status)
        status = store_step(store, row, err);
    if (status <= 0)
        return status;
    job->id = sqlite3_column_int64(row, 0);
    int64_t study = sqlite3_column_int64(row, 1);
    job->case_number = (uint64_t)sqlite3_column_int64(row, 2);
    job->first = (uint64_t)sqlite3_column_int64(row, 3);
    job->count = (uint64_t)sqlite3_column_int64(row, 4);
    job->attempt = (uint64_t)sqlite3_column_int64(row, 5);
    job->lease_ms = store->options.lease_ms;
    sqlite3_reset(row);
    status = store_run(store, err,
                       "UPDATE study SET state = 'running', jobs_waiting = jobs_waiting - 1, "
                       "jobs_running = jobs_running + 1, revision = revision + 1 WHERE id = ?",
                       "i", study);
    if (!status)
        status = copy_study(store, study, job, err);
    return status ? status : 1;
}

/* The kinds as a JSON array for the query; NULL in *out for any kind. */
static int kinds_text(const char *const *kinds, char **out, struct error *err) {
    *out = NULL;
    if (!kinds)
        return 0;
    int count = 0;
    while (kinds[count])
        count++;
    cJSON *array = cJSON_CreateStringArray(kinds, count);
    *out = array ? json_print(array) : NULL;
    cJSON_Delete(array);
    return *out ? 0 : error_memory(err, 0, "a list of kinds");
}

int store_claim(struct store *store, const struct claim *claim, struct claimed_job *jobs,
                size_t *count, struct error *err) {
    int64_t only = 0;
    char *kinds = NULL;
    size_t n = 0;
    *count = 0;
    int status = kinds_text(claim->kinds, &kinds, err);
    if (!status)
        status = change_begin(store, err);
    if (status) {
        free(kinds);
        return status;
    }
    if (claim->study)
        status = study_row(store, claim->study, &only, err);
    while (!status && (status = expire_one(store, err)) == 1)
        status = 0;
    while (!status && n < claim->count) {
        jobs[n] = (struct claimed_job){0};
        status = claim_one(store, claim, only, kinds, &jobs[n], err);
        if (status == 0)
            break;
        n++; /* also after an error: what it holds is cleared below */
        status = status == 1 ? 0 : status;
    }
    free(kinds);
    status = change_end(store, status, err);
    for (size_t i = 0; status && i < n; i++)
        claimed_job_clear(&jobs[i]);
    *count = status ? 0 : n;
    return status;
}

/* --- under a lease --- */

int store_heartbeat(struct store *store, int64_t job, const char *token, uint64_t done,
                    struct error *err) {
    struct job_row row;
    int status = change_begin(store, err);
    if (status)
        return status;
    status = read_leased(store, job, token, &row, err);
    if (!status) {
        int64_t reported = done < (uint64_t)row.count ? (int64_t)done : row.count;
        status = store_run(
            store, err, "UPDATE job SET lease_until = ?, lease_boot = ?, reported = ? WHERE id = ?",
            "itii", store_now(store) + store->options.lease_ms, store->boot, reported, job);
    }
    return change_end(store, status, err);
}

int store_fail(struct store *store, int64_t job, const char *token, const char *reason,
               bool permanent, struct error *err) {
    struct job_row row;
    int status = change_begin(store, err);
    if (status)
        return status;
    status = read_leased(store, job, token, &row, err);
    if (!status)
        status = job_give_up(store, &row, reason, permanent, err);
    return change_end(store, status, err);
}

int store_release(struct store *store, int64_t job, const char *token, struct error *err) {
    struct job_row row;
    int status = change_begin(store, err);
    if (status)
        return status;
    status = read_leased(store, job, token, &row, err);
    if (!status)
        status = job_requeue(store, &row, NULL, false, err);
    return change_end(store, status, err);
}

int store_job(struct store *store, int64_t job, const char *token, struct claimed_job *out,
              struct error *err) {
    struct job_row row;
    int status = read_job(store, job, token, &row, err);
    if (!status && !(row.owned && (row.running || row.done)))
        status = error_set(err, ERROR_STATE, "the lease of job %lld is lost", (long long)job);
    if (status)
        return status;
    *out = (struct claimed_job){.id = job,
                                .case_number = (uint64_t)row.case_number,
                                .first = (uint64_t)row.first,
                                .count = (uint64_t)row.count,
                                .attempt = (uint64_t)row.attempts,
                                .lease_ms = store->options.lease_ms};
    snprintf(out->token, sizeof out->token, "%s", token);
    status = copy_study(store, row.study, out, err);
    if (status)
        claimed_job_clear(out);
    return status;
}

/* --- completion --- */

/* The scalars as JSON rows, %.17g so that they read back to the same doubles. */
static char *scalars_text(const struct block_result *result) {
    cJSON *rows = cJSON_CreateArray();
    for (uint64_t r = 0; rows && r < result->count; r++) {
        cJSON *row = json_numbers(result->scalars + r * result->scalar_count, result->scalar_count);
        if (!row || !cJSON_AddItemToArray(rows, row)) {
            cJSON_Delete(row);
            cJSON_Delete(rows);
            return NULL;
        }
    }
    char *text = rows ? json_print(rows) : NULL;
    cJSON_Delete(rows);
    return text;
}

static char *names_text(const struct block_result *result) {
    cJSON *names = cJSON_CreateStringArray(result->names, (int)result->scalar_count);
    char *text = names ? json_print(names) : NULL;
    cJSON_Delete(names);
    return text;
}

static int insert_result(struct store *store, const struct job_row *job,
                         const struct block_result *result, struct error *err) {
    char *names = names_text(result), *scalars = scalars_text(result);
    int status = names && scalars ? 0 : error_memory(err, result->size, "a result");
    if (!status)
        status =
            store_run(store, err,
                      "INSERT INTO result (job_id, study_id, case_number, first, count, names, "
                      "scalars, data, seconds) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
                      "iiiiittbd", job->id, job->study, job->case_number, job->first, job->count,
                      names, scalars, (const void *)result->data, result->size, result->seconds);
    free(names);
    free(scalars);
    return status;
}

static int job_complete(struct store *store, const struct job_row *job,
                        const struct block_result *result, struct error *err) {
    int status = insert_result(store, job, result, err);
    if (!status)
        status =
            store_run(store, err,
                      "UPDATE job SET state = 'done', reported = 0, seconds = ?, ended = " UTC_NOW
                      " WHERE id = ?",
                      "di", result->seconds, job->id);
    if (!status)
        status = store_run(store, err,
                           "UPDATE study_case SET jobs_left = jobs_left - 1, realisations_done = "
                           "realisations_done + ?, seconds = seconds + ?, revision = revision + 1 "
                           "WHERE study_id = ? AND number = ?",
                           "idii", job->count, result->seconds, job->study, job->case_number);
    if (!status)
        status = store_run(
            store, err,
            "UPDATE study SET jobs_running = jobs_running - 1, jobs_done = jobs_done + 1, "
            "realisations_done = realisations_done + ?, seconds = seconds + ? WHERE id = ?",
            "idi", job->count, result->seconds, job->study);
    return status ? status : study_settle(store, job->study, err);
}

static int check_block(const struct job_row *job, const struct block_result *result,
                       struct error *err) {
    if (result->first == (uint64_t)job->first && result->count == (uint64_t)job->count)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "a result of %llu realisations from %llu; job %lld is %lld from %lld",
                     (unsigned long long)result->count, (unsigned long long)result->first,
                     (long long)job->id, (long long)job->count, (long long)job->first);
}

int store_complete(struct store *store, int64_t job, const char *token,
                   const struct block_result *result, bool *first_time, bool *case_done,
                   struct error *err) {
    struct job_row row;
    int64_t left = 0;
    int status = change_begin(store, err);
    if (status)
        return status;
    status = read_job(store, job, token, &row, err);
    bool again = !status && row.done && row.owned;
    if (!status && !again)
        status = read_leased(store, job, token, &row, err);
    if (!status)
        status = check_block(&row, result, err);
    if (!status && !again)
        status = job_complete(store, &row, result, err);
    if (!status)
        status = store_integer(store, &left, err,
                               "SELECT jobs_left FROM study_case WHERE study_id = ? AND number = ?",
                               "ii", row.study, row.case_number);
    status = change_end(store, status, err);
    if (!status) {
        *first_time = !again;
        *case_done = left == 0;
    }
    return status;
}
