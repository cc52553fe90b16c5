#include "server/show/table/case_table.h"
#include "jobs/kind.h"
#include "schema/near_name.h"
#include "schema/result/result.h"
#include "schema/result/swept.h"
#include "schema/study/parameter.h"
#include "server/show/table/case_rows.h"
#include "server/show/table/shown_cases.h"
#include "server/show/table/table_words.h"
#include "server/show/view.h"
#include "server/show/word_list.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TABLE_WORDS_MOST = 8 };

/* A column as it is asked for: "contact_area:layered@0.1". */
struct table_wish {
    const char *asked_as;       /* what messages call the text that it is a part of */
    char text[TABLE_NAME_SIZE]; /* words are parts of it, ended by NUL */
    const char *quantity;       /* or the name of a scalar */
    size_t word_count;
    const char *words[TABLE_WORDS_MOST];
    double x; /* NaN: a scalar is asked for */
    int part; /* a table_part, or PART_SOURCES and a source of errors */
};

/* What stands beside a value, as "NAME.theory" asks for it: one of these, or a source of errors. */
enum table_part { PART_VALUE, PART_THEORY, PART_GRID, PART_LAW, PART_SOURCES };
static const char *const PART_NAMES[PART_SOURCES] = {
    [PART_THEORY] = "theory", [PART_GRID] = "grid", [PART_LAW] = "law"};

static const char *part_name(int part) {
    return part < PART_SOURCES ? PART_NAMES[part] : ERROR_SOURCE_ROWS[part - PART_SOURCES].name;
}

struct table_maker {
    const char *asked_as;
    struct case_table *table;
    const struct picture_source *source;
    struct study_result curves; /* of the quantity that was asked for last; owned */
};

void case_table_clear(struct case_table *table) {
    study_result_clear(&table->study);
    result_clear(&table->room);
    free(table->columns);
    *table = (struct case_table){0};
}

static const struct table_value NO_VALUE = {.value = NAN,
                                            .standard_error = NAN,
                                            .error = NAN,
                                            .theory = NAN,
                                            .grid = NAN,
                                            .law_difference = NAN,
                                            .law_standard_error = NAN,
                                            .physical = NAN,
                                            .total = {.low = NAN, .high = NAN}};

/* Appends a column of as many values as there are rows, NaN at first, for the caller to fill. */
static int table_add(struct case_table *table, struct table_column column,
                     struct table_value **values, struct error *err) {
    struct table_column *larger =
        realloc(table->columns, (table->column_count + 1) * sizeof *larger);
    if (larger != NULL)
        table->columns = larger;
    struct table_value *room = result_room(&table->room, table->row_count + 1, sizeof *room);
    column.name = result_text(&table->room, column.name);
    if (larger == NULL || room == NULL || column.name == NULL)
        return error_memory(err, table->row_count * sizeof *room, "a column");
    for (size_t r = 0; r < table->row_count; r++)
        room[r] = NO_VALUE;
    column.values = room;
    table->columns[table->column_count++] = column;
    *values = room;
    return 0;
}

/* --- what was swept --- */

/* Returns the unit of a parameter of the kind, or NULL. */
static const char *unit_of(const char *kind, const char *pointer) {
    const struct job_kind *known = kind_find(kind);
    const struct parameter *row =
        known != NULL ? parameter_find(known->study.tables, pointer, NULL) : NULL;
    return row != NULL ? row->unit : NULL;
}

static int add_parameters(struct case_table *table, struct error *err) {
    struct swept swept;
    int status = 0;
    swept_find(&table->study, &swept);
    for (size_t n = 0; n < swept.count && status == 0; n++) {
        struct table_value *values;
        const char *pointer = swept.columns[n].pointer;
        struct table_column column = {.type = COLUMN_PARAMETER,
                                      .name = swept.columns[n].name,
                                      .pointer = pointer,
                                      .unit = unit_of(table->study.kind, pointer),
                                      .x = NAN};
        status = table_add(table, column, &values, err);
        for (size_t r = 0; status == 0 && r < table->row_count; r++) {
            values[r].parameter = result_parameter(table->rows[r], pointer);
            if (values[r].parameter != NULL && values[r].parameter->text == NULL)
                values[r].value = values[r].parameter->number;
        }
    }
    return status;
}

