/* From the stored blocks of a case to one merger. */
#ifndef RUGO_WORKER_CASE_MERGE_H
#define RUGO_WORKER_CASE_MERGE_H

#include "jobs/merger.h"
#include "schema/store/store.h"

/* Merges all stored blocks of a case, of which info tells, in the order of their realisations.
 * *out, NULL on failure, is the caller's to destroy. ERROR_INPUT for blocks that cannot be merged,
 * such as those of an older program or damaged ones, and where there are fewer realisations than
 * the case counts. */
int case_merge(struct store *store, const struct job_kind *kind, const char *study,
               uint64_t case_number, const struct case_info *info, struct job_merger **out,
               struct error *err);

#endif
