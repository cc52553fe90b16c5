/* The time until the jobs of a queue are done. */
#ifndef RUGO_SCHEMA_STORE_SCHEDULE_H
#define RUGO_SCHEMA_STORE_SCHEDULE_H

#include <stddef.h>

/* Returns the seconds until all jobs are done, where each worker that becomes free takes the next
 * one. loads[n], n > 0: seconds of each worker before that, which are changed. bulk: seconds of the
 * first jobs, which are so many and so short that they are divided evenly. last[count]: seconds of
 * the last jobs, in their order. */
double schedule_end(double *loads, size_t n, double bulk, const double *last, size_t count);

#endif
