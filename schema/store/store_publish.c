/* Publication: writes a case's result as rows for the views, its curves as bytes, its report as
 * JSON. */
#include "core/file/memory_file.h"
#include "schema/result/bytes/curve_bytes.h"
#include "schema/result/bytes/packed_bytes.h"
#include "schema/result/result_json.h"
#include "schema/result/total.h"
#include "schema/store/store_internal.h"
#include "schema/store/store_seal.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct target {
    struct store *store;
    int64_t study, case_number;
    const struct point_texts *points; /* NULL: none */
};

/* Runs a prepared statement with its bound values. */
static int run_bound(struct store *store, sqlite3_stmt *statement, struct error *err) {
    int status = store_step(store, statement, err);
    if (status > 0)
        sqlite3_reset(statement);
    return status < 0 ? status : 0;
}

/* Writes the names of the sources that a total leaves out, and returns them; NULL: none. */
static const char *names_or_null(const struct total *total, char names[TOTAL_NAMES_SIZE]) {
    total_unknown_names(total, names);
    return names[0] != '\0' ? names : NULL;
}

static int insert_scalar(const struct target *target, const struct scalar *scalar,
                         struct error *err) {
    const struct total total = scalar_total(scalar);
    char names[TOTAL_NAMES_SIZE];
    sqlite3_stmt *statement = NULL;
    int status = store_query(target->store, &statement, err,
                             "INSERT INTO scalar (study_id, case_number, name, value, "
                             "standard_error, theory, grid_theory, law_difference, "
                             "law_standard_error, total_low, total_high, unknown_errors) "
                             "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
                             "iitddddddddt", target->study, target->case_number, scalar->name,
                             scalar->value, scalar->standard_error, scalar->theory, scalar->grid,
                             scalar->law_difference, scalar->law_standard_error, total.low,
                             total.high, names_or_null(&total, names));
    if (status == 0)
        status = run_bound(target->store, statement, err);
    for (size_t s = 0; s < ERROR_SOURCES && status == 0; s++)
        if (scalar->errors[s].known)
            status = store_run(target->store, err,
                               "INSERT INTO scalar_error (study_id, case_number, name, source, "
                               "value, bound, standard_error) VALUES (?, ?, ?, ?, ?, ?, ?)",
                               "iittddd", target->study, target->case_number, scalar->name,
                               ERROR_SOURCE_ROWS[s].name, scalar->errors[s].value,
                               scalar->errors[s].bound, scalar->errors[s].standard_error);
    return status;
}

/* Inserts a point. SQLite turns NaN into NULL; x2 is NaN but for a matrix. */
static int insert_point(struct store *store, int64_t curve, size_t number, double x, double x2,
                        const struct curve *from, struct error *err) {
    const struct total total = curve_total(from, number);
    char names[TOTAL_NAMES_SIZE];
    sqlite3_stmt *statement = NULL;
    bool has_valueless = from->valueless != NULL && from->columns == 0;
    bool has_law = from->law_difference != NULL;
    int status = store_query(store, &statement, err,
                             "INSERT INTO point (curve_id, number, x, x2, y, standard_error, "
                             "valueless, law_difference, law_standard_error, total_low, "
                             "total_high, unknown_errors) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
                             "?)",
                             "iidddddddddt", curve, (int64_t)number, x, x2, from->y[number],
                             from->standard_error[number],
                             has_valueless ? from->valueless[number] : (double)NAN,
                             has_law ? from->law_difference[number] : (double)NAN,
                             has_law ? from->law_standard_error[number] : (double)NAN, total.low,
                             total.high, names_or_null(&total, names));
    return status != 0 ? status : run_bound(store, statement, err);
}

static int insert_error(struct store *store, int64_t curve, size_t number, const char *source,
                        const struct curve_error *error, struct error *err) {
    sqlite3_stmt *statement = NULL;
    int status = store_query(store, &statement, err,
                             "INSERT INTO point_error (curve_id, number, source, value, "
                             "standard_error, bound) VALUES (?, ?, ?, ?, ?, ?)",
                             "iitddd", curve, (int64_t)number, source, error->value[number],
                             error->standard_error[number],
                             error->bound != NULL ? error->bound[number] : (double)NAN);
    return status != 0 ? status : run_bound(store, statement, err);
}

/* Inserts the points of a curve; of a matrix only the occupied cells. */
static int insert_points(struct store *store, int64_t row, const struct curve *curve,
                         struct error *err) {
    int status = 0;
    bool matrix = curve->columns > 0;
    size_t count = curve_value_count(curve);
    for (size_t a = 0; a < count && status == 0; a++)
        status = insert_point(
            store, row, a, curve->x[matrix ? curve->cells[a] / curve->columns : a],
            matrix ? curve->x2[curve->cells[a] % curve->columns] : (double)NAN, curve, err);
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        for (size_t a = 0; a < count && curve->errors[s].value != NULL && status == 0; a++)
            status = insert_error(store, row, a, ERROR_SOURCE_ROWS[s].name, &curve->errors[s], err);
    return status;
}

