/* How the worker threads of a process shall work. */
#ifndef RUGO_WORKER_WORKER_OPTIONS_H
#define RUGO_WORKER_WORKER_OPTIONS_H

#include "worker/source_options.h"
#include <stdatomic.h>
#include <stdbool.h>

struct worker_options {
    struct source_options source; /* worker and host may be NULL */
    unsigned threads;             /* at least 1 */
    bool drain;                   /* end when no job is waiting and none is running */
    unsigned idle_s;              /* end when no job has run for so long; 0: never */
    const atomic_int *stop;       /* non-zero: release the job at once and end; may be NULL */
    /* Called from time to time on the caller's thread (twice a second); non-zero ends. May be NULL.
     */
    int (*tick)(void *context);
    void *context;
};

#endif
