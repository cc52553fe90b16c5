/* What the worker threads of one workers_run share, and how they end. Private to worker/. */
#ifndef RUGO_WORKER_WORKER_POOL_H
#define RUGO_WORKER_WORKER_POOL_H

#include "worker/dispatcher.h"
#include "worker/shared_parts.h"
#include "worker/worker_options.h"
#include <pthread.h>
#include <stdatomic.h>

enum { NAME_MOST = 256 };

struct worker_pool {
    const struct worker_options *options; /* borrowed */
    char name[NAME_MOST];          /* of the process; a thread's name is this and its number */
    struct dispatcher *dispatcher; /* owned */
    struct shared_parts parts;     /* what the runners of a case share; has its own lock */
    pthread_mutex_t lock;
    pthread_cond_t changed; /* signalled when a thread ends */
    atomic_bool ending;
    atomic_uint computing; /* threads that run a job, not those that wait for an answer */
    unsigned at_work;      /* threads that have not ended; protected by the lock */
};

#endif
