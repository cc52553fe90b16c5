/* One case less another: tables of both, and of what lies between them. */
#include "core/plain_text.h"
#include "schema/result/view.h"
#include "server/show/summary.h"
#include "server/show/summary_cells.h"
#include "server/show/view.h"
#include <math.h>
#include <string.h>

enum { PLACES_SHOWN = 12, COLUMNS = 5 };

/* Errors of the sources but the statistical one, |value| + bound each, added up; NaN where one that
 * bears on the curve is not known. */
static double other_errors(const struct curve *curve, size_t k, bool unknown[ERROR_SOURCES]) {
    double sum = 0;
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        const struct curve_error *error = &curve->errors[s];
        if (!error->applies)
            continue;
        if (error->value == NULL || isnan(error->value[k])) {
            unknown[s] = true;
            continue;
        }
        sum += fabs(error->value[k]) + (error->bound != NULL ? error->bound[k] : 0);
    }
    return sum;
}

static void put_heading(struct text_table *table, const char *first,
                        const struct case_result *one) {
    table_cell(table, "%s", first);
    table_cell(table, "case %llu", (unsigned long long)one->case_number);
    table_cell(table, "case %llu", (unsigned long long)one->less);
    table_cell(table, "difference");
    table_cell(table, "other errors");
}

static void put_errors(struct text_table *table, double errors) {
    if (errors > 0)
        table_cell(table, "+-%.2g", errors);
    else
        table_cell(table, "-");
}

static void print_label(const struct curve *curve, FILE *file) {
    char model[80];
    fprintf(file, "\n%s", curve->quantity);
    if (curve->series != NULL && *curve->series != '\0')
        fprintf(file, ", %s", curve->series);
    if (curve->model != NULL)
        fprintf(file, ", %s", model_text(curve->model, curve->kinematics, model, sizeof model));
    if (!isnan(curve->pressure))
        fprintf(file, ", at %.4g", curve->pressure);
    fprintf(file, " (%s)%s\n", curve->y_label, curve->paired ? "" : ", not by pairs");
}

static void print_curve(const struct case_result *one, const struct curve *curve,
                        bool unknown[ERROR_SOURCES], FILE *file) {
    struct text_table table = {.columns = COLUMNS};
    size_t step = (curve->n + PLACES_SHOWN - 1) / PLACES_SHOWN;
    print_label(curve, file);
    put_heading(&table, curve->x_label, one);
    for (size_t k = curve->n > 0 ? (curve->n - 1) % step : 0; k < curve->n; k += step) {
        table_number(&table, curve->x[k]);
        table_number(&table, curve->minuend[k]);
        table_number(&table, curve->subtrahend[k]);
        measured_cell(&table, curve->y[k], curve->standard_error[k]);
        put_errors(&table, other_errors(curve, k, unknown));
    }
    table_print(&table, file);
    table_clear(&table);
}

static void print_scalars(const struct case_result *one, FILE *file) {
    struct text_table table = {.columns = COLUMNS};
    put_heading(&table, "scalar", one);
    for (size_t s = 0; s < one->scalar_count; s++) {
        const struct scalar *scalar = &one->scalars[s];
        double errors = 0;
        if (isnan(scalar->value) || (scalar->value == 0 && scalar->standard_error == 0))
            continue;
        for (size_t e = 0; e < ERROR_SOURCES; e++)
            if (scalar->errors[e].applies && scalar->errors[e].known)
                errors += fabs(scalar->errors[e].value) + scalar->errors[e].bound;
        table_cell(&table, "%s%s", scalar->name, scalar->paired ? "" : " (not by pairs)");
        table_number(&table, scalar->minuend);
        table_number(&table, scalar->subtrahend);
        measured_cell(&table, scalar->value, scalar->standard_error);
        put_errors(&table, errors);
    }
    fputc('\n', file);
    table_print(&table, file);
    table_clear(&table);
}

/* The table of the kind has its quantity alone where others are there too. */
static bool is_shown(const struct study_result *study, const struct curve *curve) {
    const struct case_result *one = &study->cases[0];
    const struct result_view *view = view_of(study->kind);
    if (is_bracket(curve->series))
        return false;
    bool many = strcmp(one->curves[0].quantity, one->curves[one->curve_count - 1].quantity) != 0;
    if (!many)
        return true;
    return view->table != NULL && strcmp(curve->quantity, view->table->quantity) == 0;
}

void summary_of_difference(const struct study_result *study, FILE *file) {
    bool unknown[ERROR_SOURCES] = {false}, paired = true;
    if (study->case_count == 0)
        return;
    const struct case_result *one = &study->cases[0];
    text_print_plain(file, study->name);
    fprintf(file, " (%s), study %s: case %llu less case %llu, %llu realisations\n", study->state,
            study->id, (unsigned long long)one->case_number, (unsigned long long)one->less,
            (unsigned long long)one->realisations);
    for (size_t p = 0; p < one->parameter_count; p++)
        if (one->parameters[p].text != NULL && strstr(one->parameters[p].text, " less ") != NULL)
            fprintf(file, "%s: %s\n", one->parameters[p].pointer, one->parameters[p].text);
    for (size_t a = 0; a < one->curve_count; a++)
        if (is_shown(study, &one->curves[a])) {
            print_curve(one, &one->curves[a], unknown, file);
            paired = paired && one->curves[a].paired;
        }
    print_scalars(one, file);
    fprintf(file, "\n+-: one standard error%s; other errors: bounds of both cases, added up\n",
            paired ? ", of pairs of realisations" : "");
    const struct quantity_table *words = view_of(study->kind)->table;
    print_unknown(unknown, words != NULL ? words->error_words : NULL, file);
    if (one->remark != NULL)
        fprintf(file, "%s\n", one->remark);
}
