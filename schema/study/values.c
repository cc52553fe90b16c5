#include "schema/study/values.h"
#include "schema/study/value.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct values {
    const struct parameter_table *const *tables; /* borrowed */
    struct fault_list *faults;                   /* borrowed, or own */
    struct fault_list own;
    size_t before;       /* faults in the list when the values were made */
    const char *misread; /* a path that a reader asked for and that is in no table; borrowed */
    size_t count;        /* of rows */
    size_t next;         /* behind the row found last */
    const cJSON **at;    /* owned array of count borrowed values; NULL: absent */
    cJSON **defaults; /* owned array of count owned values, of rows that are absent or came later */
};

/* Finds and checks the value of every row. */
static int values_fill(struct values *values, const cJSON *parameters, struct error *err) {
    for (size_t p = 0; p < values->count; p++) {
        const struct parameter *row = parameter_row(values->tables, p);
        values->at[p] = json_at(parameters, row->path);
        bool given = values->at[p] != NULL;
        if (given)
            value_check(row, values->at[p], row->path, values->faults);
        else if (row->required && row->default_json == NULL)
            value_missing(row, values->faults);
        if (row->default_json == NULL || (given && !row->later))
            continue;
        values->defaults[p] = value_default(row);
        if (values->defaults[p] == NULL)
            return error_memory(err, strlen(row->default_json), row->path);
        if (!given)
            values->at[p] = values->defaults[p];
    }
    return values_status(values, err);
}

int values_create(struct values **out, const cJSON *parameters,
                  const struct parameter_table *const *tables, struct fault_list *faults,
                  struct error *err) {
    struct values *values = array_create(1, sizeof *values);
    if (values == NULL)
        return error_memory(err, sizeof *values, "the values of a case");
    size_t count = parameter_count(tables);
    *values = (struct values){.tables = tables, .count = count};
    values->faults = faults != NULL ? faults : &values->own;
    values->before = values->faults->count;
    values->at = array_create(count, sizeof *values->at);
    values->defaults = array_create(count, sizeof *values->defaults);
    int status = 0;
    if (values->at == NULL || values->defaults == NULL)
        status = error_memory(err, 2 * count * sizeof *values->at, "the values of a case");
    else
        status = values_fill(values, parameters, err);
    if (status != 0)
        values_destroy(&values);
    else
        *out = values;
    return status;
}

void values_destroy(struct values **values) {
    struct values *v = *values;
    if (v == NULL)
        return;
    for (size_t p = 0; v->defaults != NULL && p < v->count; p++)
        cJSON_Delete(v->defaults[p]);
    fault_list_clear(&v->own);
    free(v->defaults);
    free(v->at);
    free(v);
    *values = NULL;
}

const cJSON *values_json(const struct values *values, size_t index) {
    return index < values->count ? values->at[index] : NULL;
}

bool values_is_default(const struct values *values, size_t index) {
    const cJSON *value = values_json(values, index), *usual = values->defaults[index];
    return value == NULL || value == usual || (usual != NULL && cJSON_Compare(value, usual, true));
}

/* Returns the row of a path; NULL where there is none. The search begins behind the last row found,
 * as readers ask mostly in the order of the rows. */
static const struct parameter *row_of(struct values *values, const char *path, size_t *index) {
    for (size_t i = 0; i < values->count; i++) {
        size_t p = (values->next + i) % values->count;
        const struct parameter *row = parameter_row(values->tables, p);
        if (row != NULL && strcmp(row->path, path) == 0) {
            values->next = p + 1;
            *index = p;
            return row;
        }
    }
    return NULL;
}

/* Returns the row of a path and its value. Where there is no row of that type, remembers the path
 * and returns NULL. An integer is a number. */
static const struct parameter *find(struct values *values, const char *path,
                                    enum parameter_type type, const cJSON **value) {
    size_t index = 0;
    const struct parameter *row = row_of(values, path, &index);
    bool fits = row != NULL &&
                (row->type == type || (type == PARAMETER_NUMBER && row->type == PARAMETER_INTEGER));
    *value = NULL;
    if (!fits) {
        values->misread = path;
        return NULL;
    }
    *value = values->at[index];
    return row;
}

double values_number(struct values *values, const char *path) {
    const cJSON *value;
    const struct parameter *row = find(values, path, PARAMETER_NUMBER, &value);
    return row != NULL && value != NULL ? value->valuedouble : NAN;
}

