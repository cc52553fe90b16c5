/* Partial results out, published curves in and out. */
#include "schema/store/store_internal.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void case_info_clear(struct case_info *info) {
    cJSON_Delete(info->parameters);
    *info = (struct case_info){0};
}

static int parse_column(sqlite3_stmt *row, int column, const struct json_limits *limits,
                        cJSON **out, struct error *err) {
    const char *text = (const char *)sqlite3_column_text(row, column);
    size_t size = (size_t)sqlite3_column_bytes(row, column);
    int status = json_parse(text ? text : "", size, limits, out, err);
    return status ? error_context(err, "the database holds malformed JSON") : 0;
}

int store_case(struct store *store, const char *study, uint64_t case_number, struct case_info *out,
               struct error *err) {
    int64_t row = 0;
    sqlite3_stmt *found = NULL;
    int status = study_row(store, study, &row, err);
    if (!status)
        status = store_query(store, &found, err,
                             "SELECT c.parameters, s.seed, s.realisations, c.realisations_done, "
                             "c.revision FROM study_case c JOIN study s ON s.id = c.study_id WHERE "
                             "s.id = ? AND c.number = ?",
                             "ii", row, (int64_t)case_number);
    if (!status)
        status = store_step(store, found, err);
    if (status == 0)
        return error_set(err, ERROR_ABSENT, "study %s has no case %llu", study,
                         (unsigned long long)case_number);
    if (status < 0)
        return status;
    struct case_info info = {
        .seed = strtoull((const char *)sqlite3_column_text(found, 1), NULL, 10),
        .realisations = (uint64_t)sqlite3_column_int64(found, 2),
        .realisations_done = (uint64_t)sqlite3_column_int64(found, 3),
        .revision = (uint64_t)sqlite3_column_int64(found, 4),
    };
    status = parse_column(found, 0, NULL, &info.parameters, err);
    sqlite3_reset(found);
    if (!status)
        *out = info;
    return status;
}

/* --- partial results --- */

/* A stored block may hold more numbers than a study may. */
static const struct json_limits RESULT_LIMITS = {.bytes = SIZE_MAX, .depth = 8, .values = SIZE_MAX};

struct stored_block {
    cJSON *names, *rows;
    const char **name_list;
    double *scalars;
};

static void stored_block_clear(struct stored_block *block) {
    cJSON_Delete(block->names);
    cJSON_Delete(block->rows);
    free(block->name_list);
    free(block->scalars);
}

static int fill_scalars(struct stored_block *block, size_t count, size_t rows, struct error *err) {
    block->name_list = array_create(count, sizeof *block->name_list);
    block->scalars = array_create(count * rows, sizeof *block->scalars);
    if (!block->name_list || !block->scalars)
        return error_memory(err, count * rows * sizeof *block->scalars, "scalars");
    size_t n = 0, s = 0;
    for (const cJSON *name = block->names->child; name; name = name->next)
        block->name_list[n++] = cJSON_IsString(name) ? name->valuestring : "";
    for (const cJSON *row = block->rows->child; row; row = row->next)
        for (const cJSON *value = row->child; value && s < count * rows; value = value->next)
            block->scalars[s++] = cJSON_IsNumber(value) ? value->valuedouble : NAN;
    if (s != count * rows)
        return error_set(err, ERROR_SYSTEM, "a stored result has %zu scalars instead of %zu", s,
                         count * rows);
    return 0;
}

static int read_block(sqlite3_stmt *row, struct stored_block *block, struct block_result *result,
                      struct error *err) {
    int status = parse_column(row, 2, &RESULT_LIMITS, &block->names, err);
    if (!status)
        status = parse_column(row, 3, &RESULT_LIMITS, &block->rows, err);
    size_t count = status ? 0 : (size_t)cJSON_GetArraySize(block->names);
    *result = (struct block_result){.first = (uint64_t)sqlite3_column_int64(row, 0),
                                    .count = (uint64_t)sqlite3_column_int64(row, 1),
                                    .scalar_count = count,
                                    .data = sqlite3_column_blob(row, 4),
                                    .size = (size_t)sqlite3_column_bytes(row, 4),
                                    .seconds = sqlite3_column_double(row, 5)};
    if (!status)
        status = fill_scalars(block, count, (size_t)result->count, err);
    result->names = block->name_list;
    result->scalars = block->scalars;
    return status;
}

int store_results(struct store *store, const char *study, uint64_t case_number, result_visit *visit,
                  void *context, struct error *err) {
    int64_t id = 0;
    sqlite3_stmt *row = NULL;
    int status = study_row(store, study, &id, err);
    if (!status)
        status = store_query(store, &row, err,
                             "SELECT job.first, job.count, scalar_names.names, result.scalars, "
                             "result.data, job.seconds FROM job JOIN result ON result.job_id = "
                             "job.id JOIN scalar_names ON scalar_names.id = result.names_id "
                             "WHERE job.study_id = ? AND job.case_number = ? ORDER BY job.first",
                             "ii", id, (int64_t)case_number);
    if (status)
        return status;
    while ((status = store_step(store, row, err)) == 1) {
        struct stored_block block = {0};
        struct block_result result;
        status = read_block(row, &block, &result, err);
        if (!status)
            status = visit(context, &result, err);
        stored_block_clear(&block);
        if (status)
            break;
    }
    sqlite3_reset(row);
    return status;
}

