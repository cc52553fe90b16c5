/* What benches share: CPU time of the process, and medians. */
#ifndef RUGO_TESTS_SUPPORT_TIMING_H
#define RUGO_TESTS_SUPPORT_TIMING_H

#include <stdlib.h>
#include <time.h>

static inline double cpu_ms(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

/* For qsort of doubles. */
static inline int by_value(const void *a, const void *b) {
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* Sorts the values. */
static inline double median(double *values, size_t count) {
    qsort(values, count, sizeof *values, by_value);
    return values[count / 2];
}

#endif
