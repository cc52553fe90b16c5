#include "schema/json/field.h"
#include "schema/result/result_json.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What all readers need: the result to fill, and the error. */
struct reading {
    struct case_result *result;
    struct error *err;
};

static int fault(const struct reading *reading, const char *key, const char *what) {
    return error_set(reading->err, ERROR_INPUT, "\"%s\" of a result must be %s", key, what);
}

static int no_memory(const struct reading *reading) {
    return error_set(reading->err, ERROR_MEMORY, "no memory left to read a result");
}

static int read_text(const struct reading *reading, const cJSON *object, const char *key,
                     const char **out) {
    const char *text = cJSON_GetStringValue(field_at(object, key));
    if (text == NULL)
        return fault(reading, key, "a string");
    *out = result_text(reading->result, text);
    return *out != NULL ? 0 : no_memory(reading);
}

/* Reads the array of `n` numbers or nulls under a key. */
static int read_numbers(const struct reading *reading, const cJSON *object, const char *key,
                        size_t n, const double **out) {
    const cJSON *array = field_at(object, key);
    if (!cJSON_IsArray(array) || (size_t)cJSON_GetArraySize(array) != n)
        return fault(reading, key, "an array as long as x");
    double *numbers = result_numbers(reading->result, n);
    if (numbers == NULL)
        return no_memory(reading);
    size_t a = 0;
    for (const cJSON *item = array->child; item != NULL; item = item->next)
        numbers[a++] = cJSON_IsNumber(item) ? item->valuedouble : (double)NAN;
    *out = numbers;
    return 0;
}

/* --- matrices --- */

/* Reads all cells of an array of rows. */
static int read_dense(const struct reading *reading, const cJSON *object, const char *key,
                      const struct curve *curve, double **out) {
    const cJSON *rows = field_at(object, key);
    if (!cJSON_IsArray(rows) || (size_t)cJSON_GetArraySize(rows) != curve->n)
        return fault(reading, key, "an array of as many rows as x");
    double *cells = result_numbers(reading->result, curve->n * curve->columns);
    if (cells == NULL)
        return no_memory(reading);
    size_t at = 0;
    for (const cJSON *row = rows->child; row != NULL; row = row->next) {
        if (!cJSON_IsArray(row) || (size_t)cJSON_GetArraySize(row) != curve->columns)
            return fault(reading, key, "rows as long as x2");
        for (const cJSON *item = row->child; item != NULL; item = item->next)
            cells[at++] = cJSON_IsNumber(item) ? item->valuedouble : (double)NAN;
    }
    *out = cells;
    return 0;
}

/* Keeps the cells that are not empty. Where the first cell is NaN, empty cells are NaN, else 0. */
static int read_matrix(const struct reading *reading, const cJSON *object, struct curve *curve) {
    double *y = NULL, *standard_error = NULL;
    int status = read_dense(reading, object, "y", curve, &y);
    if (status == 0)
        status = read_dense(reading, object, "standard_error", curve, &standard_error);
    if (status != 0)
        return status;
    size_t all = curve->n * curve->columns, count = 0;
    uint32_t *cells = result_room(reading->result, all > 0 ? all : 1, sizeof *cells);
    if (cells == NULL)
        return no_memory(reading);
    curve->empty_y = all > 0 && isnan(y[0]) ? (double)NAN : 0;
    curve->empty_standard_error = curve->empty_y;
    for (size_t cell = 0; cell < all; cell++) {
        if (!(y[cell] > 0) && !(y[cell] < 0)) {
            curve->empty_standard_error = standard_error[cell];
            continue;
        }
        y[count] = y[cell];
        standard_error[count] = standard_error[cell];
        cells[count++] = (uint32_t)cell;
    }
    curve->y = y;
    curve->standard_error = standard_error;
    curve->cells = cells;
    curve->cell_count = count;
    return 0;
}

/* --- a curve --- */

int curve_read_attributes(struct case_result *result, const cJSON *object, struct curve *curve,
                          struct error *err) {
    const struct reading reading = {result, err};
    for (size_t a = 0; a < CURVE_ATTRIBUTE_COUNT; a++) {
        const struct curve_attribute *row = &CURVE_ATTRIBUTES[a];
        const cJSON *value = field_at(object, row->key);
        const char *text = cJSON_GetStringValue(value);
        if (value != NULL && row->type == ATTRIBUTE_TEXT && text == NULL)
            return fault(&reading, row->key, "a string");
        const char *copy = result_text(result, text);
        if (text != NULL && copy == NULL)
            return no_memory(&reading);
        curve_set_attribute(curve, row, copy, field_number(object, row->key));
    }
    return curve->series != NULL ? 0 : fault(&reading, "series", "a string");
}

