/* Cases that ask for an error: their components merged into an answer, and planned on. */
#ifndef RUGO_WORKER_TARGET_H
#define RUGO_WORKER_TARGET_H

#include "schema/store/store.h"

struct job_kind;

/* A case with components, as it stands in the store. */
struct target_case {
    const struct job_kind *kind;
    const char *study;
    uint64_t case_number;
    const struct case_info *info;
    size_t count;
    struct component *components; /* owned, by components_free */
};
/* Merges what the components have into an empty result; wanted, of count places, is filled with
 * the realisations that each is to have in all. */
int target_answer(struct store *store, const struct target_case *of, uint64_t *wanted,
                  struct case_result *out, struct error *err);
/* The same where all jobs of the components have ended: queues what is missing, if anything is.
 * *grown: then the case is not to be published yet, and out is cleared. */
int target_round(struct store *store, const struct target_case *of, struct case_result *out,
                 bool *grown, struct error *err);

#endif
