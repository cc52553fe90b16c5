/* From the stored blocks of a case to one merger. */
#ifndef RUGO_WORKER_CASE_MERGE_H
#define RUGO_WORKER_CASE_MERGE_H

#include "jobs/merger.h"
#include "schema/store/store.h"

/* Merges all stored blocks of a case, of these parameters, in the order of their realisations.
 * *out, NULL on failure, is the caller's to destroy. ERROR_INPUT for blocks that cannot be merged,
 * such as those of an older program. */
int case_merge(struct store *store, const struct job_kind *kind, const char *study,
               uint64_t case_number, const cJSON *parameters, struct job_merger **out,
               struct error *err);

#endif
