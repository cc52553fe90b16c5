/* Time that passes, in seconds. */
#ifndef RUGO_JOBS_CLOCK_H
#define RUGO_JOBS_CLOCK_H

#include <math.h>
#include <time.h>

/* CLOCK_MONOTONIC never steps; CLOCK_THREAD_CPUTIME_ID counts what this thread computes, without
 * its waits, and CLOCK_PROCESS_CPUTIME_ID what all threads do. NaN where there is no such clock. */
static inline double clock_seconds(clockid_t clock) {
    struct timespec now;
    if (clock_gettime(clock, &now) != 0)
        return (double)NAN;
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
