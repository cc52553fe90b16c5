/* The worker: threads that claim a job, run it and report it, until they are stopped or the queue
 * is empty.
 *
 * Each thread has its own runner. One more, the dispatcher (dispatcher.h), claims, renews leases
 * and hands in results for all of them, so that a process has one connection to its server. */
#ifndef RUGO_WORKER_WORKER_H
#define RUGO_WORKER_WORKER_H

#include "core/error.h"
#include "worker/link/source_options.h"
#include <stdatomic.h>
#include <stdbool.h>

/* Options of the worker threads of a process. */

struct worker_options {
    struct source_options source; /* worker and host may be NULL */
    unsigned threads;             /* at least 1 */
    bool drain;                   /* end when no job is waiting and none is running */
    unsigned idle_s;              /* end when no job has run for so long; 0: never */
    int64_t grace_ms;             /* how long a realisation may go on after a stop; 0: 2 s */
    int64_t until_ms;             /* of dispatcher_options */
    const atomic_int *stop;       /* non-zero: release the job at once and end; may be NULL */
    /* Called twice a second on the caller's thread; non-zero ends the workers. May be NULL. */
    int (*tick)(void *context);
    void *context;
};

/* Returns when drained or stopped: 0, or ERROR_STOPPED; or the first error that a later try cannot
 * cure. */
int workers_run(const struct worker_options *options, struct error *err);

#endif
