/* Publication: the curves of a case, as rows for the views and as a document. */
#include "schema/store/store_internal.h"
#include <stdlib.h>

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
    if (status == 0)
        status = case_settle(store, target.study, target.case_number, (int64_t)revision, err);
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
    status = column_json(row, 0, out, err);
    sqlite3_reset(row);
    return status;
}
