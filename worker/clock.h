/* Times and waits by CLOCK_MONOTONIC, which cannot be set. */
#ifndef RUGO_WORKER_CLOCK_H
#define RUGO_WORKER_CLOCK_H

#include <pthread.h>
#include <stdint.h>

/* Returns the milliseconds since an arbitrary start. */
int64_t clock_ms(void);
/* Initialises a condition for clock_cond_wait; returns what pthread_cond_init returns. */
int clock_cond_init(pthread_cond_t *cond);
/* Waits at most until clock_ms() is until_ms, and may return early. The caller holds the mutex. */
void clock_cond_wait(pthread_cond_t *cond, pthread_mutex_t *mutex, int64_t until_ms);

#endif
