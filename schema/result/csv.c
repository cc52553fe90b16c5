#include "schema/result/csv.h"
#include "schema/json/json.h"
#include "schema/result/provenance.h"
#include "schema/result/swept.h"
#include "schema/result/total.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The columns of theories of all curves printed, and of differences. Names are borrowed. */
struct columns {
    size_t count;       /* of theories */
    const char **names; /* owned: room for every theory of every curve */
    bool difference, units;
    struct swept swept;
};

static void collect_theories(struct columns *columns, const struct curve *curve) {
    columns->difference = columns->difference || curve->minuend != NULL;
    columns->units = columns->units || curve->x_unit.unit != NULL || curve->y_unit.unit != NULL;
    for (size_t t = 0; t < curve->theory_count; t++) {
        size_t n = 0;
        while (n < columns->count && strcmp(columns->names[n], curve->theories[t].name) != 0)
            n++;
        if (n == columns->count)
            columns->names[columns->count++] = curve->theories[t].name;
    }
}

/* Prints a text, quoted where RFC 4180 asks for it. */
static void print_text(FILE *file, const char *text) {
    if (strpbrk(text, ",\"\r\n") == NULL) {
        fputs(text, file);
        return;
    }
    fputc('"', file);
    for (; *text != '\0'; text++) {
        if (*text == '"')
            fputc('"', file);
        fputc(*text, file);
    }
    fputc('"', file);
}

static void print_field(FILE *file, double number) {
    fputc(',', file);
    if (isfinite(number))
        json_print_number(file, number);
}

/* Prints the parameter of a case in a column of swept values; empty where the case has none. */
static void print_parameter(FILE *file, const struct result_parameter *value) {
    print_field(file, value != NULL && value->text == NULL ? value->number : (double)NAN);
    if (value != NULL && value->text != NULL)
        print_text(file, value->text);
}

static void print_labels(FILE *file, const struct swept *swept, const struct case_result *one,
                         const struct curve *curve) {
    fprintf(file, "%llu", (unsigned long long)one->case_number);
    for (size_t n = 0; n < swept->count; n++)
        print_parameter(file, result_parameter(one, swept->columns[n].pointer));
    fputc(',', file);
    print_text(file, curve->quantity);
    const struct curve_attribute *row;
    for (size_t n = 0; (row = curve_column(n)) != NULL; n++) {
        const char *text = curve_attribute_text(curve, row);
        print_field(file, curve_attribute_number(curve, row));
        if (text != NULL)
            print_text(file, text);
    }
}

static double theory_at(const struct curve *curve, const char *name, size_t at) {
    for (size_t t = 0; t < curve->theory_count; t++)
        if (strcmp(curve->theories[t].name, name) == 0)
            return curve->theories[t].y != NULL ? curve->theories[t].y[at] : (double)NAN;
    return NAN;
}

/* Prints the columns of a difference; empty where a curve is none. */
static void print_difference(FILE *file, const struct case_result *one, const struct curve *curve,
                             size_t n) {
    bool difference = curve->minuend != NULL;
    print_field(file, difference ? (double)one->less : (double)NAN);
    print_field(file, difference ? curve->minuend[n] : (double)NAN);
    print_field(file, difference ? curve->subtrahend[n] : (double)NAN);
    fputs(!difference ? "," : curve->paired ? ",true" : ",false", file);
}

/* Prints a number in its unit and the unit; empty without one. */
static void print_physical(FILE *file, const struct physical_unit *unit, double number) {
    print_field(file, unit->unit != NULL ? unit->scale * number : (double)NAN);
    fprintf(file, ",%s", unit->unit != NULL ? unit->unit : "");
}

/* Prints the columns of physical units: x, x2, y and its standard error. */
static void print_units(FILE *file, const struct curve *curve, double x, double x2, size_t n) {
    const struct physical_unit none = {0};
    print_physical(file, &curve->x_unit, x);
    print_physical(file, isnan(x2) ? &none : &curve->x2_unit, x2);
    print_physical(file, &curve->y_unit, curve->y[n]);
    print_field(file, curve->y_unit.unit != NULL ? curve->y_unit.scale * curve->standard_error[n]
                                                 : (double)NAN);
}

/* Prints the columns of the total interval of a value. */
static void print_total(FILE *file, const struct curve *curve, size_t n) {
    const struct total total = curve_total(curve, n);
    char names[TOTAL_NAMES_SIZE];
    total_unknown_names(&total, names);
    print_field(file, total.low);
    print_field(file, total.high);
    fprintf(file, ",%s", names);
}

