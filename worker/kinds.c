#include "worker/kinds.h"
#include "worker/memory.h"

#include <pthread.h>

/* A study may take this part of the memory there is; the rest is the system's. */
static const double MEMORY_PART = 0.9;

static int check_kind(const void *context, const cJSON *parameters, struct fault_list *faults,
                      struct study_cost *cost, struct error *err) {
    return kind_check(context, parameters, faults, cost, err);
}

enum { KINDS_MOST = 8 };

/* Written once, before anyone has it to read. */
static struct study_kind kinds[KINDS_MOST];
static pthread_once_t kinds_once = PTHREAD_ONCE_INIT;

static void kinds_fill(void) {
    for (size_t n = 0; n < kinds_count(); n++) {
        const struct job_kind *kind = JOB_KINDS[n];
        kinds[n] = (struct study_kind){
            .name = kind->name,
            .tables = kind->tables,
            .default_realisations = kind->default_realisations,
            .check = check_kind,
            .context = kind,
        };
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
