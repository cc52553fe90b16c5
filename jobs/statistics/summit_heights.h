/* Variance, skewness and kurtosis of the heights of all summits of a case, from those of each
 * realisation or group. They are no means over summits; their errors are those of their linear
 * parts, which are means (FORMULAS.md, F15.13). */
#ifndef RUGO_JOBS_STATISTICS_SUMMIT_HEIGHTS_H
#define RUGO_JOBS_STATISTICS_SUMMIT_HEIGHTS_H

#include <stddef.h>

enum height_moment { HEIGHT_VARIANCE, HEIGHT_SKEWNESS, HEIGHT_KURTOSIS };

/* Sums over some summits of powers of their heights about the mean height of all; `number` is that
 * of the power 0. */
struct height_powers {
    double number, first, second, third, fourth;
};
/* Returns the part of some summits in a moment. Over their number it is a mean, and the mean over
 * all summits is the moment. NaN where all heights are equal. */
double height_moment_part(enum height_moment moment, const struct height_powers *all,
                          const struct height_powers *some);

/* For each of n realisations the number of summits, and moments of their heights about their own
 * mean. */
struct height_columns {
    size_t n;
    const double *number, *mean, *variance, *skewness, *kurtosis; /* borrowed, n each */
};
/* Fills n values. Their mean, weighted by the numbers, is the moment over all summits, and its
 * error the error of that. NaN for realisations without summits. */
void height_moment_values(const struct height_columns *of, enum height_moment moment,
                          double *values);

#endif
