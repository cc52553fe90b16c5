/* Reads the parameters, the stored blocks and the cost of a case. */
#include "schema/store/store_internal.h"
#include "schema/store/store_seal.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void case_info_clear(struct case_info *info) {
    cJSON_Delete(info->parameters);
    *info = (struct case_info){0};
}

int case_damaged(const char *study, uint64_t case_number, struct error *err) {
    return error_set(err, ERROR_INPUT,
                     "the parameters of case %llu of study %s are damaged in the database: their "
                     "checksum does not match; rugo repair puts them back",
                     (unsigned long long)case_number, study);
}

/* Says which cases there are. */
static int refuse_case(struct store *store, int64_t row, const char *study, uint64_t case_number,
                       struct error *err) {
    int64_t count = 0;
    int status = store_integer(
        store, &count, err, "SELECT count(*) FROM study_case WHERE study_id = ? AND parent IS NULL",
        "i", row);
    return status != 0 ? status
                       : error_set(err, ERROR_ABSENT,
                                   "study %s has no case %llu; it has %lld, from "
                                   "0 on",
                                   study, (unsigned long long)case_number, (long long)count);
}

/* components: those count as cases, too. */
static int read_case(struct store *store, const char *study, uint64_t case_number, bool components,
                     struct case_info *out, struct error *err) {
    int64_t row = 0;
    sqlite3_stmt *found = NULL;
    int status = study_row(store, study, &row, err);
    if (status == 0)
        status = store_query(
            store, &found, err,
            "SELECT study_case.parameters, s.seed, coalesce(study_case.realisations, "
            "s.realisations), study_case.realisations_done, study_case.revision, seal IS NULL OR "
            "seal = " CASE_SEAL " FROM study_case JOIN study s ON s.id = study_id WHERE s.id = ? "
            "AND number = ? AND (parent IS NULL OR ?)",
            "iii", row, (int64_t)case_number, (int64_t)components);
    if (status == 0)
        status = store_step(store, found, err);
    if (status == 0)
        return refuse_case(store, row, study, case_number, err);
    if (status < 0)
        return status;
    struct case_info info = {
        .seed = strtoull((const char *)sqlite3_column_text(found, 1), NULL, 10),
        .realisations = (uint64_t)sqlite3_column_int64(found, 2),
        .realisations_done = (uint64_t)sqlite3_column_int64(found, 3),
        .revision = (uint64_t)sqlite3_column_int64(found, 4),
    };
    status = sqlite3_column_int(found, 5) != 0 ? column_json(found, 0, &info.parameters, err)
                                               : case_damaged(study, case_number, err);
    sqlite3_reset(found);
    if (status == 0)
        *out = info;
    return status;
}

int store_case(struct store *store, const char *study, uint64_t case_number, struct case_info *out,
               struct error *err) {
    return read_case(store, study, case_number, false, out, err);
}

int store_any_case(struct store *store, const char *study, uint64_t case_number,
                   struct case_info *out, struct error *err) {
    return read_case(store, study, case_number, true, out, err);
}

/* --- partial results --- */

struct stored_block {
    cJSON *names, *rows;
    struct packed_bytes data; /* unpacked */
};

static void stored_block_clear(struct stored_block *block) {
    cJSON_Delete(block->names);
    cJSON_Delete(block->rows);
    packed_bytes_clear(&block->data);
}

static int fill_scalars(const struct stored_block *block, struct block_result *out,
                        struct error *err) {
    size_t count = out->scalar_count, rows = (size_t)out->count;
    const char **names = array_create(count, sizeof *names);
    double *scalars = array_create(count * rows, sizeof *scalars);
    out->names = names;
    out->scalars = scalars;
    if (names == NULL || scalars == NULL)
        return error_memory(err, count * rows * sizeof *scalars, "scalars");
    size_t n = 0, s = 0;
    for (const cJSON *name = block->names->child; name != NULL; name = name->next)
        names[n++] = cJSON_IsString(name) ? name->valuestring : "";
    for (const cJSON *row = block->rows->child; row != NULL; row = row->next)
        for (const cJSON *value = row->child; value != NULL && s < count * rows;
             value = value->next)
            scalars[s++] = cJSON_IsNumber(value) ? value->valuedouble : NAN;
    if (s != count * rows)
        return error_set(err, ERROR_INPUT, "a stored result has %zu scalars instead of %zu", s,
                         count * rows);
    return 0;
}

/* Reads a number; NULL becomes NaN. */
static double column_number(sqlite3_stmt *row, int column) {
    return sqlite3_column_type(row, column) == SQLITE_NULL ? (double)NAN
                                                           : sqlite3_column_double(row, column);
}

/* Compares the checksum of a block with what is stored of it, before that is unpacked; a block of
 * an older program has none. */
