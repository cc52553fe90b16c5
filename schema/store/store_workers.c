/* Who works on what: leases that live, and what was done of late. */
#include "schema/store/store_internal.h"
#include <stdlib.h>

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
                                       .claimed = column_copy(row, 8),
                                       .recent_jobs = (uint64_t)sqlite3_column_int64(row, 9),
                                       .last_ended = column_copy(row, 10)};
    bool complete = worker->name != NULL && worker->host != NULL && worker->study != NULL &&
                    worker->study_name != NULL && worker->claimed != NULL &&
                    worker->last_ended != NULL;
    return complete ? 0 : error_memory(err, 0, "a worker");
}

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
