/* Claims: jobs are leased, and requeued when their lease ran out. */
#include "schema/store/store_internal.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Requeues, or fails, one job whose lease ran out. Returns 1 when there was one. */
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
    char worker[104];
    snprintf(worker, sizeof worker, "%.100s", (const char *)sqlite3_column_text(row, 1));
    sqlite3_reset(row);
    struct job_row job;
    bool failed = false;
    status = job_read(store, id, NULL, &job, err);
    if (status == 0)
        status = job_lose(store, &job, worker, &failed, err);
    store->claim_failed_jobs |= failed;
    return status != 0 ? status : 1;
}

/* Makes the kinds of a claim as " one two ", which the caller frees; *out is NULL for any. */
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

#define FOUND_COLUMNS                                                                              \
    "id, public, kind, seed, state = 'queued', random, owner, jobs_waiting, realisations_waiting"
/* Studies that a claim may take jobs from: ?1 those of independent cases alone, ?2 of these kinds.
 * Left out are studies all of whose jobs pause after a loss: ?4 is now. */
#define CLAIMABLE                                                                                  \
    "state IN ('queued', 'running') AND jobs_waiting > 0 AND (NOT ?1 OR random = 'independent' "   \
    "OR (cases = 1 AND realisations > 0)) AND (?2 IS NULL OR instr(?2, ' ' || kind || ' ') > 0) "  \
    "AND EXISTS (SELECT 1 FROM job INDEXED BY job_waiting WHERE study_id = study.id AND "          \
    "job.state = 'waiting' AND not_before <= ?4)"
/* Finds the first study in line of this owner, or the one that is asked for. Fills the job's study,
 * kind and seed. Returns 1, or 0 when there is none. */
static int first_study(struct store *store, const struct claiming *claiming,
                       struct found_study *found, struct claimed_job *job, struct error *err) {
    sqlite3_stmt *row = NULL;
    int64_t independent = claiming->claim->independent_only, now = store_now(store);
    int status =
        claiming->only != 0
            ? store_query(store, &row, err,
                          "SELECT " FOUND_COLUMNS " FROM study WHERE " CLAIMABLE " AND id = ?3",
                          "itii", independent, claiming->kinds, claiming->only, now)
            : store_query(store, &row, err,
                          "SELECT " FOUND_COLUMNS " FROM study INDEXED BY study_line WHERE "
                          "owner = ?3 AND " CLAIMABLE " ORDER BY priority DESC, id LIMIT 1",
                          "itti", independent, claiming->kinds, found->owner, now);
    if (status == 0)
        status = store_step(store, row, err);
    if (status <= 0)
        return status;
    found->id = sqlite3_column_int64(row, 0);
    found->queued = sqlite3_column_int(row, 4);
    found->random = column_random(row, 5);
    found->jobs_waiting = sqlite3_column_int64(row, 7);
    found->realisations_waiting = sqlite3_column_int64(row, 8);
    snprintf(found->owner, sizeof found->owner, "%s", (const char *)sqlite3_column_text(row, 6));
    snprintf(job->study, sizeof job->study, "%s", (const char *)sqlite3_column_text(row, 1));
    job->seed = strtoull((const char *)sqlite3_column_text(row, 3), NULL, 10);
    job->kind = column_copy(row, 2);
    sqlite3_reset(row);
    return job->kind != NULL ? 1 : error_memory(err, 0, "a kind");
}

/* Tries owner after owner, the one whose clock is least first. */
static int next_study(struct store *store, const struct claiming *claiming,
                      struct found_study *found, struct claimed_job *job, struct error *err) {
    sqlite3_stmt *turn = NULL;
    int status = store_query(store, &turn, err,
                             "SELECT owner FROM share ORDER BY max(served, (SELECT max(begun) FROM "
                             "share)), begun, owner",
                             "");
    while (status == 0 && (status = store_step(store, turn, err)) == 1) {
        snprintf(found->owner, sizeof found->owner, "%s",
                 (const char *)sqlite3_column_text(turn, 0));
        status = first_study(store, claiming, found, job, err);
        if (status != 0)
            sqlite3_reset(turn);
    }
    return status;
}

