/* Checks results before they are stored: a stored result that its kind cannot merge would prevent
 * its case from being merged at all.
 *
 * A merger of a case may take seconds to make (it sums a whole spectrum), and results come of few
 * cases at a time: the mergers used last are kept. Safe from many threads. */
#ifndef RUGO_WORKER_CHECKER_H
#define RUGO_WORKER_CHECKER_H

#include "schema/store/store.h"

struct checker;
int checker_create(struct checker **out, struct error *err);
void checker_destroy(struct checker **checker);
/* Fails with ERROR_INPUT when the result does not belong to this job's case. */
int checker_check(struct checker *checker, const struct claimed_job *job,
                  const struct block_result *result, struct error *err);

#endif
