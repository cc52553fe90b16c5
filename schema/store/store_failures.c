/* What failed of a study: jobs, and cases that cannot be published. */
#include "schema/store/store_internal.h"
#include <stdlib.h>

void failures_free(struct failure *failures, size_t count) {
    for (size_t i = 0; failures != NULL && i < count; i++) {
        free(failures[i].worker);
        free(failures[i].reason);
    }
    free(failures);
}

/* Counts a failure once it has a place in the list, complete or not. */
static int append_failure(sqlite3_stmt *row, struct failure **list, size_t *number,
                          struct error *err) {
    size_t count = *number;
    struct failure *larger = realloc(*list, (count + 1) * sizeof *larger);
    if (larger == NULL)
        return error_memory(err, (count + 1) * sizeof *larger, "failures");
    *list = larger;
    *number = count + 1;
    larger[count] = (struct failure){sqlite3_column_int64(row, 0),
                                     (uint64_t)sqlite3_column_int64(row, 1),
                                     (uint64_t)sqlite3_column_int64(row, 2),
                                     (uint64_t)sqlite3_column_int64(row, 3),
                                     (uint64_t)sqlite3_column_int64(row, 4),
                                     (uint64_t)sqlite3_column_int64(row, 7),
                                     column_copy(row, 5),
                                     column_copy(row, 6)};
    if (larger[count].worker == NULL || larger[count].reason == NULL)
        return error_memory(err, 0, "a failure's reason");
    return 0;
}

int store_failures(struct store *store, const char *id, struct failure **out, size_t *count,
                   struct error *err) {
    int64_t row = 0;
    sqlite3_stmt *statement = NULL;
    struct failure *list = NULL;
    size_t n = 0;
    int status = study_row(store, id, &row, err);
    if (status == 0)
        status = store_query(
            store, &statement, err,
            "SELECT id, case_number, first, count, attempts, worker, error, losses FROM "
            "job "
            "WHERE study_id = ?1 AND state = 'failed' UNION ALL SELECT 0, number, 0, "
            "realisations_done, 0, NULL, publish_error, 0 FROM study_case WHERE study_id "
            "= ?1 AND publish_error IS NOT NULL ORDER BY 1, 2 LIMIT 1000",
            "i", row);
    while (status == 0 && (status = store_step(store, statement, err)) == 1)
        status = append_failure(statement, &list, &n, err);
    if (status < 0) {
        failures_free(list, n);
        return status;
    }
    *out = list;
    *count = n;
    return 0;
}