/* Sets how many jobs the claim may have in all when its first one is of this study. Where few wait
 * it is the claim's share by threads, and at least one a thread. */
static int count_most(struct store *store, struct claiming *claiming,
                      const struct found_study *study, size_t *most, struct error *err) {
    const struct claim *claim = claiming->claim;
    int64_t own = claim->threads > 0 ? (int64_t)claim->threads : 1, share = own;
    int64_t enough = own < claiming->threads ? claiming->threads * (int64_t)claim->count / own : 0;
    int status = 0;
    *most = claim->count;
    if (claim->count <= (size_t)own || study->jobs_waiting >= enough)
        return 0;
    status = count_elsewhere(store, study->id, enough, &claiming->elsewhere, err);
    if (status == 0)
        share = (study->jobs_waiting + claiming->elsewhere) * own / claiming->threads;
    if (share < own)
        share = own;
    if ((size_t)share < claim->count)
        *most = (size_t)share;
    return status;
}

/* Claims one job: returns 1, 0 when nothing waits, or 2 where a damaged one failed. *most: see
 * count_most; 0 before the first. */
static int claim_one(struct store *store, struct claiming *claiming, size_t *most,
                     struct claimed_job *job, struct error *err) {
    struct found_study study = {0};
    int status = claiming->only != 0 ? first_study(store, claiming, &study, job, err)
                                     : next_study(store, claiming, &study, job, err);
    if (status <= 0)
        return status;
    status = *most == 0 ? count_most(store, claiming, &study, most, err) : 0;
    if (status == 0)
        status = block_lease(store, claiming, &study, job, err);
    return status < 0 ? status : 1 + status;
}

/* Claims until there are enough jobs, by their number or by the seconds that they take. */
static int claim_all(struct store *store, struct claiming *claiming, struct claimed_job *jobs,
                     size_t *count, struct error *err) {
    const struct claim *claim = claiming->claim;
    size_t most = 0;
    int status = 1;
    while (status >= 1 && *count < claim->count && (*count == 0 || *count < most) &&
           (claim->seconds <= 0 || *count == 0 || claiming->seconds < claim->seconds)) {
        jobs[*count] = (struct claimed_job){0};
        status = claim_one(store, claiming, &most, &jobs[*count], err);
        if (status == 2)
            claimed_job_clear(&jobs[*count]);
        else if (status != 0) /* an error, too: what it holds is cleared later */
            (*count)++;
    }
    return status < 0 ? status : 0;
}

/* Looks up what a claim needs: its study, its kinds, and the threads of other workers. */
static int open_claim(struct store *store, struct claiming *claiming, struct error *err) {
    const struct claim *claim = claiming->claim;
    int status = kinds_text(claim->kinds, &claiming->kinds, err);
    if (status == 0 && claim->study != NULL)
        status = study_row(store, claim->study, &claiming->only, err);
    return status != 0 ? status : seen_note(store, claim, &claiming->threads, err);
}

int store_claim(struct store *store, const struct claim *claim, struct claimed_job *jobs,
                size_t *count, struct error *err) {
    struct claiming claiming = {.claim = claim, .elsewhere = -1};
    size_t n = 0;
    *count = 0;
    store->claim_failed_jobs = false;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = open_claim(store, &claiming, err);
    while (status == 0 && (status = expire_one(store, err)) == 1)
        status = 0;
    if (status == 0)
        status = claim_all(store, &claiming, jobs, &n, err);
    status = change_end(store, status, err);
    free(claiming.kinds);
    for (size_t i = 0; status != 0 && i < n; i++)
        claimed_job_clear(&jobs[i]);
    *count = status != 0 ? 0 : n;
    return status;
}

bool store_claim_failed_jobs(const struct store *store) {
    return store->claim_failed_jobs;
}
