#include "worker/clock.h"

#include <time.h>

int64_t clock_ms(void) {
    struct timespec now = {0};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

int clock_cond_init(pthread_cond_t *cond) {
    pthread_condattr_t attributes;
    int status = pthread_condattr_init(&attributes);
    if (status != 0)
        return status;
    status = pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    status = status != 0 ? status : pthread_cond_init(cond, &attributes);
    pthread_condattr_destroy(&attributes);
    return status;
}

void clock_cond_wait(pthread_cond_t *cond, pthread_mutex_t *mutex, int64_t until_ms) {
    struct timespec until = {.tv_sec = (time_t)(until_ms / 1000),
                             .tv_nsec = (long)(until_ms % 1000) * 1000000};
    pthread_cond_timedwait(cond, mutex, &until);
}
