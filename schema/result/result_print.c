#include "schema/result/result_json.h"
#include "schema/result/total.h"
#include <math.h>
#include <stdlib.h>

/* Prints "key": with a comma before it, but for the first member of an object. */
static bool put_key(FILE *file, bool *first, const char *key) {
    if (!*first)
        fputc(',', file);
    *first = false;
    bool done = json_print_text(file, key);
    fputc(':', file);
    return done;
}

static bool put_text(FILE *file, bool *first, const char *key, const char *text) {
    return put_key(file, first, key) && json_print_text(file, text);
}

static bool put_number(FILE *file, bool *first, const char *key, double number) {
    bool done = put_key(file, first, key);
    json_print_number(file, number);
    return done;
}

static bool put_flag(FILE *file, bool *first, const char *key, bool flag) {
    bool done = put_key(file, first, key);
    fputs(flag ? "true" : "false", file);
    return done;
}

static void print_numbers(FILE *file, size_t n, const double *numbers) {
    fputc('[', file);
    for (size_t a = 0; a < n; a++) {
        if (a > 0)
            fputc(',', file);
        json_print_number(file, numbers[a]);
    }
    fputc(']', file);
}

static bool put_numbers(FILE *file, bool *first, const char *key, size_t n, const double *numbers) {
    bool done = put_key(file, first, key);
    print_numbers(file, n, numbers);
    return done;
}

/* Prints a matrix by its occupied cells; every other cell is `empty`. */
static void print_cells(FILE *file, const struct curve *curve, const double *values, double empty) {
    size_t at = 0;
    fputc('[', file);
    for (size_t row = 0; row < curve->n; row++) {
        fputs(row > 0 ? ",[" : "[", file);
        for (size_t column = 0; column < curve->columns; column++) {
            bool here = at < curve->cell_count && curve->cells[at] == row * curve->columns + column;
            if (column > 0)
                fputc(',', file);
            json_print_number(file, here ? values[at] : empty);
            at += here;
        }
        fputc(']', file);
    }
    fputc(']', file);
}

static bool put_values(FILE *file, bool *first, const char *key, const struct curve *curve,
                       const double *values, double empty) {
    if (curve->columns == 0)
        return put_numbers(file, first, key, curve->n, values);
    bool done = put_key(file, first, key);
    print_cells(file, curve, values, empty);
    return done;
}

/* --- a curve --- */

/* Returns attribute n of all, or of those that have a column; NULL behind the last one. */
static const struct curve_attribute *attribute_at(size_t n, bool all) {
    if (!all)
        return curve_column(n);
    return n < CURVE_ATTRIBUTE_COUNT ? &CURVE_ATTRIBUTES[n] : NULL;
}

bool curve_print_attributes(FILE *file, const struct curve *curve, bool all) {
    const struct curve_attribute *row;
    bool done = true, first = false;
    for (size_t n = 0; done && (row = attribute_at(n, all)) != NULL; n++) {
        const char *text = curve_attribute_text(curve, row);
        double number = curve_attribute_number(curve, row);
        if (text != NULL)
            done = put_text(file, &first, row->key, text);
        else if (!isnan(number))
            done = put_number(file, &first, row->key, number);
    }
    return done;
}

/* Prints what is known of a unit. */
static bool put_unit(FILE *file, bool *first, const char *key, const struct physical_unit *unit) {
    bool none = true;
    if (unit->unit == NULL)
        return true;
    bool done = put_key(file, first, key);
    fputc('{', file);
    done = done && put_text(file, &none, "unit", unit->unit) &&
           put_text(file, &none, "symbol", unit->symbol) &&
           put_number(file, &none, "scale", unit->scale);
    fputc('}', file);
    return done;
}

static bool put_error(FILE *file, bool *first, const struct curve *curve,
                      enum error_source source) {
    const struct error_source_row *row = &ERROR_SOURCE_ROWS[source];
    const struct curve_error *error = &curve->errors[source];
    if (!error->applies)
        return true;
    if (error->value == NULL)
        return put_number(file, first, row->key, NAN);
    bool done = put_values(file, first, row->key, curve, error->value, NAN) &&
                (error->bound == NULL ||
                 put_values(file, first, row->bound_key, curve, error->bound, NAN)) &&
                put_values(file, first, row->standard_error_key, curve, error->standard_error, NAN);
    if (done && row->order_key != NULL && !isnan(error->order))
        done = put_number(file, first, row->order_key, error->order) &&
               put_text(file, first, row->order_from_key,
                        error->order_observed ? "levels" : "assumed");
    return done;
}

/* Prints the sources that are not known, an array of their names. */
static bool put_unknown(FILE *file, bool *first, const bool unknown[UNKNOWN_SOURCES]) {
    bool done = put_key(file, first, "unknown_errors"), none = true;
    fputc('[', file);
    for (size_t s = 0; s < UNKNOWN_SOURCES && done; s++) {
        if (!unknown[s])
            continue;
        fputs(none ? "" : ",", file);
        none = false;
        done = json_print_text(file, unknown_source_name(s));
    }
    fputc(']', file);
    return done;
}