/* --- publication --- */

/* A number of a document, or NULL for SQL where it is null or missing. */
static int bind_number(sqlite3_stmt *statement, int column, const cJSON *value) {
    return cJSON_IsNumber(value) ? sqlite3_bind_double(statement, column, value->valuedouble)
                                 : sqlite3_bind_null(statement, column);
}

static int run_bound(struct store *store, sqlite3_stmt *statement, struct error *err) {
    int status = store_step(store, statement, err);
    if (status > 0)
        sqlite3_reset(statement);
    return status < 0 ? status : 0;
}

struct target {
    struct store *store;
    int64_t study, case_number;
};

static int insert_scalar(const struct target *target, const cJSON *scalar, struct error *err) {
    sqlite3_stmt *statement = NULL;
    int status =
        store_query(target->store, &statement, err,
                    "INSERT INTO scalar (study_id, case_number, name, value, standard_error, "
                    "theory) VALUES (?, ?, ?, ?4, ?5, ?6)",
                    "iit", target->study, target->case_number, scalar->string);
    static const char *const FIELDS[] = {"value", "standard_error", "theory"};
    for (int f = 0; !status && f < 3; f++)
        if (bind_number(statement, 4 + f, cJSON_GetObjectItemCaseSensitive(scalar, FIELDS[f])))
            status = store_error(target->store, err);
    return status ? status : run_bound(target->store, statement, err);
}

/* Values of a point, in the order of its columns. */
enum { POINT_X, POINT_X2, POINT_Y, POINT_VALUES = 7 };
static const char *const POINT_KEYS[POINT_VALUES] = {
    "x", "x2", "y", "standard_error", "discretisation_error", "model_error", "valueless"};

static int insert_point(struct store *store, int64_t curve, int64_t number,
                        const cJSON *const values[POINT_VALUES], struct error *err) {
    sqlite3_stmt *statement = NULL;
    int status =
        store_query(store, &statement, err,
                    "INSERT INTO point (curve_id, number, x, x2, y, standard_error, "
                    "discretisation_error, model_error, valueless) VALUES (?1, ?2, ?3, ?4, "
                    "?5, ?6, ?7, ?8, ?9)",
                    "ii", curve, number);
    for (int v = 0; !status && v < POINT_VALUES; v++)
        if (bind_number(statement, 3 + v, values[v]))
            status = store_error(store, err);
    return status ? status : run_bound(store, statement, err);
}

static const cJSON *next_of(const cJSON *item) {
    return item ? item->next : NULL;
}

static const cJSON *first_of(const cJSON *object, const char *name) {
    const cJSON *array = cJSON_GetObjectItemCaseSensitive(object, name);
    return cJSON_IsArray(array) ? array->child : NULL;
}

/* A row of a matrix: only its non-zero cells become points. */
static int insert_row(struct store *store, int64_t curve, int64_t *number,
                      const cJSON *const row[POINT_VALUES], struct error *err) {
    const cJSON *cell[POINT_VALUES];
    int status = 0;
    for (int v = 0; v < POINT_VALUES; v++)
        cell[v] = v < POINT_Y ? row[v] : cJSON_IsArray(row[v]) ? row[v]->child : NULL;
    while (!status && cell[POINT_Y] && cell[POINT_X2]) {
        if (cJSON_IsNumber(cell[POINT_Y]) && cell[POINT_Y]->valuedouble != 0)
            status = insert_point(store, curve, (*number)++, cell, err);
        for (int v = POINT_X2; v < POINT_VALUES; v++)
            cell[v] = next_of(cell[v]);
    }
    return status;
}

static int insert_points(struct store *store, int64_t curve, const cJSON *document,
                         struct error *err) {
    const cJSON *point[POINT_VALUES];
    int64_t number = 0;
    int status = 0;
    for (int v = 0; v < POINT_VALUES; v++)
        point[v] = first_of(document, POINT_KEYS[v]);
    while (!status && point[POINT_X] && point[POINT_Y]) {
        if (cJSON_IsArray(point[POINT_Y]))
            status = insert_row(store, curve, &number, point, err);
        else
            status = insert_point(store, curve, number++, point, err);
        for (int v = 0; v < POINT_VALUES; v++)
            point[v] = v == POINT_X2 ? point[v] : next_of(point[v]);
    }
    return status;
}

static const char *text_of(const cJSON *object, const char *name, const char *otherwise) {
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object, name);
    return cJSON_IsString(value) ? value->valuestring : otherwise;
}

