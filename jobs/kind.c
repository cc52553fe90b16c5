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

double job_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
