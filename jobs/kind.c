#include "jobs/kind.h"
#include "core/rugo.h"
#include "jobs/fingerprint.h"
#include "jobs/memory.h"
#include "schema/result/bytes.h"
#include "schema/study/study_reader.h"
#include <stdlib.h>
#include <string.h>

/* A study may take this part of the memory there is; the rest is the system's. */
static const double MEMORY_PART = 0.9;

const struct job_kind *kind_of(const struct study_kind *study) {
    return (const struct job_kind *)study; /* its first member */
}

const struct job_kind *kind_find(const char *name) {
    for (size_t k = 0; JOB_KINDS[k] != NULL; k++)
        if (strcmp(JOB_KINDS[k]->name, name) == 0)
            return kind_of(JOB_KINDS[k]);
    return NULL;
}

/* A new version may compute other values in the same format. */
uint64_t kind_edition(const struct job_kind *kind) {
    const uint64_t marks[] = {kind->format, kind->format_version};
    uint64_t hash = hash_bytes(HASH_START, strlen(RUGO_VERSION), RUGO_VERSION);
    return hash_bytes(hash, sizeof marks, marks);
}

static int read_study(struct study **out, const char *text, size_t size,
                      const struct study_reading *reading, struct fault_list *faults,
                      struct error *err) {
    int status = study_read_ext(out, text, size, reading, faults, err);
    if (status == 0)
        (*out)->edition = kind_edition(kind_of((*out)->kind));
    return status;
}

int kind_read_study(struct study **out, const char *text, size_t size, const char *const *overrides,
                    struct fault_list *faults, struct error *err) {
    const struct study_reading reading = {.overrides = overrides,
                                          .kinds = JOB_KINDS,
                                          .memory_limit = MEMORY_PART * memory_available()};
    return read_study(out, text, size, &reading, faults, err);
}

int kind_read_study_until(struct study **out, const char *text, size_t size,
                          int (*stop)(void *context), void *context, struct fault_list *faults,
                          struct error *err) {
    const struct study_reading reading = {.kinds = JOB_KINDS,
                                          .memory_limit = MEMORY_PART * memory_available(),
                                          .stop = stop,
                                          .stop_context = context};
    return read_study(out, text, size, &reading, faults, err);
}

int kind_case_create(void **out, const struct job_kind *kind, const cJSON *parameters,
                     struct fault_list *faults, struct error *err) {
    void *study = array_create(1, kind->case_size);
    if (study == NULL)
        return error_memory(err, kind->case_size, "a case");
    int status = kind->read(study, parameters, faults, err);
    if (status != 0)
        kind_case_destroy(kind, &study);
    *out = study;
    return status;
}

void kind_case_destroy(const struct job_kind *kind, void **study) {
    if (*study != NULL && kind->clear != NULL)
        kind->clear(*study);
    free(*study);
    *study = NULL;
}

int kind_check(const struct study_kind *head, const cJSON *parameters, struct fault_list *faults,
               struct study_cost *cost, struct error *err) {
    const struct job_kind *kind = kind_of(head);
    void *study = NULL;
    size_t before = faults->count;
    int status = kind_case_create(&study, kind, parameters, faults, err);
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
