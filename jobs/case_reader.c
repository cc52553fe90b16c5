#include "jobs/case_reader.h"
#include "jobs/bytes.h"
#include "jobs/value.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct parameter *row_of(const struct case_reader *reader, const char *path) {
    for (size_t a = 0; a < reader->count; a++)
        if (strcmp(reader->table[a].path, path) == 0)
            return &reader->table[a];
    return NULL;
}

static bool number_fits(const struct parameter *row, const cJSON *value) {
    if (!cJSON_IsNumber(value))
        return false;
    double x = value->valuedouble;
    if (!(x >= row->minimum && x <= row->maximum))
        return false;
    if ((row->above_minimum && x <= row->minimum) || (row->below_maximum && x >= row->maximum))
        return false;
    return row->type != PARAMETER_INTEGER || x == floor(x);
}

/* The value of a row, given or default; *owned is what the caller deletes. */
static const cJSON *value_of(const struct case_reader *reader, const struct parameter *row,
                             cJSON **owned) {
    *owned = NULL;
    const cJSON *value = value_at(reader->parameters, row->path);
    if ((value == NULL || cJSON_IsNull(value)) && row->default_json != NULL)
        value = *owned = cJSON_Parse(row->default_json);
    return cJSON_IsNull(value) ? NULL : value;
}

double case_number(const struct case_reader *reader, const char *path) {
    const struct parameter *row = row_of(reader, path);
    if (row == NULL)
        return NAN;
    cJSON *owned;
    const cJSON *value = value_of(reader, row, &owned);
    double number = NAN;
    if (value != NULL && number_fits(row, value))
        number = value->valuedouble;
    else if (value != NULL)
        fault_add(reader->faults, path, "must be %s in %c%g, %g%c",
                  row->type == PARAMETER_INTEGER ? "an integer" : "a number",
                  row->above_minimum ? '(' : '[', row->minimum, row->maximum,
                  row->below_maximum ? ')' : ']');
    cJSON_Delete(owned);
    return number;
}

size_t case_choice(const struct case_reader *reader, const char *path) {
    const struct parameter *row = row_of(reader, path);
    if (row == NULL)
        return 0;
    cJSON *owned;
    const cJSON *value = value_of(reader, row, &owned);
    size_t choice = 0;
    if (cJSON_IsString(value))
        while (row->choices[choice] != NULL &&
               strcmp(row->choices[choice], value->valuestring) != 0)
            choice++;
    if (!cJSON_IsString(value) || row->choices[choice] == NULL) {
        fault_add(reader->faults, path, "must be one of the choices, such as \"%s\"",
                  row->choices[0]);
        choice = 0;
    }
    cJSON_Delete(owned);
    return choice;
}

/* Copies an array that fits the row; *out stays NULL where it does not. */
static int numbers_copy(const struct case_reader *reader, const struct parameter *row,
                        const cJSON *value, double **out, size_t *n, struct error *err) {
    size_t size = cJSON_IsArray(value) ? (size_t)cJSON_GetArraySize(value) : 0;
    bool fits = size >= row->items_low && size <= row->items_high && size > 0;
    const cJSON *item = NULL;
    for (item = fits ? value->child : NULL; item != NULL && fits; item = item->next)
        fits = number_fits(row, item);
    if (!fits) {
        fault_add(reader->faults, row->path, "must be %zu to %zu numbers in %c%g, %g]",
                  row->items_low, row->items_high, row->above_minimum ? '(' : '[', row->minimum,
                  row->maximum);
        return 0;
    }
    double *numbers = array_create(size, sizeof *numbers);
    if (numbers == NULL)
        return error_memory(err, size * sizeof *numbers, row->path);
    size_t a = 0;
    for (item = value->child; item != NULL; item = item->next)
        numbers[a++] = item->valuedouble;
    *out = numbers;
    *n = size;
    return 0;
}

int case_numbers(const struct case_reader *reader, const char *path, double **out, size_t *n,
                 struct error *err) {
    *out = NULL;
    *n = 0;
    const struct parameter *row = row_of(reader, path);
    if (row == NULL)
        return 0;
    cJSON *owned;
    const cJSON *value = value_of(reader, row, &owned);
    int status = value == NULL ? 0 : numbers_copy(reader, row, value, out, n, err);
    cJSON_Delete(owned);
    return status;
}

int case_status(const struct fault_list *faults, size_t before, struct error *err) {
    if (faults->count == before)
        return 0;
    const struct fault *fault =
        faults->faults != NULL && before < FAULTS_KEPT ? &faults->faults[before] : NULL;
    if (fault == NULL || fault->pointer == NULL || fault->detail == NULL)
        return error_set(err, ERROR_INPUT, "the parameters are at fault");
    return error_set(err, ERROR_INPUT, "%s: %s", fault->pointer, fault->detail);
}

static uint64_t hash_number(uint64_t hash, double number) {
    return hash_bytes(hash, sizeof number, &number);
}

uint64_t case_fingerprint(const struct case_reader *reader) {
    uint64_t hash = HASH_START;
    for (size_t a = 0; a < reader->count; a++) {
        cJSON *owned;
        const cJSON *value = value_of(reader, &reader->table[a], &owned);
        hash = hash_number(hash, (double)a);
        if (cJSON_IsNumber(value))
            hash = hash_number(hash, value->valuedouble);
        else if (cJSON_IsString(value))
            hash = hash_bytes(hash, strlen(value->valuestring), value->valuestring);
        else if (cJSON_IsArray(value))
            for (const cJSON *item = value->child; item != NULL; item = item->next)
                hash = hash_number(hash, item->valuedouble);
        cJSON_Delete(owned);
    }
    return hash;
}