/* Inserts the values of realisations at the points, where these are kept; none of a matrix. */
static int insert_realisations(const struct target *target, int64_t row, const struct curve *curve,
                               struct error *err) {
    const struct point_texts *points = target->points;
    int status = 0;
    for (size_t a = 0; a < curve->n && curve->columns == 0 && points != NULL && status == 0; a++) {
        char *text = NULL;
        status = points->make(points->context, curve, a, &text, err);
        if (status == 0 && text != NULL)
            status = store_run(target->store, err,
                               "INSERT INTO point_realisations (curve_id, number, y) VALUES (?, ?, "
                               "?)",
                               "iit", row, (int64_t)a, text);
        free(text);
    }
    return status;
}

/* Curves of one quantity, one after the other, share their x and more, and are packed together. In
 * all of them at most about so many numbers, far more than deflate looks back. */
enum { GROUP_NUMBERS = 1 << 16 };
/* The least bytes that are packed: fewer of curves are hardly made fewer. */
enum { GROUP_LEAST = 2048, REPORT_LEAST = 1024 };

/* Returns how many of the curves are stored together, in the row of the first. */
static size_t group_size(const struct curve *curves, size_t count) {
    size_t size = 1, numbers = curve_value_count(&curves[0]);
    while (size < count && numbers < GROUP_NUMBERS &&
           strcmp(curves[size].quantity, curves[0].quantity) == 0)
        numbers += curve_value_count(&curves[size++]);
    return size;
}

static int group_bytes(const struct curve *curves, size_t count, struct packed_bytes *out,
                       struct error *err) {
    unsigned char *data = NULL;
    size_t size = 0;
    int status = curves_encode(curves, count, &data, &size, err);
    if (status == 0)
        status = bytes_pack(out, data, size, GROUP_LEAST, err);
    if (status == 0 && out->owned == NULL)
        out->owned = data;
    else
        free(data);
    return status;
}

/* data: NULL for a curve that is stored in the row of another. */
static int insert_curve(const struct target *target, const struct curve *curve,
                        const struct packed_bytes *data, struct error *err) {
    sqlite3_stmt *statement = NULL;
    int status = store_query(
        target->store, &statement, err,
        "INSERT INTO curve (study_id, case_number, quantity, series, model, kinematics, level, "
        "pressure, data) VALUES (?, ?, ?, ?, ?, ?, ?, ?, iif(?10, ?9, NULL))",
        "iittttddbi", target->study, target->case_number, curve->quantity, curve->series,
        curve->model, curve->kinematics, curve->level, curve->pressure, (const void *)data->data,
        data->size, (int64_t)(data->data != NULL));
    if (status == 0)
        status = run_bound(target->store, statement, err);
    if (status != 0)
        return status;
    int64_t row = sqlite3_last_insert_rowid(target->store->db);
    status = insert_points(target->store, row, curve, err);
    return status != 0 ? status : insert_realisations(target, row, curve, err);
}

static int insert_group(const struct target *target, const struct curve *curves, size_t count,
                        struct error *err) {
    struct packed_bytes data = {0};
    const struct packed_bytes none = {0};
    int status = group_bytes(curves, count, &data, err);
    for (size_t a = 0; a < count && status == 0; a++)
        status = insert_curve(target, &curves[a], a == 0 ? &data : &none, err);
    packed_bytes_clear(&data);
    return status;
}

static int insert_curves(const struct target *target, const struct case_result *result,
                         struct error *err) {
    int status = 0;
    for (size_t a = 0, size; a < result->curve_count && status == 0; a += size) {
        size = group_size(&result->curves[a], result->curve_count - a);
        status = insert_group(target, &result->curves[a], size, err);
    }
    return status;
}

static int clear_case(const struct target *target, struct error *err) {
    int status =
        store_run(target->store, err, "DELETE FROM curve WHERE study_id = ? AND case_number = ?",
                  "ii", target->study, target->case_number);
    if (status == 0)
        status = store_run(target->store, err,
                           "DELETE FROM scalar WHERE study_id = ? AND case_number = ?", "ii",
                           target->study, target->case_number);
    if (status == 0)
        status = store_run(target->store, err,
                           "DELETE FROM scalar_error WHERE study_id = ? AND case_number = ?", "ii",
                           target->study, target->case_number);
    return status;
}