/* Sets the value in a physical unit; rows whose unit is not that of the column have none. */
static int set_physical(struct case_table *table, const struct physical_unit *unit,
                        struct table_value *value, struct error *err) {
    struct table_column *column = &table->columns[table->column_count - 1];
    value->physical = NAN;
    if (unit->unit == NULL)
        return 0;
    if (column->physical == NULL)
        column->physical = result_text(&table->room, unit->unit);
    if (column->physical == NULL)
        return error_memory(err, strlen(unit->unit), "a unit");
    if (strcmp(column->physical, unit->unit) == 0)
        value->physical = value->value * unit->scale;
    return 0;
}

/* Sums up the errors of a value of a column, which are set, and marks those that are not known. */
static void sum_errors(struct table_value *value, struct table_column *column) {
    value->error = NAN;
    value->total = total_of(value->value, value->standard_error, value->sampled, value->errors);
    column->has_total = column->has_total || total_half_width(value->value, &value->total) >
                                                 TABLE_ROUNDING * fabs(value->value);
    for (size_t s = 0; s < UNKNOWN_SOURCES; s++)
        column->unknown[s] =
            column->unknown[s] || (value->total.unknown[s] && !isnan(value->value));
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        const struct scalar_error *error = &value->errors[s];
        if (error->applies && error->known)
            value->error = (isnan(value->error) ? 0 : value->error) + fabs(error->value) +
                           (isnan(error->bound) ? 0 : error->bound);
    }
}

/* --- scalars --- */

static struct table_value value_of(const struct scalar *scalar, struct table_column *column) {
    struct table_value value = {.value = scalar->value,
                                .standard_error = scalar->standard_error,
                                .sampled = scalar_sampled(scalar),
                                .theory = scalar->theory,
                                .grid = scalar->grid,
                                .law_difference = scalar->law_difference,
                                .law_standard_error = scalar->law_standard_error};
    memcpy(value.errors, scalar->errors, sizeof value.errors);
    sum_errors(&value, column);
    return value;
}

static int refuse_scalar(const struct case_table *table, const struct table_wish *wish,
                         struct error *err) {
    char names[240] = "", hint[NEAR_HINT_SIZE];
    struct near_name near = {.typed = wish->quantity};
    for (size_t c = 0; c < table->study.case_count && *names == '\0'; c++)
        for (size_t s = 0; s < table->study.cases[c].scalar_count; s++) {
            const char *scalar = table->study.cases[c].scalars[s].name;
            word_list_add(names, sizeof names, ", ", scalar);
            near_name_see(&near, scalar);
        }
    return error_set(err, ERROR_INPUT,
                     "%s: no case has a scalar \"%.60s\"%s; a value of a curve is named as "
                     "QUANTITY@X, scalars are: %s",
                     wish->asked_as, wish->quantity, near_name_hint(&near, hint),
                     *names != '\0' ? names : "none yet");
}

/* A scalar that nobody asked for but the view, and no case has, is left out. */
static int add_scalar(struct case_table *table, const char *name,
                      const struct table_wish *wish /* NULL: the view */, struct error *err) {
    bool found = false;
    struct table_value *values;
    for (size_t c = 0; c < table->study.case_count && !found; c++)
        found = result_scalar(&table->study.cases[c], name) != NULL;
    if (!found)
        return wish == NULL ? 0 : refuse_scalar(table, wish, err);
    int status = table_add(
        table, (struct table_column){.type = COLUMN_SCALAR, .name = name, .x = NAN}, &values, err);
    for (size_t r = 0; status == 0 && r < table->row_count; r++) {
        const struct scalar *scalar = result_scalar(table->rows[r], name);
        if (scalar == NULL)
            continue;
        values[r] = value_of(scalar, &table->columns[table->column_count - 1]);
        status = set_physical(table, &scalar->unit, &values[r], err);
    }
    return status;
}

/* --- values of curves --- */

enum { MODELS_MOST = 8, PLACES_TOLD = 320 };

static bool is_text(const char *own, const char *text) {
    return own != NULL && strcmp(own, text) == 0;
}

