/* What is published of a case, read back. */
#include "schema/result/curve_bytes.h"
#include "schema/result/result_json.h"
#include "schema/store/store_internal.h"
#include <string.h>

/* Curves of the case, all or those of a quantity, in the order in which they were published. */
static int read_curves(struct store *store, int64_t study, uint64_t case_number,
                       const char *quantity, struct case_result *result, struct error *err) {
    sqlite3_stmt *row = NULL;
    int status = store_query(store, &row, err,
                             "SELECT data FROM curve WHERE study_id = ?1 AND case_number = ?2 AND "
                             "(?3 IS NULL OR quantity = ?3) ORDER BY id",
                             "iit", study, (int64_t)case_number, quantity);
    while (status == 0 && (status = store_step(store, row, err)) == 1) {
        status = curve_decode(result, sqlite3_column_blob(row, 0),
                              (size_t)sqlite3_column_bytes(row, 0), err);
        if (status != 0)
            sqlite3_reset(row);
    }
    return status;
}

static int read_document(sqlite3_stmt *row, uint64_t case_number, struct case_result *out,
                         struct error *err) {
    cJSON *document = NULL;
    int status = column_json(row, 0, &document, err);
    if (status != 0)
        return status;
    if (cJSON_GetObjectItemCaseSensitive(document, "case") == NULL &&
        cJSON_AddNumberToObject(document, "case", (double)case_number) == NULL)
        status = error_memory(err, sizeof *document, "a document");
    if (status == 0)
        status = result_read(document, out, err);
    cJSON_Delete(document);
    return status;
}

/* The row of a case published at this revision: its document, and its report or NULL. */
static int find_row(struct store *store, const char *study, uint64_t case_number, uint64_t revision,
                    int64_t *id, sqlite3_stmt **row, struct error *err) {
    int status = study_row(store, study, id, err);
    if (status == 0)
        status = store_query(store, row, err,
                             "SELECT document, report FROM published WHERE study_id = ? AND "
                             "case_number = ? AND revision = ?",
                             "iii", *id, (int64_t)case_number, (int64_t)revision);
    return status != 0 ? status : store_step(store, *row, err);
}

int store_published(struct store *store, const char *study, uint64_t case_number, uint64_t revision,
                    const struct published_part *part, struct case_result *out, bool *found,
                    struct error *err) {
    struct case_result result = {0};
    sqlite3_stmt *row = NULL;
    int64_t id = 0;
    int status = find_row(store, study, case_number, revision, &id, &row, err);
    *found = status == 1;
    if (status != 1)
        return status;
    bool whole = sqlite3_column_type(row, 1) == SQLITE_NULL;
    status = read_document(row, case_number, &result, err);
    sqlite3_reset(row);
    if (status == 0 && whole) /* an older program published the whole result in one document */
        result_keep(&result, part->quantity, part->scalars_only);
    else if (status == 0 && !part->scalars_only)
        status = read_curves(store, id, case_number, part->quantity, &result, err);
    if (status != 0) {
        result_clear(&result);
        return error_context(err, "what is published of case %llu",
                             (unsigned long long)case_number);
    }
    *out = result;
    return 0;
}

int store_published_report(struct store *store, const char *study, uint64_t case_number,
                           uint64_t revision, struct case_report *out, bool *found,
                           struct error *err) {
    cJSON *document = NULL;
    sqlite3_stmt *row = NULL;
    int64_t id = 0;
    int status = find_row(store, study, case_number, revision, &id, &row, err);
    *found = status == 1 && sqlite3_column_type(row, 1) != SQLITE_NULL;
    if (status == 1) {
        status = *found ? column_json(row, 1, &document, err) : 0;
        sqlite3_reset(row);
    }
    if (status == 0 && *found)
        status = case_report_read(document, out, err);
    cJSON_Delete(document);
    return status;
}
