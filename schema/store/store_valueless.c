/* Cases that were computed and have nothing to tell: no realisation has a value. */
#include "schema/store/store_internal.h"
#include <stdlib.h>

/* Cases of study ?1 that have curves, and no value on any of them. */
#define WITHOUT_VALUES                                                                             \
    "FROM published p WHERE p.study_id = ?1 AND EXISTS (SELECT 1 FROM curve c WHERE c.study_id = " \
    "p.study_id AND c.case_number = p.case_number) AND NOT EXISTS (SELECT 1 FROM curve c JOIN "    \
    "point t ON t.curve_id = c.id WHERE c.study_id = p.study_id AND c.case_number = "              \
    "p.case_number AND t.y IS NOT NULL)"

/* The first note of the first such case. */
static int read_first(struct store *store, int64_t study, struct valueless *out,
                      struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(store, &row, err,
                             "SELECT p.case_number, p.document ->> '$.notes.kept[0].text' "
                             "" WITHOUT_VALUES " ORDER BY p.case_number LIMIT 1",
                             "i", study);
    if (status == 0)
        status = store_step(store, row, err);
    if (status <= 0)
        return status;
    out->first = (uint64_t)sqlite3_column_int64(row, 0);
    out->note = column_copy(row, 1);
    sqlite3_reset(row);
    return out->note != NULL ? 0 : error_memory(err, 0, "a note");
}

int store_valueless(struct store *store, const char *id, struct valueless *out, struct error *err) {
    struct valueless found = {0};
    int64_t study = 0, cases = 0;
    int status = study_row(store, id, &study, err);
    if (status == 0)
        status = store_integer(store, &cases, err, "SELECT count(*) " WITHOUT_VALUES, "i", study);
    if (status == 0 && cases > 0)
        status = read_first(store, study, &found, err);
    found.cases = (uint64_t)cases;
    if (status == 0)
        *out = found;
    return status;
}

void valueless_clear(struct valueless *valueless) {
    free(valueless->note);
    *valueless = (struct valueless){0};
}
