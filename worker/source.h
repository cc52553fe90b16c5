/* Where a worker's jobs come from: a local store or a server, behind the same functions. A source
 * must be used by one thread at a time. */
#ifndef RUGO_WORKER_SOURCE_H
#define RUGO_WORKER_SOURCE_H

#include "jobs/kind.h"
#include "schema/store/store.h"
#include "worker/source_options.h"

struct source;
int source_create(struct source **out, const struct source_options *options, struct error *err);
void source_destroy(struct source **source);

/* Failures have the codes of store.h: ERROR_STATE when the lease is lost or the study cancelled,
 * ERROR_SYSTEM when there is no answer or the store is busy, so that a retry may succeed. */
int source_claim(struct source *source, struct claimed_job *job, int *found, struct error *err);
/* *left: whether a job waits or runs anywhere, so that one may still have to be claimed. Of a
 * server, only studies that this token may list count; *left is 0 when it may list none. */
int source_left(struct source *source, int *left, struct error *err);
int source_heartbeat(struct source *source, const struct claimed_job *job, uint64_t done,
                     struct error *err);
/* A source of a store also publishes the case after its last block. */
int source_complete(struct source *source, const struct claimed_job *job,
                    const struct block_result *result, struct error *err);
int source_fail(struct source *source, const struct claimed_job *job, const char *reason,
                int permanent, struct error *err);
int source_release(struct source *source, const struct claimed_job *job, struct error *err);

#endif
