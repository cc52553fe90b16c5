/* Reads what is published of a case. */
#include "schema/result/bytes/curve_bytes.h"
#include "schema/result/result_json.h"
#include "schema/store/store_seal.h"
#include <stdio.h>
#include <string.h>

static int read_group(struct case_result *result, const void *data, size_t size,
                      struct error *err) {
    struct packed_bytes bytes = {0};
    int status = bytes_unpack(&bytes, data, size, err);
    if (status == 0)
        status = curves_decode(result, bytes.data, bytes.size, err);
    packed_bytes_clear(&bytes);
    return status;
}

/* Reads the curves of a case, all or those of a quantity, in the order in which they were
 * published. The row of one may have several of its quantity; theirs have no bytes then. */
static int read_curves(struct store *store, int64_t study, uint64_t case_number,
                       const char *quantity, struct case_result *result, struct error *err) {
    sqlite3_stmt *row = NULL;
    size_t rows = 0, before = result->curve_count;
    int status = store_query(store, &row, err,
                             "SELECT data FROM curve WHERE study_id = ?1 AND case_number = ?2 AND "
                             "(?3 IS NULL OR quantity = ?3) ORDER BY id",
                             "iit", study, (int64_t)case_number, quantity);
    while (status == 0 && (status = store_step(store, row, err)) == 1) {
        status = 0;
        if (sqlite3_column_type(row, 0) != SQLITE_NULL)
            status = read_group(result, sqlite3_column_blob(row, 0),
                                (size_t)sqlite3_column_bytes(row, 0), err);
        if (status != 0)
            sqlite3_reset(row);
        rows++;
    }
    if (status == 0 && result->curve_count - before != rows)
        return error_set(err, ERROR_INPUT, "%zu curves instead of %zu",
                         result->curve_count - before, rows);
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

/* The columns of what is published of a case. */
enum { DOCUMENT, REPORT, INTACT, CURVES_INTACT };

/* Finds the row of a case published at this revision: its document, its report or NULL, and whether
 * they match their checksum. With `curves` the list of curves is checked, too. */
static int find_row(struct store *store, const struct due_case *of, bool curves, int64_t *id,
                    sqlite3_stmt **row, struct error *err) {
    int status = study_row(store, of->study, id, err);
    if (status == 0)
        status = store_query(store, row, err,
                             "SELECT document, report, seal IS NULL OR seal = " PUBLISHED_SEAL
                             ", NOT ?4 OR curves_seal IS NULL OR curves_seal = " CURVES_SEAL
                             " FROM published WHERE study_id = ?1 AND case_number = ?2 AND "
                             "revision = ?3",
                             "iiii", *id, (int64_t)of->case_number, (int64_t)of->revision,
                             (int64_t)curves);
    return status != 0 ? status : store_step(store, *row, err);
}

/* A case that cannot be read, but not for lack of memory or a fault of the disk, is damaged: it is
 * noted and counts as not found. */
static int settle_damage(struct store *store, const struct due_case *of, int status, bool *found) {
    if (status != ERROR_INPUT)
        return status;
    store->damaged = *of;
    *found = false;
    return 0;
}

bool store_found_damage(struct store *store, struct due_case *out) {
    *out = store->damaged;
    store->damaged = (struct due_case){0};
    return out->study[0] != '\0';
}

static struct due_case due_case(const char *study, uint64_t case_number, uint64_t revision) {
    struct due_case of = {.case_number = case_number, .revision = revision};
    snprintf(of.study, sizeof of.study, "%s", study);
    return of;
}

static int read_case(struct store *store, int64_t id, sqlite3_stmt *row, uint64_t case_number,
                     const struct published_part *part, struct case_result *out,
                     struct error *err) {
    bool whole = sqlite3_column_type(row, REPORT) == SQLITE_NULL;
    bool intact =
        sqlite3_column_int(row, INTACT) != 0 && sqlite3_column_int(row, CURVES_INTACT) != 0;
    int status = 0;
    if (!intact)
        status = error_set(err, ERROR_INPUT, "its checksum does not match");
    else if (whole || !part->curves_only)
        status = read_document(row, case_number, out, err);
    sqlite3_reset(row);
    if (status == 0 && whole) /* an older program published the whole result in one document */
        result_keep(out, part->quantity, part->scalars_only);
    else if (status == 0 && !part->scalars_only)
        status = read_curves(store, id, case_number, part->quantity, out, err);
    result_sampled(out, out->realisations);
    return status;
}

int store_published(struct store *store, const char *study, uint64_t case_number, uint64_t revision,
                    const struct published_part *part, struct case_result *out, bool *found,
                    struct error *err) {
    const struct due_case of = due_case(study, case_number, revision);
    struct case_result result = {0};
    sqlite3_stmt *row = NULL;
    int64_t id = 0;
    int status = find_row(store, &of, !part->scalars_only, &id, &row, err);
    *found = status == 1;
    if (status != 1)
        return status;
    status = read_case(store, id, row, case_number, part, &result, err);
    if (status != 0) {
        result_clear(&result);
        error_context(err, "what is published of case %llu", (unsigned long long)case_number);
        return settle_damage(store, &of, status, found);
    }
    *out = result;
    return 0;
}

int store_published_report(struct store *store, const char *study, uint64_t case_number,
                           uint64_t revision, struct case_report *out, bool *found,
                           struct error *err) {
    const struct due_case of = due_case(study, case_number, revision);
    cJSON *document = NULL;
    sqlite3_stmt *row = NULL;
    int64_t id = 0;
    int status = find_row(store, &of, false, &id, &row, err);
    *found = status == 1 && sqlite3_column_type(row, REPORT) != SQLITE_NULL;
    if (status == 1) {
        status = !*found                                ? 0
                 : sqlite3_column_int(row, INTACT) != 0 ? column_json(row, REPORT, &document, err)
                                                        : ERROR_INPUT;
        sqlite3_reset(row);
    }
    if (status == 0 && *found)
        status = case_report_read(document, out, err);
    cJSON_Delete(document);
    return settle_damage(store, &of, status, found);
}

int store_unpublish(struct store *store, const struct due_case *damaged, struct error *err) {
    int64_t study = 0;
    int status = change_begin(store, err);
    if (status != 0)
        return status;
    status = study_row(store, damaged->study, &study, err);
    if (status == 0)
        status = store_run(store, err,
                           "UPDATE published SET revision = -1 WHERE study_id = ? AND case_number "
                           "= ? AND revision = ?",
                           "iii", study, (int64_t)damaged->case_number, (int64_t)damaged->revision);
    if (status == 0 && sqlite3_changes(store->db) > 0)
        status = store_run(store, err,
                           "UPDATE study_case SET settled = 0 WHERE study_id = ? AND number = ? "
                           "AND publish_error IS NULL",
                           "ii", study, (int64_t)damaged->case_number);
    return change_end(store, status, err);
}