/* Whether case ?2 of study ?1 has curves, and no value on any of them. */
#define VALUELESS                                                                                  \
    "EXISTS (SELECT 1 FROM curve WHERE study_id = ?1 AND case_number = ?2) AND NOT EXISTS "        \
    "(SELECT "                                                                                     \
    "1 FROM curve c JOIN point t ON t.curve_id = c.id WHERE c.study_id = ?1 AND c.case_number = "  \
    "?2 "                                                                                          \
    "AND t.y IS NOT NULL)"

/* The texts of a case that are published. */
struct case_texts {
    uint64_t revision;
    const struct case_result *result;
    char *document, *report; /* owned */
};

/* Prints the result without its curves, and its report as if the case had taken one second. The
 * reader multiplies these seconds, since they change when a case goes on. */
static int case_texts_print(struct case_texts *out, struct error *err) {
    struct case_result head = *out->result;
    struct case_report report;
    struct memory_file file;
    int status = case_report_make(&report, out->result, err);
    if (status != 0)
        return status;
    head.curve_count = head.parameter_count = report.about.parameter_count = 0;
    bool done = memory_file_open(&file);
    if (done) {
        done = result_print(file.file, &head);
        out->document = memory_file_close(&file, NULL);
    }
    done = done && memory_file_open(&file);
    if (done) {
        done = case_report_print(file.file, &report);
        out->report = memory_file_close(&file, NULL);
    }
    case_report_clear(&report);
    return done && out->document != NULL && out->report != NULL
               ? 0
               : error_set(err, ERROR_MEMORY, "no memory left to publish a case");
}

/* A report below its bound, or that is not made smaller, is a TEXT; a packed one is a BLOB. */
static int insert_published(const struct target *target, const struct case_texts *texts,
                            struct error *err) {
    static const char SQL[] =
        "INSERT OR REPLACE INTO published (study_id, case_number, revision, document, report, "
        "curves_seal, rows_seal, seal, valueless) VALUES (?1, ?2, ?3, ?4, ?5, " CURVES_SEAL
        ", " ROWS_SEAL ", seal_of(?1, ?2, ?3, ?4, ?5, " CURVES_SEAL "), " VALUELESS ")";
    struct packed_bytes report = {0};
    int status = bytes_pack(&report, texts->report, strlen(texts->report), REPORT_LEAST, err);
    if (status == 0)
        status =
            report.owned != NULL
                ? store_run(target->store, err, SQL, "iiitb", target->study, target->case_number,
                            (int64_t)texts->revision, texts->document, (const void *)report.data,
                            report.size)
                : store_run(target->store, err, SQL, "iiitt", target->study, target->case_number,
                            (int64_t)texts->revision, texts->document, texts->report);
    packed_bytes_clear(&report);
    return status;
}

static int write_case(const struct target *target, const struct case_texts *texts,
                      struct error *err) {
    const struct case_result *result = texts->result;
    int status = clear_case(target, err);
    for (size_t s = 0; s < result->scalar_count && status == 0; s++)
        status = insert_scalar(target, &result->scalars[s], err);
    if (status == 0)
        status = insert_curves(target, result, err);
    if (status == 0)
        status = insert_published(target, texts, err);
    return status;
}

static int publish(struct target *target, const char *study, const struct case_texts *texts,
                   struct error *err) {
    int64_t known = -1;
    int status = study_row(target->store, study, &target->study, err);
    if (status == 0)
        status =
            store_integer(target->store, &known, err,
                          "SELECT revision FROM published WHERE study_id = ? AND case_number = ?",
                          "ii", target->study, target->case_number);
    if (status == ERROR_ABSENT && target->study != 0)
        status = 0;
    if (status == 0 && known < (int64_t)texts->revision)
        status = write_case(target, texts, err);
    if (status == 0)
        status = case_settle(target->store, target->study, target->case_number,
                             (int64_t)texts->revision, err);
    return status;
}

int store_publish_points(struct store *store, const char *study, uint64_t case_number,
                         uint64_t revision, const struct case_result *result,
                         const struct point_texts *points, struct error *err) {
    struct target target = {store, 0, (int64_t)case_number, points};
    struct case_texts texts = {.revision = revision, .result = result};
    int status = case_texts_print(&texts, err);
    if (status == 0)
        status = change_begin(store, err);
    if (status == 0) {
        status = publish(&target, study, &texts, err);
        status = change_end(store, status, err);
    }
    free(texts.document);
    free(texts.report);
    return status;
}

int store_publish(struct store *store, const char *study, uint64_t case_number, uint64_t revision,
                  const struct case_result *result, struct error *err) {
    return store_publish_points(store, study, case_number, revision, result, NULL, err);
}
