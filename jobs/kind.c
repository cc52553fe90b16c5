#include "jobs/kind.h"
#include <string.h>
#include <time.h>

/* One line a kind; each is defined in the file of its name. */
#define KINDS(KIND) KIND(STATISTICS_KIND) KIND(CONTACT_KIND)

#define DECLARE(kind) extern const struct job_kind kind;
KINDS(DECLARE)

#define ADDRESS(kind) &(kind),
const struct job_kind *const JOB_KINDS[] = {KINDS(ADDRESS)};
const size_t JOB_KIND_COUNT = sizeof JOB_KINDS / sizeof JOB_KINDS[0];

const struct job_kind *kind_find(const char *name) {
    for (size_t a = 0; a < JOB_KIND_COUNT; a++)
        if (strcmp(JOB_KINDS[a]->name, name) == 0)
            return JOB_KINDS[a];
    return NULL;
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
            return error_set(err, ERROR_INPUT, "scalars: number %zu is not \"%s\"", a,
                             kind->scalar(a));
    if (result->scalar_count != count)
        return error_set(err, ERROR_INPUT, "scalars: %zu names; allowed: %zu", result->scalar_count,
                         count);
    return 0;
}

double job_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
