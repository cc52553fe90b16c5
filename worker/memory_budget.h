/* The memory that the jobs of a process take at once, by what their cases are estimated to need. A
 * case that does not fit beside those at work waits until they have ended; one that does not fit
 * alone is refused. Without this a process with many threads on large cases would be killed. */
#ifndef RUGO_WORKER_MEMORY_BUDGET_H
#define RUGO_WORKER_MEMORY_BUDGET_H

#include "core/error.h"
#include <pthread.h>

struct memory_budget {
    double limit; /* bytes; 0: none */
    pthread_mutex_t lock;
    pthread_cond_t given; /* signalled when some is given back */
    double taken;         /* bytes; protected by the lock */
};
int memory_budget_init(struct memory_budget *budget, double limit, struct error *err);
/* The caller must have given all back. */
void memory_budget_destroy(struct memory_budget *budget);

/* Takes bytes, for which it waits. ERROR_STOPPED once stop, which is called ten times a second
 * meanwhile, is not 0; ERROR_MEMORY where they are beyond the limit. Then nothing is taken. */
int memory_budget_take(struct memory_budget *budget, double bytes, int (*stop)(void *context),
                       void *context, struct error *err);
/* Gives back what was taken. */
void memory_budget_give(struct memory_budget *budget, double bytes);

#endif
