#include "jobs/case_reader.h"
#include "jobs/value.h"
#include "schema/result/bytes.h"
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

/* Where among the names; at their end where none is it. */
static size_t position(const char *const *names, size_t length, const char *name) {
    size_t a = 0;
    while (names[a] != NULL && (strlen(names[a]) != length || memcmp(names[a], name, length) != 0))
        a++;
    return a;
}

size_t case_choice(const struct case_reader *reader, const char *path) {
    const struct parameter *row = row_of(reader, path);
    if (row == NULL)
        return 0;
    const cJSON *value = given(reader, row);
    const char *text = cJSON_IsString(value) ? value->valuestring : "";
    size_t length = strlen(text);
    if (value == NULL && row->default_json != NULL) {
        text = row->default_json + 1; /* within its quotes */
        length = strcspn(text, "\"");
    }
    size_t choice = position(row->choices, length, text);
    if (row->choices[choice] != NULL)
        return choice;
    fault_add(reader->faults, path, "must be one of the choices, such as \"%s\"", row->choices[0]);
    return 0;
}

size_t case_choices(const struct case_reader *reader, const char *path, size_t *out) {
    const struct parameter *row = row_of(reader, path);
    const cJSON *value = row != NULL ? given(reader, row) : NULL;
    if (row == NULL || (value == NULL && row->default_json == NULL))
        return 0;
    if (value == NULL || !cJSON_IsArray(value)) { /* one alone; a default is one too */
        size_t before = reader->faults->count;
        out[0] = case_choice(reader, path);
        return reader->faults->count == before;
    }
    size_t n = 0;
    bool fits = value->child != NULL;
    for (const cJSON *item = value->child; item != NULL && fits; item = item->next) {
        const char *text = cJSON_IsString(item) ? item->valuestring : "";
        size_t choice = position(row->choices, strlen(text), text);
        fits = row->choices[choice] != NULL;
        for (size_t a = 0; a < n && fits; a++)
            fits = out[a] != choice;
        if (fits)
            out[n++] = choice;
    }
    if (fits)
        return n;
    fault_add(reader->faults, path, "must be different ones of the choices, such as [\"%s\"]",
              row->choices[0]);
    return 0;
}

double case_measure(const struct case_reader *reader, const char *path, size_t *unit) {
    const struct parameter *row = row_of(reader, path);
    const cJSON *value = row != NULL ? given(reader, row) : NULL;
    *unit = 0;
    if (row == NULL || (value == NULL && row->default_json == NULL))
        return NAN;
    if (value == NULL || !cJSON_IsObject(value)) {
        size_t before = reader->faults->count;
        *unit = case_choice(reader, path);
        return reader->faults->count == before ? INFINITY : NAN;
    }
    const cJSON *number = value->child;
    if (number != NULL && number->next == NULL && number_fits(row, number)) {
        *unit = position(row->units, strlen(number->string), number->string);
        if (row->units[*unit] != NULL)
            return number->valuedouble;
        *unit = 0;
    }
    fault_add(reader->faults, path, "must be one number in %c%g, %g] with its unit, such as \"%s\"",
              row->above_minimum ? '(' : '[', row->minimum, row->maximum, row->units[0]);
    return NAN;
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

int case_bins(const struct case_reader *reader, const char *path, size_t most, struct bins *out,
              struct error *err) {
    double *numbers;
    size_t n;
    int status = case_numbers(reader, path, &numbers, &n, err);
    if (status != 0 || numbers == NULL)
        return status;
    if (!(numbers[0] < numbers[1]))
        fault_add(reader->faults, path, "low, %g, must be below high, %g", numbers[0], numbers[1]);
    else if (!(numbers[2] >= 1 && numbers[2] <= (double)most && numbers[2] == floor(numbers[2])))
        fault_add(reader->faults, path, "the count, %g, must be an integer in [1, %zu]", numbers[2],
                  most);
    else
        *out = (struct bins){numbers[0], numbers[1], (size_t)numbers[2]};
    free(numbers);
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

/* Of one value as it was given; members of an object with their names. */
static uint64_t hash_value(uint64_t hash, const cJSON *value) {
    if (cJSON_IsNumber(value))
        return hash_number(hash, value->valuedouble);
    if (cJSON_IsString(value))
        return hash_bytes(hash, strlen(value->valuestring), value->valuestring);
    for (const cJSON *item = value->child; item != NULL; item = item->next) {
        if (item->string != NULL)
            hash = hash_bytes(hash, strlen(item->string), item->string);
        if (!cJSON_IsNumber(item)) /* so that ["ab"] is not ["a", "b"] */
            hash = hash_number(hash, 0);
        if (cJSON_IsNumber(item) || cJSON_IsString(item))
            hash = hash_value(hash, item);
    }
    return hash;
}

uint64_t case_fingerprint(const struct case_reader *reader) {
    uint64_t hash = HASH_START;
    for (size_t a = 0; a < reader->count; a++) {
        const cJSON *value = given(reader, &reader->table[a]);
        hash = hash_number(hash, (double)a);
        if (value == NULL)
            hash = hash_default(hash, reader->table[a].default_json);
        else
            hash = hash_value(hash, value);
    }
    return hash;
}
