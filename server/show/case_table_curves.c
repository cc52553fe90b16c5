/* Columns of values of curves. */
#include "server/show/case_table.h"
#include "server/show/case_table_internal.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double ROUNDING = 1e-9; /* relative: a place that a person writes is the one meant */
enum { MODELS_MOST = 8, PLACES_TOLD = 320 };

/* Returns whether a number is meant by a text. */
static bool is_number(double number, const char *text) {
    char *end;
    double read = strtod(text, &end);
    return end != text && *end == '\0' && fabs(read - number) <= ROUNDING * fabs(number);
}

static bool is_text(const char *own, const char *text) {
    return own != NULL && strcmp(own, text) == 0;
}

static bool has_word(const struct curve *curve, const char *word) {
    return is_text(curve->model, word) || is_text(curve->series, word) ||
           is_text(curve->kinematics, word) || is_number(curve->level, word) ||
           is_number(curve->pressure, word);
}

static bool is_wished(const struct curve *curve, const struct table_wish *wish) {
    bool fits = strcmp(curve->quantity, wish->quantity) == 0 && curve->columns == 0;
    for (size_t w = 0; w < wish->word_count && fits; w++)
        fits = has_word(curve, wish->words[w]);
    return fits;
}

/* Returns the curve of a model: of the first series that fits, on its finest level; or NULL. */
static const struct curve *find_curve(const struct case_result *one, const struct table_wish *wish,
                                      const char *model) {
    const struct curve *found = NULL;
    for (size_t a = 0; a < one->curve_count; a++) {
        const struct curve *curve = &one->curves[a];
        if (!is_wished(curve, wish) || !same_text(curve->model, model))
            continue;
        if (found == NULL ||
            (same_text(curve->series, found->series) &&
             same_number(curve->pressure, found->pressure) && curve->level > found->level))
            found = curve;
    }
    return found;
}

/* The models of the curves that are wished for, in the order of the first case that has them. */
struct models {
    size_t count;
    const char *names[MODELS_MOST]; /* NULL: curves without models */
};

static void find_models(struct models *models, const struct study_result *study,
                        const struct table_wish *wish) {
    *models = (struct models){0};
    for (size_t c = 0; c < study->case_count; c++)
        for (size_t a = 0; a < study->cases[c].curve_count; a++) {
            const struct curve *curve = &study->cases[c].curves[a];
            bool met = !is_wished(curve, wish);
            for (size_t m = 0; m < models->count && !met; m++)
                met = same_text(models->names[m], curve->model);
            if (!met && models->count < MODELS_MOST)
                models->names[models->count++] = curve->model;
        }
}

/* Returns the number of the point at x; curve->n where there is none. */
static size_t find_place(const struct curve *curve, double x) {
    size_t k = 0;
    while (k < curve->n && !(fabs(curve->x[k] - x) <= ROUNDING * fabs(x)))
        k++;
    return k;
}

static double number_at(const double *numbers, size_t k) {
    return numbers != NULL ? numbers[k] : (double)NAN;
}

/* Returns the first theory of a curve that has a value at a place; or the one of this name. NULL:
 * none. */
static const struct theory *find_theory(const struct curve *curve, size_t k, const char *name) {
    for (size_t t = 0; t < curve->theory_count; t++)
        if (name != NULL ? strcmp(curve->theories[t].name, name) == 0
                         : !isnan(number_at(curve->theories[t].y, k)))
            return &curve->theories[t];
    return NULL;
}

static struct table_value value_at(const struct curve *curve, size_t k, const struct theory *theory,
                                   bool unknown[ERROR_SOURCES]) {
    struct table_value value = {.value = curve->y[k],
                                .standard_error = curve->standard_error[k],
                                .error = NAN,
                                .theory = NAN,
                                .grid = NAN};
    value.theory = theory != NULL ? number_at(theory->y, k) : (double)NAN;
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        const struct curve_error *error = &curve->errors[s];
        double own = number_at(error->value, k), bound = number_at(error->bound, k);
        unknown[s] = unknown[s] || (error->applies && isnan(own));
        if (!isnan(own))
            value.error =
                (isnan(value.error) ? 0 : value.error) + fabs(own) + (isnan(bound) ? 0 : bound);
    }
    return value;
}