/* Reads a number for each value: for all points, or for the occupied cells of a matrix. */
static int read_values(const struct reading *reading, const cJSON *object, const char *key,
                       const struct curve *curve, const double **out) {
    double *dense = NULL;
    if (curve->columns == 0)
        return read_numbers(reading, object, key, curve->n, out);
    int status = read_dense(reading, object, key, curve, &dense);
    for (size_t a = 0; a < curve->cell_count && status == 0; a++)
        dense[a] = dense[curve->cells[a]];
    *out = dense;
    return status;
}

static int read_error(const struct reading *reading, const cJSON *object, enum error_source source,
                      struct curve *curve) {
    const struct error_source_row *row = &ERROR_SOURCE_ROWS[source];
    struct curve_error *error = &curve->errors[source];
    const cJSON *values = field_at(object, row->key);
    *error = (struct curve_error){.applies = values != NULL, .order = NAN};
    if (!cJSON_IsArray(values))
        return 0;
    int status = read_values(reading, object, row->key, curve, &error->value);
    if (status == 0 && field_at(object, row->bound_key) != NULL)
        status = read_values(reading, object, row->bound_key, curve, &error->bound);
    if (status == 0)
        status =
            read_values(reading, object, row->standard_error_key, curve, &error->standard_error);
    if (row->order_key != NULL) {
        const char *from = cJSON_GetStringValue(field_at(object, row->order_from_key));
        error->order = field_number(object, row->order_key);
        error->order_observed = from != NULL && strcmp(from, "levels") == 0;
    }
    return status;
}

static int read_law(const struct reading *reading, const cJSON *object, struct curve *curve) {
    if (!cJSON_IsArray(field_at(object, "law_difference")))
        return 0;
    int status = read_values(reading, object, "law_difference", curve, &curve->law_difference);
    return status != 0 ? status
                       : read_values(reading, object, "law_standard_error", curve,
                                     &curve->law_standard_error);
}

static int read_theories(const struct reading *reading, const cJSON *object, struct curve *curve) {
    const cJSON *theories = field_at(object, "theory");
    for (const cJSON *item = theories != NULL ? theories->child : NULL; item != NULL;
         item = item->next) {
        if (curve->theory_count == THEORIES_MOST || item->string == NULL)
            return fault(reading, "theory", "an object of few arrays");
        struct theory *theory = &curve->theories[curve->theory_count++];
        double *dense = NULL;
        int status = curve->columns > 0
                         ? read_dense(reading, theories, item->string, curve, &dense)
                         : read_numbers(reading, theories, item->string, curve->n, &theory->y);
        if (status != 0)
            return status;
        if (dense != NULL)
            theory->y = dense;
        theory->name = result_text(reading->result, item->string);
        if (theory->name == NULL)
            return no_memory(reading);
    }
    return 0;
}

/* Reads a unit; without a member there is none. */
static int read_unit(const struct reading *reading, const cJSON *object, const char *key,
                     struct physical_unit *out) {
    const cJSON *unit = field_at(object, key);
    if (unit == NULL)
        return 0;
    out->scale = field_number(unit, "scale");
    if (!(out->scale > 0 && isfinite(out->scale)))
        return fault(reading, key, "a unit with a scale above 0");
    int status = read_text(reading, unit, "unit", &out->unit);
    return status != 0 ? status : read_text(reading, unit, "symbol", &out->symbol);
}

static int read_units(const struct reading *reading, const cJSON *object, struct curve *curve) {
    int status = read_unit(reading, object, "x_unit", &curve->x_unit);
    if (status == 0)
        status = read_unit(reading, object, "x2_unit", &curve->x2_unit);
    return status != 0 ? status : read_unit(reading, object, "y_unit", &curve->y_unit);
}

static int read_points(const struct reading *reading, const cJSON *object, struct curve *curve) {
    const cJSON *x = field_at(object, "x"), *x2 = field_at(object, "x2");
    if (!cJSON_IsArray(x) || (x2 != NULL && !cJSON_IsArray(x2)))
        return fault(reading, "x", "an array");
    curve->n = (size_t)cJSON_GetArraySize(x);
    curve->columns = (size_t)cJSON_GetArraySize(x2);
    if (curve->columns > 0 && curve->n > UINT32_MAX / curve->columns)
        return fault(reading, "x2", "an array of a sensible length");
    int status = read_numbers(reading, object, "x", curve->n, &curve->x);
    if (status != 0)
        return status;
    if (curve->columns == 0) {
        status = read_numbers(reading, object, "y", curve->n, &curve->y);
        return status != 0 ? status
                           : read_numbers(reading, object, "standard_error", curve->n,
                                          &curve->standard_error);
    }
    status = read_numbers(reading, object, "x2", curve->columns, &curve->x2);
    if (status == 0)
        status = read_text(reading, object, "x2_label", &curve->x2_label);
    return status != 0 ? status : read_matrix(reading, object, curve);
}