/* Prints value number `n` of the curve: a point, or an occupied cell of a matrix. */
static void print_line(FILE *file, const struct case_result *one, const struct curve *curve,
                       size_t n, const struct columns *columns) {
    bool matrix = curve->columns > 0;
    size_t at = matrix ? curve->cells[n] : n;
    double x = curve->x[matrix ? at / curve->columns : n];
    double x2 = matrix ? curve->x2[at % curve->columns] : (double)NAN;
    print_labels(file, &columns->swept, one, curve);
    print_field(file, x);
    print_field(file, x2);
    print_field(file, curve->y[n]);
    print_field(file, curve->standard_error[n]);
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        const double *error = curve->errors[s].value, *bound = curve->errors[s].bound;
        print_field(file, error != NULL ? error[n] : (double)NAN);
        print_field(file, bound != NULL ? bound[n] : (double)NAN);
    }
    print_field(file, curve->valueless != NULL && !matrix ? curve->valueless[n] : (double)NAN);
    print_field(file, curve->law_difference != NULL ? curve->law_difference[n] : (double)NAN);
    print_field(file, curve->law_difference != NULL ? curve->law_standard_error[n] : (double)NAN);
    if (columns->difference)
        print_difference(file, one, curve, n);
    for (size_t t = 0; t < columns->count; t++)
        print_field(file, theory_at(curve, columns->names[t], at));
    if (columns->units)
        print_units(file, curve, x, x2, n);
    print_total(file, curve, n);
    fputc('\n', file);
}

/* Returns whether a column of every table has this name. */
static bool is_fixed(const char *name) {
    static const char *const NAMES[] = {"case", "quantity", "x", "x2", "y"};
    const struct curve_attribute *row;
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++)
        if (strcmp(NAMES[n], name) == 0)
            return true;
    for (size_t n = 0; (row = curve_column(n)) != NULL; n++)
        if (strcmp(row->key, name) == 0)
            return true;
    return false;
}

static void print_heading(FILE *file, const struct columns *columns) {
    const struct curve_attribute *row;
    fputs("case", file);
    for (size_t n = 0; n < columns->swept.count; n++) {
        const struct swept_column *column = &columns->swept.columns[n];
        fprintf(file, ",%s", is_fixed(column->name) ? column->pointer + 1 : column->name);
    }
    fputs(",quantity", file);
    for (size_t n = 0; (row = curve_column(n)) != NULL; n++)
        fprintf(file, ",%s", row->key);
    fputs(",x,x2,y,standard_error", file);
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        fprintf(file, ",%s,%s", ERROR_SOURCE_ROWS[s].key, ERROR_SOURCE_ROWS[s].bound_key);
    fputs(",valueless,law_difference,law_standard_error", file);
    if (columns->difference)
        fputs(",less,minuend,subtrahend,paired", file);
    for (size_t t = 0; t < columns->count; t++)
        fprintf(file, ",theory_%s", columns->names[t]);
    if (columns->units)
        fputs(",x_physical,x_unit,x2_physical,x2_unit,y_physical,y_unit,standard_error_physical",
              file);
    fputs(",total_low,total_high,unknown_errors\n", file);
}

static size_t theories_most(size_t case_count, const struct case_result *cases) {
    size_t most = 1;
    for (size_t c = 0; c < case_count; c++)
        for (size_t a = 0; a < cases[c].curve_count; a++)
            most += cases[c].curves[a].theory_count;
    return most;
}

static void print_case(FILE *file, const struct case_result *one, const struct columns *columns) {
    for (size_t a = 0; a < one->curve_count; a++) {
        const struct curve *curve = &one->curves[a];
        size_t count = curve->columns > 0 ? curve->cell_count : curve->n;
        for (size_t n = 0; n < count; n++)
            print_line(file, one, curve, n, columns);
    }
}

bool csv_print(FILE *file, const struct study_result *study) {
    const struct case_result *cases = study->cases;
    struct columns columns = {
        .names = array_create(theories_most(study->case_count, cases), sizeof *columns.names)};
    if (columns.names == NULL)
        return false;
    swept_find(study, &columns.swept);
    for (size_t c = 0; c < study->case_count; c++)
        for (size_t a = 0; a < cases[c].curve_count; a++)
            collect_theories(&columns, &cases[c].curves[a]);
    provenance_comment(file, study);
    print_heading(file, &columns);
    for (size_t c = 0; c < study->case_count; c++)
        print_case(file, &cases[c], &columns);
    free(columns.names);
    return true;
}