/* --- what there is not --- */

static void append(char *text, size_t size, const char *word) {
    size_t used = strlen(text);
    if (word != NULL && *word != '\0' && strstr(text, word) == NULL)
        snprintf(text + used, size - used, "%s%s", used > 0 ? ", " : "", word);
}

static int refuse_words(const struct study_result *study, const struct table_wish *wish,
                        struct error *err) {
    const struct table_wish plain = {.quantity = wish->quantity};
    char words[PLACES_TOLD] = "", number[32];
    for (size_t c = 0; c < study->case_count; c++)
        for (size_t a = 0; a < study->cases[c].curve_count; a++) {
            const struct curve *curve = &study->cases[c].curves[a];
            if (!is_wished(curve, &plain))
                continue;
            append(words, sizeof words, curve->model);
            append(words, sizeof words, curve->kinematics);
            append(words, sizeof words, curve->series);
            snprintf(number, sizeof number, "%g", curve->level);
            append(words, sizeof words, isnan(curve->level) ? NULL : number);
        }
    if (*words == '\0')
        return error_set(err, ERROR_INPUT, "columns: no case has a curve of \"%.60s\" over one x",
                         wish->quantity);
    return error_set(err, ERROR_INPUT, "columns: %.60s has no such curve; its words are %s",
                     wish->quantity, words);
}

static int refuse_place(const struct curve *curve, const struct table_wish *wish,
                        struct error *err) {
    char places[PLACES_TOLD] = "";
    for (size_t k = 0; curve != NULL && k < curve->n; k++) {
        size_t used = strlen(places);
        if (used + 40 > sizeof places) {
            snprintf(places + used, sizeof places - used, " and on to %.10g",
                     curve->x[curve->n - 1]);
            break;
        }
        snprintf(places + used, sizeof places - used, "%s%.10g", used > 0 ? ", " : "", curve->x[k]);
    }
    return error_set(err, ERROR_INPUT, "columns: %.60s has no value at %.10g; it is known at %s",
                     wish->quantity, wish->x, *places != '\0' ? places : "no place yet");
}

/* --- columns --- */

/* Reads the curves of a quantity, of all cases, unless they are at hand. */
static int read_curves(struct table_maker *maker, const char *quantity, struct error *err) {
    const struct result_filter filter = {
        .case_number = -1, .part = {.quantity = quantity}, .complete = true};
    for (size_t c = 0; c < maker->curves.case_count; c++)
        if (result_curve(&maker->curves.cases[c], quantity) != NULL)
            return 0;
    study_result_clear(&maker->curves);
    return maker->source->results(maker->source->context, &filter, &maker->curves, err);
}

static const struct case_result *case_of(const struct study_result *study, uint64_t number) {
    for (size_t c = 0; c < study->case_count; c++)
        if (study->cases[c].case_number == number)
            return &study->cases[c];
    return NULL;
}

/* Writes "contact_area:layered@0.1": as it was asked for, with the model where there are several.
 */
static void column_name(const struct table_wish *wish, const struct models *models,
                        const char *model, char name[TABLE_NAME_SIZE]) {
    size_t used = (size_t)snprintf(name, TABLE_NAME_SIZE, "%.60s", wish->quantity);
    if (models->count > 1 && model != NULL)
        used += (size_t)snprintf(name + used, TABLE_NAME_SIZE - used, ":%.30s", model);
    for (size_t w = 0; w < wish->word_count && used + 40 < TABLE_NAME_SIZE; w++)
        used += (size_t)snprintf(name + used, TABLE_NAME_SIZE - used, ":%.30s", wish->words[w]);
    if (used + 24 < TABLE_NAME_SIZE)
        snprintf(name + used, TABLE_NAME_SIZE - used, "@%.10g", wish->x);
}

