/* What looks at the table of kinds: a kind by its name, and studies of the kinds there are. Kinds
 * do not call it. */
#include "jobs/allotment.h"
#include "jobs/kind.h"
#include "schema/study/study_reader.h"
#include <string.h>

double kind_memory_limit(void) {
    static const double CASES = 0.9; /* the rest is the system's */
    return CASES * allotment_memory();
}

const struct job_kind *kind_find(const char *name) {
    for (size_t k = 0; JOB_KINDS[k] != NULL; k++)
        if (strcmp(JOB_KINDS[k]->name, name) == 0)
            return kind_of(JOB_KINDS[k]);
    return NULL;
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
    const struct study_reading reading = {
        .overrides = overrides, .kinds = JOB_KINDS, .memory_limit = kind_memory_limit()};
    return read_study(out, text, size, &reading, faults, err);
}

int kind_read_study_until(struct study **out, const char *text, size_t size,
                          int (*stop)(void *context), void *context, struct fault_list *faults,
                          struct error *err) {
    const struct study_reading reading = {.kinds = JOB_KINDS,
                                          .memory_limit = kind_memory_limit(),
                                          .stop = stop,
                                          .stop_context = context};
    return read_study(out, text, size, &reading, faults, err);
}