static int check_checksum(sqlite3_stmt *row, const struct block_result *result, struct error *err) {
    const char *names = (const char *)sqlite3_column_text(row, 2);
    const char *scalars = (const char *)sqlite3_column_text(row, 3);
    if (sqlite3_column_type(row, 7) == SQLITE_NULL)
        return 0;
    if (names != NULL && scalars != NULL &&
        block_seal(result, names, scalars) == sqlite3_column_int64(row, 7))
        return 0;
    return error_set(err, ERROR_INPUT,
                     "the stored result of realisations %llu to %llu is damaged: its checksum does "
                     "not match; rugo repair computes it anew",
                     (unsigned long long)result->first,
                     (unsigned long long)(result->first + result->count - 1));
}

static int read_block(sqlite3_stmt *row, struct stored_block *block, struct block_result *result,
                      struct error *err) {
    *result = (struct block_result){.first = (uint64_t)sqlite3_column_int64(row, 0),
                                    .count = (uint64_t)sqlite3_column_int64(row, 1),
                                    .data = sqlite3_column_blob(row, 4),
                                    .size = (size_t)sqlite3_column_bytes(row, 4),
                                    .seconds = sqlite3_column_double(row, 5),
                                    .cpu_seconds = column_number(row, 6)};
    int status = check_checksum(row, result, err);
    if (status == 0 && (status = bytes_unpack(&block->data, result->data, result->size, err)) != 0)
        error_context(err, "the stored result of realisations %llu to %llu",
                      (unsigned long long)result->first,
                      (unsigned long long)(result->first + result->count - 1));
    result->data = block->data.data;
    result->size = block->data.size;
    if (status == 0)
        status = column_json(row, 2, &block->names, err);
    if (status == 0)
        status = column_json(row, 3, &block->rows, err);
    result->scalar_count = status != 0 ? 0 : (size_t)cJSON_GetArraySize(block->names);
    if (status == 0)
        status = fill_scalars(block, result, err);
    return status;
}

int store_results(struct store *store, const char *study, uint64_t case_number, result_visit *visit,
                  void *context, struct error *err) {
    int64_t id = 0;
    sqlite3_stmt *row = NULL;
    int status = study_row(store, study, &id, err);
    if (status == 0)
        status = store_query(
            store, &row, err,
            "SELECT job.first, job.count, scalar_names.names, result.scalars, "
            "result.data, job.seconds, job.cpu_seconds, result.seal FROM job JOIN result ON "
            "result.job_id = job.id JOIN scalar_names ON scalar_names.id = result.names_id "
            "WHERE job.study_id = ? AND job.case_number = ? ORDER BY job.first",
            "ii", id, (int64_t)case_number);
    if (status != 0)
        return status;
    while ((status = store_step(store, row, err)) == 1) {
        struct stored_block block = {0};
        struct block_result result;
        status = read_block(row, &block, &result, err);
        if (status == 0)
            status = visit(context, &result, err);
        result.data = NULL; /* belongs to the row, or to `block` */
        block_result_clear(&result);
        stored_block_clear(&block);
        if (status != 0)
            break;
    }
    sqlite3_reset(row);
    return status;
}

/* --- cost --- */

int store_cost(struct store *store, const char *study, uint64_t case_number, struct case_cost *out,
               struct error *err) {
    int64_t id = 0;
    sqlite3_stmt *row = NULL;
    int status = study_row(store, study, &id, err);
    if (status == 0)
        status = store_query(
            store, &row, err,
            "SELECT realisations_done, coalesce(realisations, (SELECT nullif(realisations, 0) FROM "
            "study WHERE id = study_id), realisations_done), jobs, (SELECT total(attempts + "
            "losses) FROM "
            "job "
            "WHERE job.study_id = study_case.study_id AND job.case_number = number) + (SELECT "
            "total(j.attempts + j.losses) FROM study_case k INDEXED BY case_parent CROSS JOIN job "
            "j ON "
            "j.study_id = k.study_id AND "
            "j.case_number = k.number WHERE k.study_id = study_case.study_id AND k.parent = "
            "study_case.number), seconds, cpu_seconds, "
            "jobs_without_cpu FROM study_case WHERE study_id = ? AND number = ?",
            "ii", id, (int64_t)case_number);
    if (status == 0)
        status = store_step(store, row, err);
    if (status == 0)
        return refuse_case(store, id, study, case_number, err);
    if (status < 0)
        return status;
    *out = (struct case_cost){case_number,
                              (uint64_t)sqlite3_column_int64(row, 0),
                              (uint64_t)sqlite3_column_int64(row, 1),
                              (uint64_t)sqlite3_column_int64(row, 2),
                              (uint64_t)sqlite3_column_int64(row, 3),
                              {sqlite3_column_double(row, 4), sqlite3_column_double(row, 5),
                               (uint64_t)sqlite3_column_int64(row, 6)}};
    sqlite3_reset(row);
    return 0;
}

/* Cases that were computed without any value of any realisation. */

/* Cases of study ?1 that have curves, and no value on any of them. */
#define WITHOUT_VALUES "FROM published p WHERE p.study_id = ?1 AND p.valueless"

/* Reads the first note of the first such case. */
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
