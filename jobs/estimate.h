/* A value and its standard error over realisations. Realisations are taken in order, so that the
 * digits do not depend on how they were split into blocks. */
#ifndef RUGO_JOBS_ESTIMATE_H
#define RUGO_JOBS_ESTIMATE_H

#include <stddef.h>

struct estimate {
    double value, standard_error; /* NaN where there is none (no realisation; one alone) */
};

/* Estimates the mean of x over the realisations that have one (others are NaN). */
struct estimate estimate_mean(size_t n, const double *x);
/* sum of weight * x over sum of weight: the mean over all summits of what is known as a mean a
 * realisation. Ratio estimator (Cochran 1977, section 2.11). Entries with weight 0 are left out. */
struct estimate estimate_weighted(size_t n, const double *x, const double *weight);

#endif
