/* Where a worker's jobs come from: the local store or a server, behind one face. One thread each.
 */
#ifndef RUGO_WORKER_SOURCE_H
#define RUGO_WORKER_SOURCE_H

#include "jobs/kind.h"
#include "schema/store/store.h"

struct source;
struct source_options {
    const char *database; /* one of database and url */
    const char *url;
    const char *token;
    const char *study; /* only this study's jobs; NULL any (store only) */
    const char *worker, *host;
    int64_t lease_ms; /* of jobs claimed here (store only); 0: the store's default */
};
int source_create(struct source **out, const struct source_options *options, struct error *err);
void source_destroy(struct source **source);

/* Codes as store.h: ERROR_STATE lost lease or cancelled; ERROR_SYSTEM: no answer or busy, try
 * again. */
int source_claim(struct source *source, struct claimed_job *job, int *found, struct error *err);
/* Whether jobs wait or run anywhere, so that more may come. A server is asked only for what it
 * lists to this token; where it refuses, nothing is left. */
int source_left(struct source *source, int *left, struct error *err);
int source_heartbeat(struct source *source, const struct claimed_job *job, uint64_t done,
                     struct error *err);
/* With a store, also publishes the case when this was its last block. */
int source_complete(struct source *source, const struct claimed_job *job,
                    const struct job_kind *kind, const struct job_result *result,
                    struct error *err);
int source_fail(struct source *source, const struct claimed_job *job, const char *reason,
                int permanent, struct error *err);
int source_release(struct source *source, const struct claimed_job *job, struct error *err);

#endif
