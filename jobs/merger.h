/* Merges blocks of a case, whatever the kind: in any order, to the same bits.
 *
 * Life: merger_create -> merger_add (each block once) -> merger_result -> merger_destroy. */
#ifndef RUGO_JOBS_MERGER_H
#define RUGO_JOBS_MERGER_H

#include "jobs/kind.h"

struct job_merger;
int merger_create(struct job_merger **out, const struct job_kind *kind, const cJSON *parameters,
                  struct error *err);
void merger_destroy(struct job_merger **merger);
/* Returns 0 if merger_add would take the block, or its error. Changes nothing, so that many threads
 * may call it with one merger. */
int merger_fits(const struct job_merger *merger, const struct block_result *result,
                struct error *err);
/* Decodes and adds one block; ERROR_INPUT for data that is not this case's (nothing added). After
 * ERROR_MEMORY the merger can only be destroyed. */
int merger_add(struct job_merger *merger, const struct block_result *result, struct error *err);
/* Fills an empty result with all that was added: number of realisations, scalars, curves, notes. On
 * failure the result is cleared. */
int merger_result(const struct job_merger *merger, struct case_result *out, struct error *err);
/* Return the kind's case and tally, and the number of realisations in it; borrowed. */
const void *merger_case(const struct job_merger *merger);
const void *merger_tally(const struct job_merger *merger, uint64_t *realisations);
/* Return what pairs.h needs: the realisations in their order, the values of a point of a curve or
 * its sums by groups, and the values of a scalar with their weights (as job_kind has them). */
const struct realisations *merger_realisations(const struct job_merger *merger);
bool merger_point(const struct job_merger *merger, const struct curve *curve, size_t at,
                  struct point_values *out);
bool merger_groups(const struct job_merger *merger, const struct curve *curve, size_t at,
                   struct point_groups *out);
int merger_scalar(const struct job_merger *merger, size_t scalar, double *values, double *weights,
                  struct error *err);
/* Finds the number of a scalar of a realisation; false for another name. */
bool merger_find_scalar(const struct job_merger *merger, const char *name, size_t *scalar);
/* Makes the theories of which curves of such a case have the name alone. */
int merger_complete(const struct job_kind *kind, const cJSON *parameters,
                    struct case_result *result, struct error *err);

#endif