static int read_difference(const struct reading *reading, const cJSON *object,
                           struct curve *curve) {
    int status = read_numbers(reading, object, "minuend", curve->n, &curve->minuend);
    curve->paired = cJSON_IsTrue(field_at(object, "paired"));
    return status != 0 ? status
                       : read_numbers(reading, object, "subtrahend", curve->n, &curve->subtrahend);
}

static int read_curve(const struct reading *reading, const cJSON *object) {
    struct curve curve = {0};
    int status = read_text(reading, object, "quantity", &curve.quantity);
    if (status == 0)
        status = read_text(reading, object, "x_label", &curve.x_label);
    if (status == 0)
        status = read_text(reading, object, "y_label", &curve.y_label);
    if (status == 0)
        status = curve_read_attributes(reading->result, object, &curve, reading->err);
    if (status == 0)
        status = read_points(reading, object, &curve);
    for (size_t s = 0; s < ERROR_SOURCES && status == 0; s++)
        status = read_error(reading, object, (enum error_source)s, &curve);
    if (status == 0)
        status = read_law(reading, object, &curve);
    if (status == 0 && cJSON_IsArray(field_at(object, EFFECTIVE_KEY)))
        status = read_values(reading, object, EFFECTIVE_KEY, &curve, &curve.effective);
    if (status == 0)
        status = read_theories(reading, object, &curve);
    if (status == 0 && field_at(object, "valueless") != NULL)
        status = read_numbers(reading, object, "valueless", curve.n, &curve.valueless);
    if (status == 0 && field_at(object, "minuend") != NULL)
        status = read_difference(reading, object, &curve);
    if (status == 0)
        status = read_units(reading, object, &curve);
    curve.counted = field_at(object, "underflow") != NULL;
    curve.underflow = field_number(object, "underflow");
    curve.overflow = field_number(object, "overflow");
    return status != 0 ? status : result_add_curve(reading->result, &curve, reading->err);
}

/* --- a case --- */

static void read_scalar_errors(const cJSON *object, struct scalar *scalar) {
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        const struct error_source_row *row = &ERROR_SOURCE_ROWS[s];
        double value = field_number(object, row->key);
        scalar->errors[s] =
            (struct scalar_error){.applies = field_at(object, row->key) != NULL,
                                  .known = !isnan(value),
                                  .value = value,
                                  .bound = field_number(object, row->bound_key),
                                  .standard_error = field_number(object, row->standard_error_key)};
    }
}

static int read_scalars(const struct reading *reading, const cJSON *scalars) {
    int status = 0;
    for (const cJSON *item = scalars != NULL ? scalars->child : NULL; item != NULL && status == 0;
         item = item->next) {
        struct scalar scalar = {.name = result_text(reading->result, item->string),
                                .value = field_number(item, "value"),
                                .standard_error = field_number(item, "standard_error"),
                                .theory = field_number(item, "theory"),
                                .grid = field_number(item, "grid_theory"),
                                .law_difference = field_number(item, "law_difference"),
                                .law_standard_error = field_number(item, "law_standard_error"),
                                .difference = field_at(item, "minuend") != NULL,
                                .paired = cJSON_IsTrue(field_at(item, "paired")),
                                .minuend = field_number(item, "minuend"),
                                .subtrahend = field_number(item, "subtrahend"),
                                .effective = fmax(0, field_number(item, EFFECTIVE_KEY))};
        read_scalar_errors(item, &scalar);
        if (scalar.name == NULL)
            return no_memory(reading);
        status = read_unit(reading, item, "unit", &scalar.unit);
        if (status == 0)
            status = result_add_scalar(reading->result, &scalar, reading->err);
    }
    return status;
}

int result_read_notes(struct case_result *result, const cJSON *notes, struct error *err) {
    const struct reading reading = {result, err};
    if (notes == NULL)
        return 0;
    const cJSON *kept = field_at(notes, "kept");
    size_t count = (size_t)cJSON_GetArraySize(kept), n = 0;
    double all = field_number(notes, "count");
    struct result_note *list = result_room(result, count + 1, sizeof *list);
    if (list == NULL)
        return no_memory(&reading);
    for (const cJSON *item = kept != NULL ? kept->child : NULL; item != NULL; item = item->next) {
        double realisation = field_number(item, "realisation");
        int status = read_text(&reading, item, "text", &list[n].text);
        if (status != 0)
            return status;
        list[n++].realisation =
            realisation >= 0 && realisation < 0x1p53 ? (uint64_t)realisation : 0;
    }
    result->notes = list;
    result->note_count = n;
    result->notes_all = all >= (double)n && all < 0x1p53 ? (uint64_t)all : n;
    return 0;
}

