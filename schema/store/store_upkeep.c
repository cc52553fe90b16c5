/* Figures about the store itself. */
#include "schema/store/store_internal.h"
#include <stdio.h>
#include <sys/stat.h>

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
