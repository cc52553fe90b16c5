#include "server/show/table/sweep.h"
#include "schema/near_name.h"
#include "server/show/table/shown_cases.h"
#include "server/show/view.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LABEL_SIZE = 160 };

struct sweep {
    struct case_table *table;
    const char *x;          /* pointer of the parameter */
    struct plot_line *list; /* owned until the lines take it */
    size_t count;
};

/* --- the parameter --- */

static bool is_named(const char *pointer, const char *name) {
    return strcmp(pointer, name) == 0 || strcmp(pointer + 1, name) == 0 ||
           strcmp(last_name(pointer), name) == 0;
}

/* Returns NaN for a case without the parameter, or where it is a word. */
static double number_at(const struct case_result *one, const char *pointer) {
    const struct result_parameter *value = result_parameter(one, pointer);
    return value != NULL && value->text == NULL ? value->number : (double)NAN;
}

/* Counts the numbers that a parameter has in the rows. */
static size_t count_numbers(const struct case_table *table, const char *pointer) {
    size_t count = 0;
    for (size_t r = 0; r < table->row_count; r++) {
        double number = number_at(table->rows[r], pointer);
        bool met = isnan(number);
        for (size_t before = 0; before < r && !met; before++)
            met = number == number_at(table->rows[before], pointer);
        count += !met;
    }
    return count;
}

/* Names the numbers that differ between the cases. */
static int refuse_x(const struct case_table *table, const char *name, struct error *err) {
    char names[240] = "", hint[NEAR_HINT_SIZE];
    struct near_name near = {.typed = name};
    const struct case_result *first = table->row_count > 0 ? table->rows[0] : NULL;
    bool words = false; /* there is a parameter of this name, which has no numbers */
    for (size_t p = 0; first != NULL && p < first->parameter_count; p++) {
        const char *pointer = first->parameters[p].pointer, *last = last_name(pointer);
        size_t used = strlen(names);
        words = words || is_named(pointer, name);
        plot_near_parameter(&near, table->study.kind, pointer);
        if (count_numbers(table, pointer) > 1)
            snprintf(names + used, sizeof names - used, "%s%s", used > 0 ? ", " : "", last);
    }
    return error_set(
        err, ERROR_INPUT, "x: \"%.60s\" is no number of the study's cases%s; it sweeps %s", name,
        words ? ", but words; --colour, --dash and --panel show them" : near_name_hint(&near, hint),
        *names != '\0' ? names : "no number");
}

/* Chooses the parameter of this name, or of all the one of most numbers. */
static int choose_x(struct sweep *sweep, const char *name, struct error *err) {
    const struct case_table *table = sweep->table;
    size_t most = name != NULL ? 0 : 1;
    for (size_t r = 0; r < table->row_count; r++)
        for (size_t p = 0; p < table->rows[r]->parameter_count; p++) {
            const char *pointer = table->rows[r]->parameters[p].pointer;
            if ((r > 0 && result_parameter(table->rows[0], pointer) != NULL) ||
                (name != NULL && !is_named(pointer, name)))
                continue;
            size_t numbers = count_numbers(table, pointer);
            if (numbers > most) {
                most = numbers;
                sweep->x = pointer;
            }
        }
    if (sweep->x != NULL)
        return 0;
    return name != NULL ? refuse_x(table, name, err)
                        : error_set(err, ERROR_INPUT,
                                    "x: the study sweeps no number to draw values over; rugo table "
                                    "prints them");
}

/* --- lines --- */

/* Returns whether two cases differ by nothing but x. Lists go with a number. */
static bool same_line(const struct sweep *sweep, const struct case_result *a,
                      const struct case_result *b) {
    bool same = a->parameter_count == b->parameter_count;
    for (size_t p = 0; p < a->parameter_count && same; p++) {
        const struct result_parameter *own = &a->parameters[p];
        same = own->list || strcmp(own->pointer, sweep->x) == 0 ||
               parameter_same(own, parameter_at(b, own->pointer, p));
    }
    return same;
}

