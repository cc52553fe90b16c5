/* Workers at work: their leases, and the jobs that they ended lately. */
#include "schema/result/bytes/bytes.h"
#include "schema/store/store_internal.h"
#include <stdlib.h>
#include <string.h>

enum { WORKERS_MOST = 1000 };

void workers_free(struct worker_activity *workers, size_t count) {
    for (size_t w = 0; workers != NULL && w < count; w++) {
        free(workers[w].name);
        free(workers[w].host);
        free(workers[w].study_name);
        free(workers[w].study);
        free(workers[w].claimed);
        free(workers[w].last_ended);
    }
    free(workers);
}

/* Takes a row: name, host, study, its name, case, job, count, reported, claimed, jobs, ended. */
static int append_worker(sqlite3_stmt *row, struct worker_activity *all, size_t *count,
                         struct error *err) {
    struct worker_activity *worker = &all[(*count)++];
    *worker = (struct worker_activity){.name = column_copy(row, 0),
                                       .host = column_copy(row, 1),
                                       .study = column_copy(row, 2),
                                       .study_name = column_copy(row, 3),
                                       .case_number = (uint64_t)sqlite3_column_int64(row, 4),
                                       .job = sqlite3_column_int64(row, 5),
                                       .count = (uint64_t)sqlite3_column_int64(row, 6),
                                       .done = (uint64_t)sqlite3_column_int64(row, 7),
                                       .part = sqlite3_column_double(row, 7) -
                                               (double)sqlite3_column_int64(row, 7),
                                       .claimed = column_copy(row, 8),
                                       .recent_jobs = (uint64_t)sqlite3_column_int64(row, 9),
                                       .last_ended = column_copy(row, 10)};
    bool complete = worker->name != NULL && worker->host != NULL && worker->study != NULL &&
                    worker->study_name != NULL && worker->claimed != NULL &&
                    worker->last_ended != NULL;
    return complete ? 0 : error_memory(err, 0, "a worker");
}

/* A job that was copied with its block from another study has no token, and counts there. */
int store_workers(struct store *store, struct worker_activity **out, size_t *count,
                  struct error *err) {
    sqlite3_stmt *row = NULL;
    size_t n = 0;
    struct worker_activity *all = array_create(WORKERS_MOST, sizeof *all);
    if (all == NULL)
        return error_memory(err, WORKERS_MOST * sizeof *all, "workers");
    int status = store_query(
        store, &row, err,
        "WITH recent AS (SELECT worker, host, count(*) AS jobs, max(ended) AS ended FROM job "
        "WHERE state = 'done' AND ended >= strftime('%Y-%m-%dT%H:%M:%SZ', 'now', '-1 hour') "
        "AND token IS NOT NULL "
        "GROUP BY worker, host), running AS (SELECT j.worker, j.host, s.public, s.name, "
        "coalesce(c.parent, c.number) AS number, j.id, j.count, j.reported, j.claimed FROM job j "
        "JOIN study s ON s.id = j.study_id JOIN study_case c ON c.study_id = j.study_id AND "
        "c.number = j.case_number WHERE j.state = 'running' AND j.lease_until > ?1) "
        "SELECT r.worker, r.host, r.public, r.name, r.number, r.id, r.count, r.reported, "
        "r.claimed, coalesce(d.jobs, 0), d.ended FROM running r LEFT JOIN recent d ON d.worker = "
        "r.worker AND d.host IS r.host UNION ALL SELECT d.worker, d.host, '', '', 0, 0, 0, 0, '', "
        "d.jobs, d.ended FROM recent d WHERE NOT EXISTS (SELECT 1 FROM running r WHERE r.worker "
        "= d.worker AND r.host IS d.host) ORDER BY 1, 2, 6 LIMIT ?2",
        "ii", store_now(store), (int64_t)WORKERS_MOST);
    while (status == 0 && (status = store_step(store, row, err)) == 1)
        status = append_worker(row, all, &n, err);
    if (status < 0) {
        workers_free(all, n);
        return status;
    }
    *out = all;
    *count = n;
    return 0;
}

/* Workers that asked for jobs lately, among which few realisations that wait are divided. */

/* A worker counts for SEEN_MS after it was noted, and is noted again after NOTE_MS at most. As
 * every claim asks, all are counted once in COUNT_MS at most. More than SEEN_MOST make no
 * difference, and would take time. */
enum { SEEN_MS = 120000, NOTE_MS = 20000, COUNT_MS = 1000, SEEN_MOST = 20000, THREADS_MOST = 4096 };

static int64_t threads_of(const struct claim *claim) {
    if (claim->threads < 1)
        return 1;
    return claim->threads < THREADS_MOST ? (int64_t)claim->threads : THREADS_MOST;
}

/* Removes workers not seen for long, and counts the others. */
static int count(struct store *store, int64_t now, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_run(store, err, "DELETE FROM seen WHERE at NOT BETWEEN ? AND ?", "ii",
                           now - SEEN_MS, now);
    if (status == 0)
        status = store_query(store, &row, err, "SELECT count(*), total(threads) FROM seen", "");
    if (status == 0)
        status = store_step(store, row, err);
    if (status < 0)
        return status;
    store->workers_seen = sqlite3_column_int64(row, 0);
    store->threads_seen = sqlite3_column_int64(row, 1);
    store->seen_ms = now;
    sqlite3_reset(row);
    return 0;
}

/* Notes a worker in the store unless it was noted there a short time ago. Two workers that share an
 * entry of `noted` replace each other's, so that this may be called more often than needed. */
static int note(struct store *store, const struct claim *claim, int64_t now, struct error *err) {
    int64_t threads = threads_of(claim), last = -1;
    int status = store_integer(store, &last, err,
                               "SELECT at FROM seen WHERE worker = ? AND threads = ? AND at <= ?",
                               "tii", claim->worker, threads, now);
    if (status == ERROR_ABSENT)
        status = 0;
    if (status != 0 || (last >= 0 && now - last < NOTE_MS / 2) ||
        (last < 0 && store->workers_seen >= SEEN_MOST))
        return status;
    store->workers_seen += last < 0;
    store->threads_seen += last < 0 ? threads : 0;
    return store_run(store, err,
                     "INSERT OR REPLACE INTO seen (worker, threads, at) VALUES (?, ?, ?)", "tii",
                     claim->worker, threads, now);
}

/* Notes a worker unless this handle did so lately. A note that was rolled back is made again when
 * it is next due. */
static int note_unless_fresh(struct store *store, const struct claim *claim, int64_t now,
                             struct error *err) {
    int64_t threads = threads_of(claim);
    uint64_t worker = hash_bytes(HASH_START, strlen(claim->worker) + 1, claim->worker);
    worker = hash_bytes(worker, sizeof threads, &threads);
    size_t slot = worker % NOTED;
    if (store->noted[slot].worker == worker && now >= store->noted[slot].from_ms &&
        now < store->noted[slot].until_ms)
        return 0;
    store->noted[slot].worker = worker;
    store->noted[slot].from_ms = now;
    store->noted[slot].until_ms = now + NOTE_MS;
    return note(store, claim, now, err);
}

int seen_note(struct store *store, const struct claim *claim, int64_t *threads, struct error *err) {
    int64_t now = store_now(store), age = now - store->seen_ms;
    int status = 0;
    if (store->workers_seen == 0 || age < 0 || age >= COUNT_MS)
        status = count(store, now, err);
    if (status == 0 && claim->worker != NULL)
        status = note_unless_fresh(store, claim, now, err);
    *threads = store->threads_seen > 0 ? store->threads_seen : 1;
    return status;
}
