/* Waiting on CLOCK_MONOTONIC, which nobody can set. */
#ifndef RUGO_WORKER_CLOCK_H
#define RUGO_WORKER_CLOCK_H

#include <pthread.h>
#include <stdint.h>

int64_t clock_ms(void);
/* A condition whose waits end by clock_ms; non-zero as pthread_cond_init. */
int clock_cond_init(pthread_cond_t *cond);
/* Waits at most until clock_ms() is until_ms; may end early. The mutex is held. */
void clock_cond_wait(pthread_cond_t *cond, pthread_mutex_t *mutex, int64_t until_ms);

#endif