/* Prints the ends of the total intervals, which are computed here and not kept; empty cells have
 * none. */
static bool put_totals(FILE *file, bool *first, const struct curve *curve) {
    size_t count = curve_value_count(curve);
    double *low = array_create(count + 1, 2 * sizeof *low);
    bool unknown[UNKNOWN_SOURCES];
    if (low == NULL)
        return false;
    double *high = low + count;
    for (size_t a = 0; a < count; a++) {
        const struct total total = curve_total(curve, a);
        low[a] = total.low;
        high[a] = total.high;
    }
    curve_unknown(curve, unknown);
    bool done = put_values(file, first, "total_low", curve, low, NAN) &&
                put_values(file, first, "total_high", curve, high, NAN) &&
                put_unknown(file, first, unknown);
    free(low);
    return done;
}

static bool put_theories(FILE *file, bool *first, const struct curve *curve) {
    bool done = put_key(file, first, "theory"), none = true;
    fputc('{', file);
    for (size_t t = 0; t < curve->theory_count && done; t++) {
        const struct theory *theory = &curve->theories[t];
        if (theory->y == NULL)
            continue;
        if (curve->columns == 0) {
            done = put_numbers(file, &none, theory->name, curve->n, theory->y);
            continue;
        }
        done = put_key(file, &none, theory->name);
        fputc('[', file);
        for (size_t row = 0; row < curve->n; row++) {
            if (row > 0)
                fputc(',', file);
            print_numbers(file, curve->columns, theory->y + row * curve->columns);
        }
        fputc(']', file);
    }
    fputc('}', file);
    return done;
}

static bool print_curve(FILE *file, const struct curve *curve) {
    bool first = true;
    fputc('{', file);
    bool done =
        put_text(file, &first, "quantity", curve->quantity) &&
        curve_print_attributes(file, curve, true) &&
        put_numbers(file, &first, "x", curve->n, curve->x) &&
        (curve->columns == 0 || put_numbers(file, &first, "x2", curve->columns, curve->x2)) &&
        put_values(file, &first, "y", curve, curve->y, curve->empty_y) &&
        put_values(file, &first, "standard_error", curve, curve->standard_error,
                   curve->empty_standard_error);
    for (size_t s = 0; s < ERROR_SOURCES && done; s++)
        done = put_error(file, &first, curve, (enum error_source)s);
    if (done && curve->effective != NULL)
        done = put_values(file, &first, EFFECTIVE_KEY, curve, curve->effective, NAN);
    done = done && put_totals(file, &first, curve);
    if (done && curve->law_difference != NULL)
        done =
            put_values(file, &first, "law_difference", curve, curve->law_difference, NAN) &&
            put_values(file, &first, "law_standard_error", curve, curve->law_standard_error, NAN);
    done = done && put_theories(file, &first, curve) &&
           put_text(file, &first, "x_label", curve->x_label) &&
           (curve->columns == 0 || put_text(file, &first, "x2_label", curve->x2_label));
    if (done && curve->counted)
        done = put_number(file, &first, "underflow", curve->underflow) &&
               put_number(file, &first, "overflow", curve->overflow);
    if (done && curve->valueless != NULL)
        done = put_numbers(file, &first, "valueless", curve->n, curve->valueless);
    done = done && put_text(file, &first, "y_label", curve->y_label);
    if (done && curve->minuend != NULL)
        done = put_numbers(file, &first, "minuend", curve->n, curve->minuend) &&
               put_numbers(file, &first, "subtrahend", curve->n, curve->subtrahend) &&
               put_flag(file, &first, "paired", curve->paired);
    done = done && put_unit(file, &first, "x_unit", &curve->x_unit) &&
           put_unit(file, &first, "x2_unit", &curve->x2_unit) &&
           put_unit(file, &first, "y_unit", &curve->y_unit);
    fputc('}', file);
    return done;
}

/* --- a case --- */

bool result_print_parameters(FILE *file, size_t count, const struct result_parameter *parameters) {
    bool done = true, first = true;
    fputc('{', file);
    for (size_t p = 0; p < count && done; p++) {
        const struct result_parameter *one = &parameters[p];
        if (one->text == NULL) {
            done = put_number(file, &first, one->pointer, one->number);
        } else if (one->list || one->flag) {
            done = put_key(file, &first, one->pointer);
            fputs(one->text, file);
        } else {
            done = put_text(file, &first, one->pointer, one->text);
        }
    }
    fputc('}', file);
    return done;
}

bool result_print_notes(FILE *file, uint64_t all, size_t count, const struct result_note *notes) {
    bool done = true;
    fprintf(file, "{\"count\":%llu,\"kept\":[", (unsigned long long)all);
    for (size_t n = 0; n < count && done; n++) {
        fprintf(file, "%s{\"realisation\":%llu,\"text\":", n > 0 ? "," : "",
                (unsigned long long)notes[n].realisation);
        done = json_print_text(file, notes[n].text);
        fputc('}', file);
    }
    fputs("]}", file);
    return done;
}

