/* What the worker threads of one workers_run share, and how they pause and end. Private to
 * worker/. */
#ifndef RUGO_WORKER_WORKER_POOL_H
#define RUGO_WORKER_WORKER_POOL_H

#include "worker/lease_keeper.h"
#include "worker/shared_parts.h"
#include "worker/worker_options.h"
#include <pthread.h>
#include <stdatomic.h>

enum { NAME_MOST = 256 };

struct worker_pool {
    const struct worker_options *options; /* borrowed */
    char name[NAME_MOST];        /* of the process; a thread's name is this and its number */
    struct lease_keeper *keeper; /* owned */
    struct shared_parts parts;   /* what the runners of a case share; has its own lock */
    pthread_mutex_t lock;
    pthread_cond_t changed; /* signalled when `ending` is set and when a thread ends */
    atomic_bool ending;     /* written under the lock, read without it */
    unsigned at_work;       /* threads that have not ended; protected by the lock */
    int status;             /* of the first error that waiting cannot cure; protected by the lock */
    struct error err;       /* belongs to status */
};

/* A thread remembers the length of its last pause in milliseconds; initialise to {0}. */
struct backoff {
    int64_t ms;
};

/* Makes all threads end after the realisation that they are in. */
void worker_pool_end(struct worker_pool *pool);
/* Ends all threads because of an error; the pool keeps the first error only. */
void worker_pool_fail(struct worker_pool *pool, const struct error *err);
/* Waits until worker_pool_end, or for a pause twice as long as the last one, at most most_ms. The
 * second half of a pause has a random length, so that many workers do not come back at once. */
void worker_pool_pause(struct worker_pool *pool, struct backoff *backoff, int64_t most_ms);

#endif