int result_read_error(struct case_result *result, const cJSON *error, struct error *err) {
    const struct reading reading = {result, err};
    const char *text = cJSON_GetStringValue(error);
    result->error = result_text(result, text);
    return text == NULL || result->error != NULL ? 0 : no_memory(&reading);
}

/* Reads an object of parameters as it was printed. */
int result_read_parameters(struct case_result *result, const cJSON *parameters, struct error *err) {
    const struct reading reading = {result, err};
    size_t count = (size_t)cJSON_GetArraySize(parameters);
    result->parameter_count = 0;
    result->parameters = result_room(result, count + 1, sizeof *result->parameters);
    if (result->parameters == NULL)
        return no_memory(&reading);
    for (const cJSON *item = parameters != NULL ? parameters->child : NULL; item != NULL;
         item = item->next)
        if (!result_add_parameter(result, item->string, item))
            return no_memory(&reading);
    return 0;
}

static int read_count(const struct reading *reading, const cJSON *document, const char *key,
                      uint64_t *out) {
    double number = field_number(document, key);
    if (!(number >= 0 && number <= 0x1p53 && number == floor(number)))
        return fault(reading, key, "an integer of 0 to 2^53");
    *out = (uint64_t)number;
    return 0;
}

int result_read(const cJSON *document, struct case_result *out, struct error *err) {
    struct case_result result = {0};
    struct reading reading = {&result, err};
    int status = read_count(&reading, document, "case", &result.case_number);
    if (status == 0)
        status = read_count(&reading, document, "realisations", &result.realisations);
    result.difference = field_at(document, "less") != NULL;
    if (status == 0 && result.difference)
        status = read_count(&reading, document, "less", &result.less);
    if (status == 0 && field_at(document, "remark") != NULL)
        status = read_text(&reading, document, "remark", &result.remark);
    if (status == 0)
        status = result_read_parameters(&result, field_at(document, "parameters"), err);
    if (status == 0)
        status = read_scalars(&reading, field_at(document, "scalars"));
    const cJSON *curves = field_at(document, "curves");
    for (const cJSON *item = curves != NULL ? curves->child : NULL; item != NULL && status == 0;
         item = item->next)
        status = read_curve(&reading, item);
    if (status == 0)
        status = result_read_notes(&result, field_at(document, "notes"), err);
    if (status == 0)
        status = result_read_error(&result, field_at(document, "error"), err);
    result_sampled(&result, result.realisations);
    if (status != 0) {
        result_clear(&result);
        return status;
    }
    *out = result;
    return 0;
}

/* Reads documents of results of studies; result_read.c reads their cases. */

static int read_cases(const cJSON *cases, struct study_result *study, struct error *err) {
    size_t count = (size_t)cJSON_GetArraySize(cases);
    study->cases = array_create(count, sizeof *study->cases);
    if (study->cases == NULL)
        return error_memory(err, count * sizeof *study->cases, "the results of a study");
    int status = 0;
    for (const cJSON *item = cases != NULL ? cases->child : NULL; item != NULL && status == 0;
         item = item->next) {
        status = result_read(item, &study->cases[study->case_count], err);
        study->case_count += status == 0;
    }
    return status;
}

int study_head_read(const cJSON *document, struct study_result *out, struct error *err) {
    const struct {
        const char *key;
        char **text;
    } texts[] = {{"study", &out->id},
                 {"name", &out->name},
                 {"kind", &out->kind},
                 {"state", &out->state},
                 {"random", &out->random}};
    for (size_t t = 0; t < sizeof texts / sizeof *texts; t++) {
        const char *text = cJSON_GetStringValue(field_at(document, texts[t].key));
        if (texts[t].text == &out->random && field_at(document, "random") == NULL)
            continue; /* of an older program */
        if (text == NULL)
            return error_set(err, ERROR_INPUT, "\"%s\" of a result must be a string", texts[t].key);
        *texts[t].text = strdup(text);
        if (*texts[t].text == NULL)
            return error_memory(err, strlen(text) + 1, "a text of a study");
    }
    const cJSON *swept = field_at(document, "swept");
    const cJSON *provenance = field_at(document, "provenance"); /* neither is of older programs */
    if (cJSON_IsArray(swept) && (out->swept = cJSON_Duplicate(swept, true)) == NULL)
        return error_memory(err, 0, "the swept parameters of a study");
    if (cJSON_IsObject(provenance) && (out->provenance = cJSON_Duplicate(provenance, true)) == NULL)
        return error_memory(err, 0, "the provenance of a study");
    return 0;
}

int study_result_read(const cJSON *document, struct study_result *out, struct error *err) {
    struct study_result study = {0};
    int status = study_head_read(document, &study, err);
    if (status == 0)
        status = read_cases(field_at(document, "cases"), &study, err);
    if (status != 0) {
        study_result_clear(&study);
        return status;
    }
    *out = study;
    return 0;
}