static bool put_scalar_error(FILE *file, bool *first, const struct scalar_error *error,
                             const struct error_source_row *row) {
    if (!error->applies)
        return true;
    if (!error->known)
        return put_number(file, first, row->key, NAN);
    return put_number(file, first, row->key, error->value) &&
           put_number(file, first, row->bound_key, error->bound) &&
           put_number(file, first, row->standard_error_key, error->standard_error);
}

static bool print_scalar(FILE *file, const struct scalar *scalar) {
    bool first = true;
    fputc('{', file);
    bool done = put_number(file, &first, "value", scalar->value) &&
                put_number(file, &first, "standard_error", scalar->standard_error) &&
                (isnan(scalar->theory) || put_number(file, &first, "theory", scalar->theory)) &&
                (isnan(scalar->grid) || put_number(file, &first, "grid_theory", scalar->grid));
    if (done && scalar->effective > 0)
        done = put_number(file, &first, EFFECTIVE_KEY, scalar->effective);
    for (size_t s = 0; s < ERROR_SOURCES && done; s++)
        done = put_scalar_error(file, &first, &scalar->errors[s], &ERROR_SOURCE_ROWS[s]);
    const struct total total = scalar_total(scalar);
    done = done && put_number(file, &first, "total_low", total.low) &&
           put_number(file, &first, "total_high", total.high) &&
           put_unknown(file, &first, total.unknown);
    if (done && !isnan(scalar->law_difference))
        done = put_number(file, &first, "law_difference", scalar->law_difference) &&
               put_number(file, &first, "law_standard_error", scalar->law_standard_error);
    if (done && scalar->difference)
        done = put_number(file, &first, "minuend", scalar->minuend) &&
               put_number(file, &first, "subtrahend", scalar->subtrahend) &&
               put_flag(file, &first, "paired", scalar->paired);
    done = done && put_unit(file, &first, "unit", &scalar->unit);
    fputc('}', file);
    return done;
}

static bool print_scalars(FILE *file, const struct case_result *result) {
    bool done = true, first = true;
    fputc('{', file);
    for (size_t s = 0; s < result->scalar_count && done; s++)
        done = put_key(file, &first, result->scalars[s].name) &&
               print_scalar(file, &result->scalars[s]);
    fputc('}', file);
    return done;
}

bool result_print_error(FILE *file, const struct case_result *result) {
    bool first = false;
    return result->error == NULL || put_text(file, &first, "error", result->error);
}

bool result_print(FILE *file, const struct case_result *result) {
    bool first = false, done = true;
    fprintf(file, "{\"case\":%llu", (unsigned long long)result->case_number);
    if (result->difference)
        fprintf(file, ",\"less\":%llu", (unsigned long long)result->less);
    if (result->remark != NULL)
        done = put_text(file, &first, "remark", result->remark);
    fputs(",\"parameters\":", file);
    done = done && result_print_parameters(file, result->parameter_count, result->parameters);
    fprintf(file, ",\"realisations\":%llu,\"scalars\":", (unsigned long long)result->realisations);
    done = done && print_scalars(file, result);
    fputs(",\"curves\":[", file);
    for (size_t a = 0; a < result->curve_count && done; a++) {
        if (a > 0)
            fputc(',', file);
        done = print_curve(file, &result->curves[a]);
    }
    fputc(']', file);
    if (done && result->notes_all > 0) {
        fputs(",\"notes\":", file);
        done = result_print_notes(file, result->notes_all, result->note_count, result->notes);
    }
    done = done && result_print_error(file, result);
    fputc('}', file);
    return done;
}

/* --- a study --- */

static bool put_value(FILE *file, bool *first, const char *key, const cJSON *value) {
    char *text = json_print(value);
    bool done = text != NULL && put_key(file, first, key);
    if (done)
        fputs(text, file);
    free(text);
    return done;
}

bool study_print_about(FILE *file, const struct study_result *study) {
    bool first = true;
    fputc('{', file);
    return put_text(file, &first, "study", study->id) &&
           put_text(file, &first, "name", study->name) &&
           put_text(file, &first, "kind", study->kind) &&
           put_text(file, &first, "state", study->state) &&
           (study->random == NULL || put_text(file, &first, "random", study->random)) &&
           (study->swept == NULL || put_value(file, &first, "swept", study->swept)) &&
           (study->provenance == NULL || put_value(file, &first, "provenance", study->provenance));
}

bool study_print_head(FILE *file, const struct study_result *study, const struct work_time *time) {
    bool done = study_print_about(file, study);
    if (time != NULL) {
        fputc(',', file);
        work_time_print(file, time);
    }
    fputs(",\"cases\":[", file);
    return done;
}

bool study_print(FILE *file, const struct study_result *study) {
    bool done = study_print_head(file, study, NULL);
    for (size_t c = 0; c < study->case_count && done; c++) {
        if (c > 0)
            fputc(',', file);
        done = result_print(file, &study->cases[c]);
    }
    fputs("]}", file);
    return done;
}
