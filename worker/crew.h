/* What the threads of one workers_run share. Private to worker.c and hand.c. */
#ifndef RUGO_WORKER_CREW_H
#define RUGO_WORKER_CREW_H

#include "worker/keeper.h"
#include "worker/shared_parts.h"
#include "worker/worker.h"
#include <pthread.h>
#include <stdatomic.h>

enum { NAME_MOST = 256 };

struct crew {
    const struct worker_options *options;
    char name[NAME_MOST]; /* of the process */
    struct keeper *keeper;
    struct shared_parts parts; /* what the runners of a case share; has a lock of its own */
    pthread_mutex_t lock;
    pthread_cond_t changed; /* ending, or a thread ended */
    atomic_bool ending;     /* set under the lock, read anywhere */
    unsigned at_work;       /* threads that have not ended; under the lock, as what follows */
    int status;             /* of the first error that cannot be waited out */
    struct error err;
};

/* Growing pauses; start from {0}. */
struct backoff {
    int64_t ms;
};

/* Tells all threads to end. */
void crew_end(struct crew *crew);
/* The same, because of an error; the first one is kept. */
void crew_fail(struct crew *crew, const struct error *err);
/* Waits for the next pause of the row, doubled up to most_ms, or for the end. The jitter (a random
 * half) keeps many workers from coming back all at once. */
void crew_pause(struct crew *crew, struct backoff *backoff, int64_t most_ms);

#endif