static double x_of(const struct sweep *sweep, size_t row) {
    return number_at(sweep->table->rows[row], sweep->x);
}

static bool has_point(const struct sweep *sweep, const struct table_column *column, size_t row) {
    return isfinite(column->values[row].value) && isfinite(x_of(sweep, row));
}

/* Gathers the rows of the line that begins with this one, by rising x. */
static size_t gather(const struct sweep *sweep, const struct table_column *column, size_t first,
                     size_t *rows) {
    size_t count = 0;
    for (size_t r = first; r < sweep->table->row_count; r++) {
        size_t place = count;
        if (!has_point(sweep, column, r) ||
            !same_line(sweep, sweep->table->rows[first], sweep->table->rows[r]))
            continue;
        for (; place > 0 && x_of(sweep, rows[place - 1]) > x_of(sweep, r); place--)
            rows[place] = rows[place - 1];
        rows[place] = r;
        count++;
    }
    return count;
}

/* Returns whether an earlier row of the same line has a point. */
static bool is_taken(const struct sweep *sweep, const struct table_column *column, size_t row) {
    for (size_t r = 0; r < row; r++)
        if (has_point(sweep, column, r) &&
            same_line(sweep, sweep->table->rows[r], sweep->table->rows[row]))
            return true;
    return false;
}

static void add_theory(struct curve *curve, const char *name, const double *y) {
    for (size_t k = 0; k < curve->n; k++)
        if (isfinite(y[k])) {
            curve->theories[curve->theory_count++] = (struct theory){name, y};
            return;
        }
}

/* Sets the error of a source at the points of a line; NaN where it is not known. */
static int set_error(struct sweep *sweep, const struct table_column *column, const size_t *rows,
                     enum error_source source, struct curve *curve, struct error *err) {
    size_t n = curve->n;
    struct curve_error *to = &curve->errors[source];
    for (size_t k = 0; k < n; k++)
        to->applies = to->applies || column->values[rows[k]].errors[source].applies;
    if (!to->applies)
        return 0;
    double *value = result_numbers(&sweep->table->room, 3 * n);
    if (value == NULL)
        return error_memory(err, 3 * n * sizeof *value, "errors of a line");
    double *bound = value + n, *standard_error = bound + n;
    for (size_t k = 0; k < n; k++) {
        const struct scalar_error *from = &column->values[rows[k]].errors[source];
        bool none = !from->applies; /* at this point */
        value[k] = none ? 0 : from->known ? from->value : (double)NAN;
        bound[k] = none ? 0 : from->bound;
        standard_error[k] = none ? 0 : from->standard_error;
    }
    to->value = value;
    to->bound = bound;
    to->standard_error = standard_error;
    return 0;
}

/* Returns what the theory of a column is called: of a scalar what the kind calls "NAME.theory". */
static const char *theory_name(const struct sweep *sweep, const struct table_column *column) {
    char key[LABEL_SIZE];
    if (column->theory != NULL)
        return column->theory;
    snprintf(key, sizeof key, "%.100s.theory", column->name);
    const char *words = view_words(view_of(sweep->table->study.kind), key);
    return words != key ? words : "theory";
}

