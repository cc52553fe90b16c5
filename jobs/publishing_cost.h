/* The cost of a case besides its realisations: merging, errors, and the rows of its publication. */
#ifndef RUGO_JOBS_PUBLISHING_COST_H
#define RUGO_JOBS_PUBLISHING_COST_H

#include <stddef.h>

/* Returns the CPU seconds on one core at 3 GHz of a case with so many curves, and so many points in
 * all of them. Fitted to tests/bench/worker/bench_publishing.c. */
double publishing_cost(size_t curves, size_t points);

#endif
