/* Whether a claim may find anything, without asking for it. */
#include "schema/store/store_internal.h"

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