/* Makes the curve of a line in the table's room. */
static int add_line(struct sweep *sweep, const struct table_column *column, const size_t *rows,
                    size_t n, struct error *err) {
    struct case_result *room = &sweep->table->room;
    struct curve *curve = result_room(room, 1, sizeof *curve);
    double *numbers[5];
    bool complete = curve != NULL;
    for (size_t a = 0; a < 5; a++) {
        numbers[a] = result_numbers(room, n);
        complete = complete && numbers[a] != NULL;
    }
    if (!complete)
        return error_memory(err, 5 * n * sizeof(double), "a line");
    for (size_t k = 0; k < n; k++) {
        const struct table_value *value = &column->values[rows[k]];
        numbers[0][k] = x_of(sweep, rows[k]);
        numbers[1][k] = value->value;
        numbers[2][k] = value->standard_error;
        numbers[3][k] = value->theory;
        numbers[4][k] = value->grid;
    }
    *curve = curve_named(column->name, "", "");
    curve->model = column->model;
    curve_set_points(curve, n, numbers[0], numbers[1], numbers[2]);
    add_theory(curve, theory_name(sweep, column), numbers[3]);
    add_theory(curve, "theory of the grid", numbers[4]);
    sweep->list[sweep->count++] =
        (struct plot_line){.one = sweep->table->rows[rows[0]], .curve = curve};
    int status = 0;
    for (enum error_source s = 0; s < ERROR_SOURCES && status == 0; s++)
        status = set_error(sweep, column, rows, s, curve, err);
    return status;
}

static int add_column(struct sweep *sweep, const struct table_column *column, size_t *rows,
                      struct error *err) {
    int status = 0;
    for (size_t r = 0; r < sweep->table->row_count && status == 0; r++) {
        if (has_point(sweep, column, r) && !is_taken(sweep, column, r))
            status = add_line(sweep, column, rows, gather(sweep, column, r, rows), err);
    }
    return status;
}

static int add_lines(struct sweep *sweep, const char *name, struct error *err) {
    const struct case_table *table = sweep->table;
    size_t most = table->row_count * table->column_count, *rows = NULL;
    int status = 0;
    sweep->list = array_create(most, sizeof *sweep->list);
    rows = array_create(table->row_count, sizeof *rows);
    if (sweep->list == NULL || rows == NULL)
        status = error_memory(err, most * sizeof *sweep->list, "lines");
    for (size_t n = 0; n < table->column_count && status == 0; n++)
        if (table->columns[n].type != COLUMN_PARAMETER)
            status = add_column(sweep, &table->columns[n], rows, err);
    free(rows);
    if (status == 0 && sweep->count == 0)
        status = error_set(err, ERROR_ABSENT, "no case has a value of \"%.60s\"", name);
    return status;
}

/* Returns whether some column that is drawn has no value for a row, or the row not the parameter.
 */
static bool is_left_out(const struct sweep *sweep, size_t row) {
    const struct case_table *table = sweep->table;
    bool out = false;
    for (size_t n = 0; n < table->column_count && !out; n++)
        out = table->columns[n].type != COLUMN_PARAMETER &&
              !has_point(sweep, &table->columns[n], row);
    return out;
}

/* --- the picture --- */

/* Returns the column that is drawn. */
static const struct table_column *drawn_column(const struct case_table *table) {
    return &table->columns[table->column_count - 1];
}

/* Writes " at load 0.1" for a value of curves, nothing for a scalar. */
static void place_of(const struct case_table *table, char place[LABEL_SIZE]) {
    const struct table_column *column = drawn_column(table);
    *place = '\0';
    if (column->type == COLUMN_CURVE)
        snprintf(place, LABEL_SIZE, " at %.60s %.6g",
                 view_words(view_of(table->study.kind), column->x_label), column->x);
}

/* Labels the y axis; bare: with symbols alone, where there is no room for words. */
static void label_y(const struct case_table *table, const char *name, char label[LABEL_SIZE],
                    char bare[LABEL_SIZE]) {
    const struct table_column *column = drawn_column(table);
    const struct result_view *view = view_of(table->study.kind);
    char place[LABEL_SIZE], own[LABEL_SIZE];
    place_of(table, place);
    if (column->type == COLUMN_CURVE && column->unit != NULL) {
        snprintf(label, LABEL_SIZE, "%.80s%.70s", view_label(view, column->unit), place);
        snprintf(bare, LABEL_SIZE, "%.80s%.70s", column->unit, place);
        return;
    }
    snprintf(own, sizeof own, "%s", view_label(view, name));
    if (strcmp(own, name) == 0)
        plot_in_words(name, own, sizeof own);
    snprintf(label, LABEL_SIZE, "%s", own);
    snprintf(bare, LABEL_SIZE, "%s", own);
}