bool values_is_given(struct values *values, const char *path) {
    size_t index = 0;
    if (row_of(values, path, &index) == NULL)
        values->misread = path;
    return values->misread != path && values->at[index] != NULL;
}

static int choice_value(const struct choice *choices, const cJSON *value) {
    const struct choice *choice = choice_find(choices, cJSON_GetStringValue(value));
    return choice != NULL ? choice->value : 0;
}

int values_choice(struct values *values, const char *path) {
    const cJSON *value;
    const struct parameter *row = find(values, path, PARAMETER_CHOICE, &value);
    return row != NULL ? choice_value(row->choices, value) : 0;
}

bool values_flag(struct values *values, const char *path) {
    const cJSON *value;
    return find(values, path, PARAMETER_FLAG, &value) != NULL && cJSON_IsTrue(value);
}

const char *values_text(struct values *values, const char *path) {
    const cJSON *value;
    const struct parameter *row = find(values, path, PARAMETER_TEXT, &value);
    return row != NULL ? cJSON_GetStringValue(value) : NULL;
}

size_t values_choices(struct values *values, const char *path, int *out) {
    const cJSON *value;
    const struct parameter *row = find(values, path, PARAMETER_CHOICES, &value);
    size_t n = 0;
    if (row == NULL || value == NULL)
        return 0;
    if (!cJSON_IsArray(value))
        out[n++] = choice_value(row->choices, value);
    else
        for (const cJSON *item = value->child; item != NULL; item = item->next)
            out[n++] = choice_value(row->choices, item);
    return n;
}

double values_measure(struct values *values, const char *path, int *unit) {
    const cJSON *value;
    const struct parameter *row = find(values, path, PARAMETER_MEASURE, &value);
    *unit = 0;
    if (row == NULL || value == NULL)
        return NAN;
    if (!cJSON_IsObject(value)) {
        *unit = choice_value(row->choices, value);
        return INFINITY;
    }
    const struct choice *known = choice_find(row->units, value->child->string);
    *unit = known != NULL ? known->value : 0;
    return value->child->valuedouble;
}

int values_numbers(struct values *values, const char *path, double **out, size_t *n,
                   struct error *err) {
    const cJSON *value;
    *out = NULL;
    *n = 0;
    if (find(values, path, PARAMETER_NUMBERS, &value) == NULL || !cJSON_IsArray(value))
        return 0;
    size_t count = (size_t)cJSON_GetArraySize(value);
    double *numbers = array_create(count, sizeof *numbers);
    if (numbers == NULL)
        return error_memory(err, count * sizeof *numbers, path);
    for (const cJSON *item = value->child; item != NULL; item = item->next)
        numbers[(*n)++] = item->valuedouble;
    *out = numbers;
    return 0;
}

void values_bins(struct values *values, const char *path, size_t most, struct bins *out) {
    const cJSON *value;
    if (find(values, path, PARAMETER_NUMBERS, &value) == NULL || cJSON_GetArraySize(value) != 3) {
        values->misread = path; /* its row must ask for three numbers, and have a default */
        return;
    }
    double low = value->child->valuedouble, high = value->child->next->valuedouble;
    double count = value->child->next->next->valuedouble;
    if (!(low < high))
        values_fault(values, path, "low, %g, must be below high, %g", low, high);
    else if (!(count >= 1 && count <= (double)most && count == floor(count)))
        values_fault(values, path, "the count, %g, must be an integer in [1, %zu]", count, most);
    else
        *out = (struct bins){low, high, (size_t)count};
}

void values_fault(struct values *values, const char *path, const char *format, ...) {
    char detail[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(detail, sizeof detail, format, arguments);
    va_end(arguments);
    fault_add(values->faults, path, "%s", detail);
    if (parameter_find(values->tables, path, NULL) == NULL)
        values->misread = path;
}

size_t values_fault_count(const struct values *values) {
    return values->faults->count - values->before;
}

int values_status(const struct values *values, struct error *err) {
    const struct fault_list *faults = values->faults;
    if (values->misread != NULL)
        return error_set(err, ERROR_STATE, "the program reads %s as no table has it",
                         values->misread);
    if (values_fault_count(values) == 0)
        return 0;
    const struct fault *fault = faults->faults != NULL && values->before < FAULTS_KEPT
                                    ? &faults->faults[values->before]
                                    : NULL;
    if (fault == NULL || *fault->detail == '\0')
        return error_set(err, ERROR_INPUT, "the parameters are at fault");
    return error_set(err, ERROR_INPUT, "%s: %s", fault->pointer, fault->detail);
}
