#include "server/show/case_table.h"
#include "jobs/kind.h"
#include "schema/result/swept.h"
#include "schema/study/parameter.h"
#include "server/show/case_table_internal.h"
#include "server/show/shown_cases.h"
#include "server/show/view.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void case_table_clear(struct case_table *table) {
    study_result_clear(&table->study);
    result_clear(&table->room);
    free(table->columns);
    *table = (struct case_table){0};
}

int table_add(struct case_table *table, struct table_column column, struct table_value **values,
              struct error *err) {
    struct table_column *larger =
        realloc(table->columns, (table->column_count + 1) * sizeof *larger);
    if (larger != NULL)
        table->columns = larger;
    struct table_value *room = result_room(&table->room, table->row_count + 1, sizeof *room);
    column.name = result_text(&table->room, column.name);
    if (larger == NULL || room == NULL || column.name == NULL)
        return error_memory(err, table->row_count * sizeof *room, "a column");
    for (size_t r = 0; r < table->row_count; r++)
        room[r] = (struct table_value){
            .value = NAN, .standard_error = NAN, .error = NAN, .theory = NAN, .grid = NAN};
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
    const char *pointer;
    int status = 0;
    for (size_t n = 0; status == 0 && (pointer = swept_pointer(&table->study, n)) != NULL; n++) {
        struct table_value *values;
        struct table_column column = {.type = COLUMN_PARAMETER,
                                      .name = swept_name(&table->study, n),
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

/* --- scalars --- */

static struct table_value value_of(const struct scalar *scalar, bool unknown[ERROR_SOURCES]) {
    struct table_value value = {.value = scalar->value,
                                .standard_error = scalar->standard_error,
                                .error = NAN,
                                .theory = scalar->theory,
                                .grid = scalar->grid};
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        const struct scalar_error *error = &scalar->errors[s];
        unknown[s] = unknown[s] || (error->applies && !error->known);
        if (error->applies && error->known)
            value.error = (isnan(value.error) ? 0 : value.error) + fabs(error->value) +
                          (isnan(error->bound) ? 0 : error->bound);
    }
    return value;
}

static int refuse_scalar(const struct case_table *table, const char *name, struct error *err) {
    char names[320] = "";
    for (size_t c = 0; c < table->study.case_count && *names == '\0'; c++)
        for (size_t s = 0; s < table->study.cases[c].scalar_count; s++) {
            size_t used = strlen(names);
            snprintf(names + used, sizeof names - used, "%s%s", used > 0 ? ", " : "",
                     table->study.cases[c].scalars[s].name);
        }
    return error_set(err, ERROR_INPUT,
                     "columns: no case has a scalar \"%.60s\"; a value of a curve is named as "
                     "QUANTITY@X, scalars are: %s",
                     name, *names != '\0' ? names : "none yet");
}

/* A scalar that the view names, but no case has, is left out (optional). */
static int add_scalar(struct case_table *table, const char *name, bool optional,
                      struct error *err) {
    bool found = false;
    struct table_value *values;
    for (size_t c = 0; c < table->study.case_count && !found; c++)
        found = result_scalar(&table->study.cases[c], name) != NULL;
    if (!found)
        return optional ? 0 : refuse_scalar(table, name, err);
    int status = table_add(
        table, (struct table_column){.type = COLUMN_SCALAR, .name = name, .x = NAN}, &values, err);
    for (size_t r = 0; status == 0 && r < table->row_count; r++) {
        const struct scalar *scalar = result_scalar(table->rows[r], name);
        if (scalar != NULL)
            values[r] = value_of(scalar, table->columns[table->column_count - 1].unknown);
    }
    return status;
}

/* --- the columns asked for --- */

/* Reads "QUANTITY:WORD:WORD@X" out of size characters. */
static int read_wish(struct table_wish *wish, const char *text, size_t size, struct error *err) {
    char *end;
    *wish = (struct table_wish){.x = NAN};
    if (size == 0 || size >= sizeof wish->text)
        return error_set(err, ERROR_INPUT, "columns: \"%.*s\" is no name",
                         (int)(size > 60 ? 60 : size), text);
    memcpy(wish->text, text, size);
    char *at = strchr(wish->text, '@');
    if (at != NULL) {
        errno = 0;
        wish->x = strtod(at + 1, &end);
        if (end == at + 1 || *end != '\0' || errno != 0 || !isfinite(wish->x))
            return error_set(err, ERROR_INPUT, "columns: \"%.60s\" is no number behind @", at + 1);
        *at = '\0';
    }
    char *rest = wish->text;
    wish->quantity = strsep(&rest, ":");
    while (rest != NULL && wish->word_count < TABLE_WORDS_MOST)
        wish->words[wish->word_count++] = strsep(&rest, ":");
    if (rest != NULL || (at == NULL && wish->word_count > 0))
        return error_set(err, ERROR_INPUT, "columns: \"%.*s\" is neither a scalar nor QUANTITY@X",
                         (int)(size > 60 ? 60 : size), text);
    return 0;
}

static int add_wished(struct table_maker *maker, const char *columns, struct error *err) {
    int status = 0;
    for (const char *next = columns; status == 0 && next != NULL;) {
        struct table_wish wish;
        size_t size = strcspn(next, ",");
        status = read_wish(&wish, next, size, err);
        if (status == 0)
            status = isnan(wish.x) ? add_scalar(maker->table, wish.quantity, false, err)
                                   : table_add_curves(maker, &wish, err);
        next = next[size] == ',' ? next + size + 1 : NULL;
    }
    return status;
}

/* --- those of the view --- */

static int add_scalars(struct case_table *table, const char *const *names, struct error *err) {
    int status = 0;
    for (; names != NULL && *names != NULL && status == 0; names++)
        status = add_scalar(table, *names, true, err);
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
            status = add_scalar(table, first->scalars[s].name, true, err);
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
    for (size_t c = 0; c < count; c++)
        table->rows[table->row_count++] = &table->study.cases[c];
    return table_where(table, where, err);
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
                   const char *columns, struct error *err) {
    struct table_maker maker = {.table = table, .source = source};
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
        status = case_table_add(&table, source, request->columns, err);
    if (status != 0)
        case_table_clear(&table);
    else
        *out = table;
    return status;
}