/* Writes "contact area (edges) at load 0.1 over Hurst exponent": the words of a column, and the
 * parameter. */
static void make_subject(const struct sweep *sweep, const char *name, char subject[LABEL_SIZE]) {
    const struct result_view *view = view_of(sweep->table->study.kind);
    size_t end = strcspn(name, ":@"), words = strcspn(name, "@");
    char quantity[LABEL_SIZE], shown[61], chosen[LABEL_SIZE] = "", in_words[41] = "", over[41],
                                          place[LABEL_SIZE];
    snprintf(quantity, sizeof quantity, "%.*s", (int)end, name);
    plot_in_words(view_words(view, quantity), shown, sizeof shown);
    if (words > end)
        snprintf(chosen, sizeof chosen, "%.*s", (int)(words - end - 1), name + end + 1);
    for (char *at = chosen; (at = strchr(at, ':')) != NULL;)
        *at = ' ';
    plot_in_words(chosen, in_words, sizeof in_words);
    plot_parameter_words(sweep->table->study.kind, sweep->x, over, sizeof over);
    place_of(sweep->table, place);
    snprintf(subject, LABEL_SIZE, "%s%s%s%s%.30s over %s", shown, words > end ? " (" : "", in_words,
             words > end ? ")" : "", place, over);
}

/* Writes "without a value: cases 1, 4, 5", or nothing. */
static void name_left_out(const struct sweep *sweep, char text[LABEL_SIZE]) {
    enum { NAMED_MOST = 6 };
    const struct case_table *table = sweep->table;
    size_t all = 0, named = 0;
    *text = '\0';
    for (size_t r = 0; r < table->row_count; r++)
        all += is_left_out(sweep, r);
    if (all == 0)
        return;
    int used = snprintf(text, LABEL_SIZE, "without a value: %s", all == 1 ? "case" : "cases");
    for (size_t r = 0; r < table->row_count && named < NAMED_MOST; r++)
        if (is_left_out(sweep, r))
            used +=
                snprintf(text + used, LABEL_SIZE - (size_t)used, "%s %llu", named++ > 0 ? "," : "",
                         (unsigned long long)table->rows[r]->case_number);
    if (all > named)
        snprintf(text + used, LABEL_SIZE - (size_t)used, " and %zu more", all - named);
}

static int draw(struct sweep *sweep, const char *name, const struct plot_request *request,
                FILE *file, struct error *err) {
    const struct study_result *study = &sweep->table->study;
    struct lines_request lines_request = request->lines;
    struct plot_lines lines;
    char x[LABEL_SIZE], y[LABEL_SIZE], bare[LABEL_SIZE], subject[LABEL_SIZE];
    char left_out[LABEL_SIZE];
    lines_request.left_out = sweep->x;
    struct plot_line *list = sweep->list;
    sweep->list = NULL;
    int status = plot_lines_take(&lines, study->kind, list, sweep->count, &lines_request, err);
    if (status != 0)
        return status;
    plot_parameter_label(study->kind, sweep->x, x, sizeof x);
    label_y(sweep->table, name, y, bare);
    make_subject(sweep, name, subject);
    name_left_out(sweep, left_out);
    const struct plot_words words = {
        .subject = subject, .x = x, .y = y, .y_bare = bare, .note = left_out, .points = true};
    status = plot_lines_draw(&lines, study, request, &words, file, err);
    plot_lines_clear(&lines);
    return status;
}

int sweep_draw(struct case_table *table, const char *name, const char *x,
               const struct plot_request *request, FILE *file, struct error *err) {
    struct sweep sweep = {.table = table};
    int status = choose_x(&sweep, x, err);
    if (status == 0)
        status = add_lines(&sweep, name, err);
    if (status == 0)
        status = draw(&sweep, name, request, file, err);
    free(sweep.list);
    return status;
}
