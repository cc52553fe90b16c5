/* Runs realisations of a case, block by block, whatever the kind.
 *
 * Life: shared_create (once a case and process) -> runner_create (one a thread) -> runner_run
 * (blocks) -> runner_destroy -> shared_destroy. */
#ifndef RUGO_JOBS_RUNNER_H
#define RUGO_JOBS_RUNNER_H

#include "jobs/kind.h"

/* Called between realisations, and repeatedly within one that may take long, with how many of the
 * block are done, and the share of the next one where its kind knows it; non-zero stops the
 * block. */
struct job_control {
    int (*poll)(void *context, double done);
    void *context;
};

/* What all runners of a case share. *out is NULL for kinds that share nothing. */
struct job_shared;
int job_shared_create(struct job_shared **out, const struct job_kind *kind, const cJSON *parameters,
                      struct error *err);
void job_shared_destroy(struct job_shared **shared);
const void *job_shared_content(const struct job_shared *shared); /* the kind's struct */

struct job_runner;
/* shared is of the same parameters and borrowed for the life of the runner. NULL: the kind shares
 * nothing, or the runner makes its own. seed and sequence: of the random numbers
 * (core/random.h). */
int runner_create(struct job_runner **out, const struct job_kind *kind, const cJSON *parameters,
                  const struct job_shared *shared, uint64_t seed, uint64_t sequence,
                  struct error *err);
/* Lets a team of threads work along in each realisation, with the same digits; it is borrowed until
 * runner_destroy. Kinds whose realisations take one thread ignore it. ERROR_MEMORY. */
int runner_set_team(struct job_runner *runner, struct team *team, struct error *err);
void runner_destroy(struct job_runner **runner);
/* Runs realisations first .. first + count - 1 into out (untouched on failure), which the caller
 * clears. control may be NULL. A block that is stopped has the realisations that were done, fewer
 * than count; ERROR_STOPPED where none was, or where a part of the next one is in the tally
 * (job_kind, stops_half_way). */
int runner_run(struct job_runner *runner, uint64_t first, uint64_t count,
               const struct job_control *control, struct block_result *out, struct error *err);

#endif
