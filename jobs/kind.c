#include "jobs/kind.h"
#include "core/rugo.h"
#include "schema/result/bytes/bytes.h"
#include "schema/study/value.h"
#include <stdlib.h>
#include <string.h>

static uint64_t hash_number(uint64_t hash, double number) {
    return hash_bytes(hash, sizeof number, &number);
}

static uint64_t hash_text(uint64_t hash, const char *text) {
    return hash_bytes(hash, strlen(text), text);
}

/* Hashes one value; members of an object with their names. */
static uint64_t hash_value(uint64_t hash, const cJSON *value) {
    if (cJSON_IsNumber(value))
        return hash_number(hash, value->valuedouble);
    if (cJSON_IsString(value))
        return hash_text(hash, value->valuestring);
    for (const cJSON *item = value->child; item != NULL; item = item->next) {
        if (item->string != NULL)
            hash = hash_text(hash, item->string);
        if (!cJSON_IsNumber(item)) /* so that ["ab"] is not ["a", "b"] */
            hash = hash_number(hash, 0);
        if (cJSON_IsNumber(item) || cJSON_IsString(item))
            hash = hash_value(hash, item);
    }
    return hash;
}

uint64_t case_fingerprint(const struct values *values,
                          const struct parameter_table *const *tables) {
    uint64_t hash = HASH_START;
    const struct parameter *row;
    double number = 0;
    for (size_t p = 0; (row = parameter_row(tables, p)) != NULL; p++) {
        if (row->later)
            continue;
        hash = hash_number(hash, number++);
        if (values_json(values, p) != NULL)
            hash = hash_value(hash, values_json(values, p));
    }
    for (size_t p = 0; (row = parameter_row(tables, p)) != NULL; p++)
        if (row->later && !values_is_default(values, p))
            hash = hash_value(hash_text(hash, row->path), values_json(values, p));
    return hash;
}

const struct job_kind *kind_of(const struct study_kind *study) {
    return (const struct job_kind *)study; /* its first member */
}

/* A new version may compute other values in the same format. */
uint64_t kind_edition(const struct job_kind *kind) {
    const uint64_t marks[] = {kind->format, kind->format_version};
    uint64_t hash = hash_bytes(HASH_START, strlen(RUGO_VERSION), RUGO_VERSION);
    return hash_bytes(hash, sizeof marks, marks);
}

static int case_create(void **out, const struct job_kind *kind, const cJSON *parameters,
                       double memory_limit, struct fault_list *faults, struct error *err) {
    void *study = array_create(1, kind->case_size);
    if (study == NULL)
        return error_memory(err, kind->case_size, "a case");
    int status = kind->read(study, parameters, memory_limit, faults, err);
    if (status != 0)
        kind_case_destroy(kind, &study);
    *out = study;
    return status;
}

int kind_case_create(void **out, const struct job_kind *kind, const cJSON *parameters,
                     struct fault_list *faults, struct error *err) {
    return case_create(out, kind, parameters, 0, faults, err);
}

void kind_case_destroy(const struct job_kind *kind, void **study) {
    if (*study != NULL && kind->clear != NULL)
        kind->clear(*study);
    free(*study);
    *study = NULL;
}

int kind_check(const struct study_kind *head, const cJSON *parameters, double memory_limit,
               struct fault_list *faults, struct study_cost *cost, struct error *err) {
    const struct job_kind *kind = kind_of(head);
    void *study = NULL;
    size_t before = faults->count;
    int status = case_create(&study, kind, parameters, memory_limit, faults, err);
    if (status != 0)
        return status == ERROR_INPUT && faults->count > before ? 0 : status;
    kind->estimate(study, cost);
    kind_case_destroy(kind, &study);
    return 0;
}

int kind_fingerprint(const struct job_kind *kind, const cJSON *parameters, uint64_t *out,
                     struct error *err) {
    struct values *values = NULL;
    int status = values_create(&values, parameters, kind->study.tables, NULL, err);
    if (status == 0)
        *out = case_fingerprint(values, kind->study.tables);
    values_destroy(&values);
    return status;
}

size_t kind_scalar_count(const struct job_kind *kind) {
    size_t count = 0;
    while (kind->scalar(count) != NULL)
        count++;
    return count;
}

int kind_check_names(const struct job_kind *kind, const struct block_result *result,
                     struct error *err) {
    size_t count = kind_scalar_count(kind);
    for (size_t a = 0; a < count; a++)
        if (a >= result->scalar_count || strcmp(kind->scalar(a), result->names[a]) != 0)
            return error_set(err, ERROR_INPUT,
                             "scalars: number %zu is not \"%s\", as in other versions of the "
                             "program; rugo retry computes it anew",
                             a, kind->scalar(a));
    if (result->scalar_count != count)
        return error_set(err, ERROR_INPUT,
                         "scalars: %zu names; allowed: %zu; rugo retry computes it anew",
                         result->scalar_count, count);
    return 0;
}
