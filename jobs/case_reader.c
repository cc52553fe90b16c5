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

/* The value of a row where it is given; null counts as absent. */
static const cJSON *given(const struct case_reader *reader, const struct parameter *row) {
    const cJSON *value = value_at(reader->parameters, row->path);
    return cJSON_IsNull(value) ? NULL : value;
}

/* The next number of a default such as "[-4, 8, 240]" or "0.5"; false at its end. Defaults are read
 * where they stand: nothing is allocated that could fail and leave a case with another meaning. */
static bool next_number(const char **at, double *number) {
    char *stop;
    *at += strspn(*at, "[, ");
    *number = strtod(*at, &stop);
    bool found = stop != *at;
    *at = stop;
    return found;
}

double case_number(const struct case_reader *reader, const char *path) {
    const struct parameter *row = row_of(reader, path);
    if (row == NULL)
        return NAN;
    const cJSON *value = given(reader, row);
    if (value == NULL)
        return row->default_json != NULL ? strtod(row->default_json, NULL) : NAN;
    if (number_fits(row, value))
        return value->valuedouble;
    fault_add(reader->faults, path, "must be %s in %c%g, %g%c",
              row->type == PARAMETER_INTEGER ? "an integer" : "a number",
              row->above_minimum ? '(' : '[', row->minimum, row->maximum,
              row->below_maximum ? ')' : ']');
    return NAN;
}

size_t case_choice(const struct case_reader *reader, const char *path) {
    const struct parameter *row = row_of(reader, path);
    if (row == NULL)
        return 0;
    const cJSON *value = given(reader, row);
    const char *text = cJSON_IsString(value) ? value->valuestring : "";
    size_t length = strlen(text), choice = 0;
    if (value == NULL && row->default_json != NULL) {
        text = row->default_json + 1; /* within its quotes */
        length = strcspn(text, "\"");
    }
    while (row->choices[choice] != NULL && (strlen(row->choices[choice]) != length ||
                                            memcmp(row->choices[choice], text, length) != 0))
        choice++;
    if (row->choices[choice] != NULL)
        return choice;
    fault_add(reader->faults, path, "must be one of the choices, such as \"%s\"", row->choices[0]);
    return 0;
}

static bool numbers_fit(const struct parameter *row, const cJSON *value) {
    size_t size = cJSON_IsArray(value) ? (size_t)cJSON_GetArraySize(value) : 0;
    bool fits = size >= row->items_low && size <= row->items_high;
    for (const cJSON *item = fits ? value->child : NULL; item != NULL && fits; item = item->next)
        fits = number_fits(row, item);
    return fits;
}

int case_numbers(const struct case_reader *reader, const char *path, double **out, size_t *n,
                 struct error *err) {
    *out = NULL;
    *n = 0;
    const struct parameter *row = row_of(reader, path);
    const cJSON *value = row != NULL ? given(reader, row) : NULL;
    if (row == NULL || (value == NULL && row->default_json == NULL))
        return 0;
    if (value != NULL && !numbers_fit(row, value)) {
        fault_add(reader->faults, row->path, "must be %zu to %zu numbers in %c%g, %g]",
                  row->items_low, row->items_high, row->above_minimum ? '(' : '[', row->minimum,
                  row->maximum);
        return 0;
    }
    double *numbers = array_create(row->items_high, sizeof *numbers);
    if (numbers == NULL)
        return error_memory(err, row->items_high * sizeof *numbers, row->path);
    const char *at = row->default_json;
    if (value != NULL)
        for (const cJSON *item = value->child; item != NULL; item = item->next)
            numbers[(*n)++] = item->valuedouble;
    else
        while (*n < row->items_high && next_number(&at, &numbers[*n]))
            ++*n;
    *out = numbers;
    return 0;
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

static uint64_t hash_default(uint64_t hash, const char *json) {
    if (json == NULL)
        return hash;
    if (*json == '"')
        return hash_bytes(hash, strcspn(json + 1, "\""), json + 1);
    for (double number; next_number(&json, &number);)
        hash = hash_number(hash, number);
    return hash;
}

uint64_t case_fingerprint(const struct case_reader *reader) {
    uint64_t hash = HASH_START;
    for (size_t a = 0; a < reader->count; a++) {
        const cJSON *value = given(reader, &reader->table[a]);
        hash = hash_number(hash, (double)a);
        if (value == NULL)
            hash = hash_default(hash, reader->table[a].default_json);
        else if (cJSON_IsNumber(value))
            hash = hash_number(hash, value->valuedouble);
        else if (cJSON_IsString(value))
            hash = hash_bytes(hash, strlen(value->valuestring), value->valuestring);
        else if (cJSON_IsArray(value))
            for (const cJSON *item = value->child; item != NULL; item = item->next)
                hash = hash_number(hash, item->valuedouble);
    }
    return hash;
}
