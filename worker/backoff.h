/* Growing pauses between attempts: at what failed and may pass, or at what is not there yet. */
#ifndef RUGO_WORKER_BACKOFF_H
#define RUGO_WORKER_BACKOFF_H

#include <stdint.h>

/* Remembers the length of the last pause in milliseconds; {0} at first, and after a success. */
struct backoff {
    int64_t ms;
};
/* Returns the next pause: up to twice the last one, at most most_ms. Its second half has a random
 * length, so that many workers do not come back at once. */
int64_t backoff_next(struct backoff *backoff, int64_t most_ms);

#endif