static bool has_word(const struct curve *curve, const char *word) {
    return is_text(curve->model, word) || is_text(curve->series, word) ||
           is_text(curve->kinematics, word) || table_word_is(curve->level, word) ||
           table_word_is(curve->pressure, word);
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

/* The models of the curves that are requested, in the order of the first case that has them. */
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
    while (k < curve->n && !(fabs(curve->x[k] - x) <= TABLE_ROUNDING * fabs(x)))
        k++;
    return k;
}

static double number_at(const double *numbers, size_t k) {
    return numbers != NULL ? numbers[k] : (double)NAN;
}

/* Returns the first theory of a curve that has a value at a point; or the one of this name. NULL:
 * none. */
static const struct theory *find_theory(const struct curve *curve, size_t k, const char *name) {
    for (size_t t = 0; t < curve->theory_count; t++)
        if (name != NULL ? strcmp(curve->theories[t].name, name) == 0
                         : !isnan(number_at(curve->theories[t].y, k)))
            return &curve->theories[t];
    return NULL;
}

static struct table_value value_at(const struct curve *curve, size_t k, const struct theory *theory,
                                   struct table_column *column) {
    struct table_value value = {.value = curve->y[k],
                                .standard_error = curve->standard_error[k],
                                .sampled = curve_sampled_at(curve, k),
                                .theory = NAN,
                                .grid = NAN,
                                .law_difference = number_at(curve->law_difference, k),
                                .law_standard_error = number_at(curve->law_standard_error, k)};
    value.theory = theory != NULL ? number_at(theory->y, k) : (double)NAN;
    for (enum error_source s = 0; s < ERROR_SOURCES; s++)
        value.errors[s] = curve_error_at(curve, s, k);
    sum_errors(&value, column);
    return value;
}

/* --- what there is not --- */

static int refuse_words(const struct study_result *study, const struct table_wish *wish,
                        struct error *err) {
    const struct table_wish plain = {.quantity = wish->quantity};
    char words[PLACES_TOLD] = "", number[32];
    bool any = false;
    for (size_t c = 0; c < study->case_count; c++)
        for (size_t a = 0; a < study->cases[c].curve_count; a++) {
            const struct curve *curve = &study->cases[c].curves[a];
            if (!is_wished(curve, &plain))
                continue;
            any = true;
            word_list_add(words, sizeof words, ", ", curve->model);
            word_list_add(words, sizeof words, ", ", curve->kinematics);
            word_list_add(words, sizeof words, ", ", curve->series);
            snprintf(number, sizeof number, "%g", curve->level);
            word_list_add(words, sizeof words, ", ", isnan(curve->level) ? NULL : number);
        }
    if (any && *words == '\0')
        return error_set(err, ERROR_INPUT, "%s: %.60s has no such curve; its curves have no words",
                         wish->asked_as, wish->quantity);
    if (!any)
        return error_set(err, ERROR_INPUT, "%s: no case has a curve of \"%.60s\" over one x",
                         wish->asked_as, wish->quantity);
    return error_set(err, ERROR_INPUT, "%s: %.60s has no such curve; its words are %s",
                     wish->asked_as, wish->quantity, words);
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
    return error_set(err, ERROR_INPUT, "%s: %.60s has no value at %.10g; it is known at %s",
                     wish->asked_as, wish->quantity, wish->x,
                     *places != '\0' ? places : "no point yet");
}

/* --- columns --- */

/* Reads the curves of a quantity, of all cases, unless they are at hand. */
static int read_curves(struct table_maker *maker, const char *quantity, struct error *err) {
    const struct result_filter filter = {
        .case_number = -1, .part = {.quantity = quantity, .curves_only = true}, .complete = true};
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
static int describe_column(struct case_table *table, const struct curve *curve,
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
            status = describe_column(table, curve, column, err);
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
        values[r] = value_at(curve, k, theory, column);
        status = set_physical(table, &curve->y_unit, &values[r], err);
    }
    return status;
}

