#include "worker/memory_budget.h"
#include "worker/clock.h"

int memory_budget_init(struct memory_budget *budget, double limit, struct error *err) {
    *budget = (struct memory_budget){.limit = limit, .lock = PTHREAD_MUTEX_INITIALIZER};
    return clock_cond_init(&budget->given) == 0
               ? 0
               : error_set(err, ERROR_SYSTEM, "cannot make a condition");
}

void memory_budget_destroy(struct memory_budget *budget) {
    pthread_cond_destroy(&budget->given);
}

int memory_budget_take(struct memory_budget *budget, double bytes, int (*stop)(void *context),
                       void *context, struct error *err) {
    enum { POLL_MS = 100 };
    int status = 0;
    if (budget->limit > 0 && bytes > budget->limit)
        return error_set(err, ERROR_MEMORY,
                         "the case needs about %.3g GB of memory, and the jobs of this process may "
                         "use %.3g GB, 0.9 of what the machine, a control group or Slurm gives",
                         bytes / 1e9, budget->limit / 1e9);
    pthread_mutex_lock(&budget->lock);
    while (status == 0 && budget->limit > 0 && budget->taken > 0 &&
           budget->taken + bytes > budget->limit) {
        clock_cond_wait(&budget->given, &budget->lock, clock_ms() + POLL_MS);
        pthread_mutex_unlock(&budget->lock);
        if (stop(context) != 0)
            status = error_set(err, ERROR_STOPPED, "stopped while it waited for memory");
        pthread_mutex_lock(&budget->lock);
    }
    if (status == 0)
        budget->taken += bytes;
    pthread_mutex_unlock(&budget->lock);
    return status;
}

void memory_budget_give(struct memory_budget *budget, double bytes) {
    pthread_mutex_lock(&budget->lock);
    budget->taken -= bytes;
    pthread_cond_broadcast(&budget->given);
    pthread_mutex_unlock(&budget->lock);
}
