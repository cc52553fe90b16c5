/* A value and its standard error over realisations. Realisations are taken in order, so that the
 * digits do not depend on their division into blocks. */
#ifndef RUGO_JOBS_ESTIMATE_H
#define RUGO_JOBS_ESTIMATE_H

#include <stddef.h>

struct estimate {
    double value, standard_error; /* NaN where there is none (no realisation; one alone) */
};

/* Estimates the mean of x over the realisations that have one (others are NaN). */
struct estimate estimate_mean(size_t n, const double *x);
/* Returns how many of n values a mean is over, with the weights of estimate_weighted or NULL; 0
 * where it is over all of them or none, as `effective` of a result has it. */
double estimate_effective(size_t n, const double *x, const double *weight);
/* Returns a mean of `count` values with an error of which 1.96 are Student's interval of 95 %, as
 * few values may lie close together. Fewer than two show no scatter: NaN. */
struct estimate estimate_of_few(struct estimate mean, size_t count);
/* Estimates sum of weight * x over sum of weight, such as the mean over all summits of what is a
 * mean for each realisation. Ratio estimator (Cochran 1977, section 2.11). Entries with weight 0
 * are left out. */
struct estimate estimate_weighted(size_t n, const double *x, const double *weight);

/* The values of one case at n realisations that both cases have. Weights are those of
 * estimate_weighted; NULL: all 1. */
struct estimate_column {
    const double *x, *weight;
};
/* The mean of one case less that of the other, over the pairs in which both have a value. */
struct pair_estimate {
    double value, standard_error; /* NaN as of struct estimate */
    double deviation;             /* of the difference of one pair */
    size_t pairs;
};
struct pair_estimate estimate_pairs(size_t n, const struct estimate_column *minuend,
                                    const struct estimate_column *subtrahend);

/* The sums of a ratio by groups of realisations: in each what is counted, of how many things. */
struct estimate_groups {
    const double *counted, *things;
};
/* Estimates the ratio of one case less that of the other over groups that are pairs. The error is
 * that of the differences of the groups (Wolter 2007, chapter 2); groups without things in either
 * case are left out. */
struct pair_estimate estimate_group_pairs(size_t n, const struct estimate_groups *minuend,
                                          const struct estimate_groups *subtrahend);

#endif
