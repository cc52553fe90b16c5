/* One block of realisations, whatever the kind: one after the other, asking in between whether to
 * stop. */
#ifndef RUGO_JOBS_BLOCK_H
#define RUGO_JOBS_BLOCK_H

#include "jobs/kind.h"

/* What a kind does in a block; context is its own. */
struct block_work {
    void *context;
    size_t scalar_count;
    const char *(*scalar)(size_t at); /* their names */
    /* The realisation, before which so many of the block are done, into the kind's sums and into
     * scalars[scalar_count]. */
    int (*realise)(void *context, uint64_t realisation, uint64_t done, double *scalars,
                   struct error *err);
    /* The sums as bytes, which the caller owns. */
    int (*encode)(void *context, unsigned char **data, size_t *size, struct error *err);
};

/* Whether the one who asked for the block wants it stopped; control may be NULL. */
bool block_stopped(const struct job_control *control, uint64_t done);
/* As run of struct job_kind. */
int block_run(const struct block_work *work, uint64_t first, uint64_t count,
              const struct job_control *control, struct block_result *out, struct error *err);

#endif
