/* What is due: cases whose curves are to be published. */
#include "schema/store/store_internal.h"
#include <stdio.h>

int store_unpublished(struct store *store, uint64_t skip, char study[STUDY_ID_SIZE],
                      uint64_t *case_number, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status =
        store_query(store, &row, err,
                    "SELECT s.public, c.number FROM study_case c JOIN study s ON s.id = "
                    "c.study_id LEFT JOIN published p ON p.study_id = c.study_id AND "
                    "p.case_number = c.number WHERE c.jobs_left = 0 AND c.realisations_done > 0 "
                    "AND coalesce(p.revision, 0) < c.revision ORDER BY c.study_id, c.number "
                    "LIMIT 1 OFFSET ?",
                    "i", (int64_t)skip);
    if (!status)
        status = store_step(store, row, err);
    if (status == 0)
        return error_set(err, ERROR_ABSENT, "every complete case is published");
    if (status < 0)
        return status;
    snprintf(study, STUDY_ID_SIZE, "%s", (const char *)sqlite3_column_text(row, 0));
    *case_number = (uint64_t)sqlite3_column_int64(row, 1);
    sqlite3_reset(row);
    return 0;
}
