/* Merges blocks of a case, whatever the kind: in any order, to the same bits.
 *
 * Life: merger_create -> merger_add (each block once) -> merger_curves -> merger_destroy. */
#ifndef RUGO_JOBS_MERGER_H
#define RUGO_JOBS_MERGER_H

#include "jobs/kind.h"

struct job_merger;
int merger_create(struct job_merger **out, const struct job_kind *kind, const cJSON *parameters,
                  struct error *err);
void merger_destroy(struct job_merger **merger);
/* Whether merger_add would take the block: 0 or its error. Changes nothing, so that many threads
 * may ask one merger. */
int merger_fits(const struct job_merger *merger, const struct block_result *result,
                struct error *err);
/* Decodes and adds one block; ERROR_INPUT for data that is not this case's (nothing added). */
int merger_add(struct job_merger *merger, const struct block_result *result, struct error *err);
/* Of all that was added (job_kind.curves); caller deletes *out. */
int merger_curves(const struct job_merger *merger, cJSON **out, struct error *err);

#endif
