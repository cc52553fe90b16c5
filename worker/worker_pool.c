#include "worker/worker_pool.h"
#include "worker/clock.h"

#include <sys/random.h>

enum { PAUSE_FIRST_MS = 50 };

void worker_pool_end(struct worker_pool *pool) {
    pthread_mutex_lock(&pool->lock);
    atomic_store(&pool->ending, true);
    pthread_cond_broadcast(&pool->changed);
    pthread_mutex_unlock(&pool->lock);
}

void worker_pool_fail(struct worker_pool *pool, const struct error *err) {
    pthread_mutex_lock(&pool->lock);
    if (pool->status == 0) {
        pool->status = err->code;
        pool->err = *err;
    }
    pthread_mutex_unlock(&pool->lock);
    worker_pool_end(pool);
}

/* The upper half of a pause is random. */
void worker_pool_pause(struct worker_pool *pool, struct backoff *backoff, int64_t most_ms) {
    int64_t pause = backoff->ms != 0 ? 2 * backoff->ms : PAUSE_FIRST_MS;
    backoff->ms = pause < most_ms ? pause : most_ms;
    uint32_t word = 0;
    if (getrandom(&word, sizeof word, GRND_NONBLOCK) != (ssize_t)sizeof word)
        word = 0; /* no jitter then */
    int64_t until = clock_ms() + backoff->ms / 2 + (backoff->ms / 2) * (int64_t)word / UINT32_MAX;
    pthread_mutex_lock(&pool->lock);
    while (!atomic_load(&pool->ending) && clock_ms() < until)
        clock_cond_wait(&pool->changed, &pool->lock, until);
    pthread_mutex_unlock(&pool->lock);
}