static int insert_curve(const struct target *target, const cJSON *document, struct error *err) {
    sqlite3_stmt *statement = NULL;
    int status = store_query(
        target->store, &statement, err,
        "INSERT INTO curve (study_id, case_number, quantity, series, model, kinematics, "
        "level, pressure) VALUES (?, ?, ?, ?, ?, ?, ?7, ?8)",
        "iitttt", target->study, target->case_number, text_of(document, "quantity", ""),
        text_of(document, "series", ""), text_of(document, "model", NULL),
        text_of(document, "kinematics", NULL));
    if (!status &&
        (bind_number(statement, 7, cJSON_GetObjectItemCaseSensitive(document, "level")) ||
         bind_number(statement, 8, cJSON_GetObjectItemCaseSensitive(document, "pressure"))))
        status = store_error(target->store, err);
    if (!status)
        status = run_bound(target->store, statement, err);
    int64_t curve = sqlite3_last_insert_rowid(target->store->db);
    return status ? status : insert_points(target->store, curve, document, err);
}

static int clear_case(const struct target *target, struct error *err) {
    int status =
        store_run(target->store, err, "DELETE FROM curve WHERE study_id = ? AND case_number = ?",
                  "ii", target->study, target->case_number);
    if (!status)
        status = store_run(target->store, err,
                           "DELETE FROM scalar WHERE study_id = ? AND case_number = ?", "ii",
                           target->study, target->case_number);
    return status;
}

static int write_case(const struct target *target, uint64_t revision, const cJSON *curves,
                      const char *text, struct error *err) {
    int status = clear_case(target, err);
    const cJSON *scalars = cJSON_GetObjectItemCaseSensitive(curves, "scalars");
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(curves, "curves");
    for (const cJSON *s = scalars ? scalars->child : NULL; !status && s; s = s->next)
        status = insert_scalar(target, s, err);
    for (const cJSON *c = list ? list->child : NULL; !status && c; c = c->next)
        status = insert_curve(target, c, err);
    if (!status)
        status = store_run(
            target->store, err,
            "INSERT OR REPLACE INTO published (study_id, case_number, revision, document) "
            "VALUES (?, ?, ?, ?)",
            "iiit", target->study, target->case_number, (int64_t)revision, text);
    return status;
}

int store_publish(struct store *store, const char *study, uint64_t case_number, uint64_t revision,
                  const cJSON *curves, struct error *err) {
    struct target target = {store, 0, (int64_t)case_number};
    int64_t known = -1;
    char *text = json_print(curves);
    if (!text)
        return error_memory(err, 0, "a document of curves");
    int status = change_begin(store, err);
    if (status) {
        free(text);
        return status;
    }
    status = study_row(store, study, &target.study, err);
    if (!status)
        status =
            store_integer(store, &known, err,
                          "SELECT revision FROM published WHERE study_id = ? AND case_number = ?",
                          "ii", target.study, target.case_number);
    if (status == ERROR_ABSENT && target.study)
        status = 0;
    if (!status && known < (int64_t)revision)
        status = write_case(&target, revision, curves, text, err);
    free(text);
    return change_end(store, status, err);
}

int store_published(struct store *store, const char *study, uint64_t case_number, uint64_t revision,
                    cJSON **out, struct error *err) {
    int64_t id = 0;
    sqlite3_stmt *row = NULL;
    int status = study_row(store, study, &id, err);
    if (!status)
        status =
            store_query(store, &row, err,
                        "SELECT document FROM published WHERE study_id = ? AND case_number = ? "
                        "AND revision = ?",
                        "iii", id, (int64_t)case_number, (int64_t)revision);
    if (!status)
        status = store_step(store, row, err);
    if (status < 0)
        return status;
    *out = NULL;
    if (status == 0)
        return 0;
    status = parse_column(row, 0, &RESULT_LIMITS, out, err);
    sqlite3_reset(row);
    return status;
}

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

/* --- cost --- */

int store_cost(struct store *store, const char *study, uint64_t case_number, struct case_cost *out,
               struct error *err) {
    int64_t id = 0;
    sqlite3_stmt *row = NULL;
    int status = study_row(store, study, &id, err);
    if (!status)
        status = store_query(store, &row, err,
                             "SELECT realisations_done, (SELECT realisations FROM study WHERE id = "
                             "study_id), jobs, (SELECT sum(attempts) FROM job WHERE job.study_id "
                             "= study_case.study_id AND job.case_number = number), seconds FROM "
                             "study_case WHERE study_id = ? AND number = ?",
                             "ii", id, (int64_t)case_number);
    if (!status)
        status = store_step(store, row, err);
    if (status == 0)
        return error_set(err, ERROR_ABSENT, "study %s has no case %llu", study,
                         (unsigned long long)case_number);
    if (status < 0)
        return status;
    *out = (struct case_cost){case_number,
                              (uint64_t)sqlite3_column_int64(row, 0),
                              (uint64_t)sqlite3_column_int64(row, 1),
                              (uint64_t)sqlite3_column_int64(row, 2),
                              (uint64_t)sqlite3_column_int64(row, 3),
                              sqlite3_column_double(row, 4)};
    sqlite3_reset(row);
    return 0;
}