/* Copies the texts of a curve, which is gone when the table is shown. */
static int describe(struct case_table *table, const struct curve *curve,
                    struct table_column *column, struct error *err) {
    column->quantity = result_text(&table->room, curve->quantity);
    column->series = result_text(&table->room, curve->series);
    column->model = result_text(&table->room, curve->model);
    column->unit = result_text(&table->room, curve->y_label);
    column->x_label = result_text(&table->room, curve->x_label);
    return column->quantity != NULL && column->series != NULL && column->unit != NULL &&
                   column->x_label != NULL
               ? 0
               : error_memory(err, TABLE_NAME_SIZE, "a column");
}

/* Adds the column of a model. found: whether some case of the study has a value there. */
static int add_model(struct table_maker *maker, const struct table_wish *wish,
                     const struct models *models, const char *model, bool *found,
                     struct error *err) {
    struct case_table *table = maker->table;
    char name[TABLE_NAME_SIZE];
    struct table_value *values;
    column_name(wish, models, model, name);
    int status =
        table_add(table, (struct table_column){.type = COLUMN_CURVE, .name = name, .x = wish->x},
                  &values, err);
    if (status != 0)
        return status;
    struct table_column *column = &table->columns[table->column_count - 1];
    for (size_t c = 0; c < maker->curves.case_count && status == 0; c++) {
        const struct curve *curve = find_curve(&maker->curves.cases[c], wish, model);
        *found = *found || (curve != NULL && find_place(curve, wish->x) < curve->n);
        if (curve != NULL && column->quantity == NULL)
            status = describe(table, curve, column, err);
    }
    for (size_t r = 0; r < table->row_count && status == 0; r++) {
        const struct case_result *one = case_of(&maker->curves, table->rows[r]->case_number);
        const struct curve *curve = one != NULL ? find_curve(one, wish, model) : NULL;
        size_t k = curve != NULL ? find_place(curve, wish->x) : 0;
        if (curve == NULL || k == curve->n)
            continue;
        const struct theory *theory = find_theory(curve, k, column->theory);
        if (theory != NULL && column->theory == NULL)
            column->theory = result_text(&table->room, theory->name);
        values[r] = value_at(curve, k, theory, column->unknown);
    }
    return status;
}

int table_add_curves(struct table_maker *maker, const struct table_wish *wish, struct error *err) {
    struct models models;
    bool found = false;
    int status = read_curves(maker, wish->quantity, err);
    if (status != 0)
        return status;
    find_models(&models, &maker->curves, wish);
    if (models.count == 0)
        return refuse_words(&maker->curves, wish, err);
    for (size_t m = 0; m < models.count && status == 0; m++)
        status = add_model(maker, wish, &models, models.names[m], &found, err);
    const struct curve *first = NULL;
    for (size_t c = 0; c < maker->curves.case_count && first == NULL; c++)
        first = find_curve(&maker->curves.cases[c], wish, models.names[0]);
    return status == 0 && !found ? refuse_place(first, wish, err) : status;
}

int table_add_quantity(struct table_maker *maker, const char *quantity, struct error *err) {
    const struct curve *first = NULL;
    int status = read_curves(maker, quantity, err);
    for (size_t c = 0; c < maker->curves.case_count && status == 0 && first == NULL; c++)
        first = result_curve(&maker->curves.cases[c], quantity);
    if (status != 0 || first == NULL || first->n == 0)
        return status;
    double last = first->x[first->n - 1], third = last;
    for (size_t k = 0; k < first->n; k++)
        if (fabs(first->x[k] - last / 3) < fabs(third - last / 3))
            third = first->x[k];
    const struct table_wish low = {.quantity = quantity, .x = third};
    const struct table_wish high = {.quantity = quantity, .x = last};
    if (third < last)
        status = table_add_curves(maker, &low, err);
    return status != 0 ? status : table_add_curves(maker, &high, err);
}
