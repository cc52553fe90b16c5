#include "worker/kinds.h"
#include "worker/memory.h"

#include <pthread.h>

/* A study may take this part of the memory there is; the rest is the system's. */
static const double MEMORY_PART = 0.9;

/* study_kind.check is told no kind, so each place of the table has an adapter of its own. */
static int check_kind(size_t n, const cJSON *parameters, struct fault_list *faults,
                      struct study_cost *cost, struct error *err) {
    struct job_estimate estimate = {0};
    int status = JOB_KINDS[n]->check(parameters, faults, &estimate, err);
    if (!status) {
        *cost = (struct study_cost){
            .nx = estimate.nx,
            .ny = estimate.ny,
            .memory_bytes = estimate.memory_bytes,
            .seconds = estimate.seconds,
            .relative_error = estimate.relative_error,
        };
    }
    return status;
}

#define ADAPTER(n)                                                                                 \
    static int check_##n(const cJSON *parameters, struct fault_list *faults,                       \
                         struct study_cost *cost, struct error *err) {                             \
        return check_kind(n, parameters, faults, cost, err);                                       \
    }
ADAPTER(0)
ADAPTER(1)
ADAPTER(2)
ADAPTER(3)
ADAPTER(4)
ADAPTER(5)
ADAPTER(6)
ADAPTER(7)
#undef ADAPTER

enum { KINDS_MOST = 8 };

/* Written once, before anyone has it to read. */
static struct study_kind kinds[KINDS_MOST] = {
    {.check = check_0}, {.check = check_1}, {.check = check_2}, {.check = check_3},
    {.check = check_4}, {.check = check_5}, {.check = check_6}, {.check = check_7},
};
static pthread_once_t kinds_once = PTHREAD_ONCE_INIT;

static void kinds_fill(void) {
    for (size_t n = 0; n < kinds_count(); n++) {
        const struct job_kind *kind = JOB_KINDS[n];
        kinds[n].name = kind->name;
        kinds[n].parameters = kind->parameters;
        kinds[n].parameter_count = kind->parameter_count;
        kinds[n].default_realisations = kind->default_realisations;
    }
}

const struct study_kind *kinds_table(void) {
    pthread_once(&kinds_once, kinds_fill);
    return kinds;
}

size_t kinds_count(void) {
    return JOB_KIND_COUNT < KINDS_MOST ? JOB_KIND_COUNT : KINDS_MOST;
}

int kinds_read_study(struct study **out, const char *text, size_t size,
                     const char *const *overrides, struct fault_list *faults, struct error *err) {
    return study_read(out, text, size, overrides, kinds_table(), kinds_count(),
                      MEMORY_PART * memory_available(), faults, err);
}
