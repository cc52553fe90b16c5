/* When a queue of jobs will have been worked off. */
#ifndef RUGO_SCHEMA_STORE_SCHEDULE_H
#define RUGO_SCHEMA_STORE_SCHEDULE_H

#include <stddef.h>

/* The seconds until all is done, where each worker that becomes free takes the next job. loads[n],
 * n > 0: what each worker has before it, which is changed; bulk: seconds of jobs in front of the
 * last ones, so many and so short that they are shared out evenly; last[count]: seconds of the last
 * jobs, in their order. */
double schedule_end(double *loads, size_t n, double bulk, const double *last, size_t count);

#endif