/* Adds the columns of curves that a request stands for. */
static int table_add_curves(struct table_maker *maker, const struct table_wish *wish,
                            struct error *err) {
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

/* Adds what the kind's view shows of such a quantity: at the highest x of its curves, and at the
 * one next to a third of it. */
static int table_add_quantity(struct table_maker *maker, const char *quantity, struct error *err) {
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
    const struct table_wish low = {maker->asked_as, .quantity = quantity, .x = third};
    const struct table_wish high = {maker->asked_as, .quantity = quantity, .x = last};
    if (third < last)
        status = table_add_curves(maker, &low, err);
    return status != 0 ? status : table_add_curves(maker, &high, err);
}

/* --- the columns asked for --- */

/* Returns the part that a name of so many characters ends with, and takes it off. */
static int read_part(const char *text, size_t *size) {
    for (int part = PART_THEORY; part < PART_SOURCES + ERROR_SOURCES; part++) {
        const char *name = part_name(part);
        size_t length = strlen(name);
        if (*size > length + 1 && text[*size - length - 1] == '.' &&
            strncmp(text + *size - length, name, length) == 0) {
            *size -= length + 1;
            return part;
        }
    }
    return PART_VALUE;
}

/* A number that goes on ends in no part: those that there are are named. */
static int refuse_number(const char *asked_as, const char *text, struct error *err) {
    char parts[200] = "", *end;
    (void)strtod(text, &end);
    for (int part = PART_THEORY; part < PART_SOURCES + ERROR_SOURCES && end != text; part++) {
        size_t used = strlen(parts);
        snprintf(parts + used, sizeof parts - used, "%s.%s",
                 used > 0 ? ", " : "; allowed behind one: ", part_name(part));
    }
    return error_set(err, ERROR_INPUT, "%s: \"%.60s\" is no number behind @%s", asked_as, text,
                     parts);
}

/* Reads "QUANTITY:WORD:WORD@X.PART" out of size characters. */
static int read_wish(struct table_wish *wish, const char *asked_as, const char *text, size_t size,
                     struct error *err) {
    char *end;
    *wish = (struct table_wish){asked_as, .x = NAN, .part = read_part(text, &size)};
    if (size == 0 || size >= sizeof wish->text)
        return error_set(err, ERROR_INPUT,
                         "%s: \"%.*s\" is no name; names stand with commas between", asked_as,
                         (int)(size > 60 ? 60 : size), text);
    memcpy(wish->text, text, size);
    char *at = strchr(wish->text, '@');
    if (at != NULL) {
        errno = 0;
        wish->x = strtod(at + 1, &end);
        if (end == at + 1 || *end != '\0' || errno != 0 || !isfinite(wish->x))
            return refuse_number(asked_as, at + 1, err);
        *at = '\0';
    }
    char *rest = wish->text;
    wish->quantity = strsep(&rest, ":");
    while (rest != NULL && wish->word_count < TABLE_WORDS_MOST)
        wish->words[wish->word_count++] = strsep(&rest, ":");
    if (rest != NULL || (at == NULL && wish->word_count > 0))
        return error_set(err, ERROR_INPUT, "%s: \"%.*s\" is neither a scalar nor QUANTITY@X",
                         asked_as, (int)(size > 60 ? 60 : size), text);
    return 0;
}

/* Returns what stands beside a value as a value, NaN where nothing does. */
static struct table_value beside(const struct table_value *value, int part) {
    struct table_value out = NO_VALUE;
    if (part >= PART_SOURCES) {
        const struct scalar_error *error = &value->errors[part - PART_SOURCES];
        out.value = error->applies && error->known ? error->value : (double)NAN;
        out.standard_error = error->standard_error;
    } else {
        out.value = part == PART_THEORY ? value->theory
                    : part == PART_GRID ? value->grid
                                        : value->law_difference;
        out.standard_error = part == PART_LAW ? value->law_standard_error : (double)NAN;
    }
    return out;
}

/* Leaves of a column what stands beside its values. Nothing may be known yet: small studies have no
 * error of some sources. */
static int take_part(struct case_table *table, struct table_column *column,
                     const struct table_wish *wish, struct error *err) {
    int part = wish->part;
    char name[TABLE_NAME_SIZE];
    for (size_t r = 0; r < table->row_count; r++)
        column->values[r] = beside(&column->values[r], part);
    snprintf(name, sizeof name, "%.160s.%s", column->name, part_name(part));
    column->name = result_text(&table->room, name);
    column->physical = NULL;
    column->has_total = false;
    memset(column->unknown, 0, sizeof column->unknown);
    return column->name != NULL ? 0 : error_memory(err, sizeof name, "a column");
}

static int add_one(struct table_maker *maker, const struct table_wish *wish, struct error *err) {
    struct case_table *table = maker->table;
    size_t before = table->column_count;
    int status = isnan(wish->x) ? add_scalar(table, wish->quantity, wish, err)
                                : table_add_curves(maker, wish, err);
    for (size_t n = before; n < table->column_count && status == 0 && wish->part != PART_VALUE; n++)
        status = take_part(table, &table->columns[n], wish, err);
    return status;
}

static int add_wished(struct table_maker *maker, const char *columns, struct error *err) {
    int status = 0;
    for (const char *next = columns; status == 0 && next != NULL;) {
        struct table_wish wish;
        size_t size = strcspn(next, ",");
        status = read_wish(&wish, maker->asked_as, next, size, err);
        if (status == 0)
            status = add_one(maker, &wish, err);
        next = next[size] == ',' ? next + size + 1 : NULL;
    }
    return status;
}

/* --- those of the view --- */

static int add_scalars(struct case_table *table, const char *const *names, struct error *err) {
    int status = 0;
    for (; names != NULL && *names != NULL && status == 0; names++)
        status = add_scalar(table, *names, NULL, err);
    return status;
}

/* Adds those that have a theory, of a kind whose view names none. */
static int add_theoretical(struct case_table *table, struct error *err) {
    int status = 0;
    const struct case_result *first = NULL;
    for (size_t c = 0; c < table->study.case_count && first == NULL; c++)
        if (table->study.cases[c].scalar_count > 0)
            first = &table->study.cases[c];
    for (size_t s = 0; first != NULL && s < first->scalar_count && status == 0; s++)
        if (!isnan(first->scalars[s].theory))
            status = add_scalar(table, first->scalars[s].name, NULL, err);
    return status;
}

static int add_usual(struct table_maker *maker, struct error *err) {
    const struct result_view *view = view_of(maker->table->study.kind);
    const struct quantity_table *words = view->table;
    size_t before = maker->table->column_count;
    int status = 0;
    if (words != NULL)
        status = table_add_quantity(maker, words->quantity, err);
    if (status == 0)
        status = add_scalars(maker->table, words != NULL ? words->scalars : view->headlines, err);
    if (status == 0 && maker->table->column_count == before)
        status = add_theoretical(maker->table, err);
    return status;
}

/* --- together --- */

static int add_rows(struct case_table *table, const char *const *where, struct error *err) {
    size_t count = table->study.case_count;
    table->rows = result_room(&table->room, count + 1, sizeof *table->rows);
    if (table->rows == NULL)
        return error_memory(err, count * sizeof *table->rows, "rows");
    return case_rows_choose(&table->study, where, table->rows, &table->row_count, err);
}

int case_table_open(struct case_table *out, const struct picture_source *source,
                    const char *const *where, struct error *err) {
    static const struct result_filter SCALARS = {.case_number = -1, .part = {.scalars_only = true}};
    *out = (struct case_table){0};
    int status = source->results(source->context, &SCALARS, &out->study, err);
    if (status == 0)
        status = add_rows(out, where, err);
    if (status != 0)
        case_table_clear(out);
    return status;
}

int case_table_add(struct case_table *table, const struct picture_source *source,
                   const char *asked_as, const char *columns, struct error *err) {
    struct table_maker maker = {asked_as, table, source, .curves = {.id = NULL}};
    int status = columns != NULL ? add_wished(&maker, columns, err) : add_usual(&maker, err);
    study_result_clear(&maker.curves);
    return status;
}

int case_table_make(struct case_table *out, const struct picture_source *source,
                    const struct table_request *request, struct error *err) {
    struct case_table table;
    int status = case_table_open(&table, source, request->where, err);
    if (status != 0)
        return status;
    status = add_parameters(&table, err);
    if (status == 0)
        status = case_table_add(&table, source, "columns", request->columns, err);
    if (status != 0)
        case_table_clear(&table);
    else
        *out = table;
    return status;
}
