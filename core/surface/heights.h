/* Height distributions: Gaussian, Weibull minimum and maximum, or any monotone quantile function.
 * All are centred (mean 0) and scaled to standard deviation 1 here; callers scale. */
#ifndef RUGO_CORE_SURFACE_HEIGHTS_H
#define RUGO_CORE_SURFACE_HEIGHTS_H

#include "core/error.h"

enum heights_type { HEIGHTS_GAUSSIAN, HEIGHTS_WEIBULL_MIN, HEIGHTS_WEIBULL_MAX, HEIGHTS_QUANTILE };

struct heights {
    enum heights_type type;
    double shape; /* Weibull C, [0.5, 20] */
    /* HEIGHTS_QUANTILE: rising on (0, 1), any finite mean and deviation (standardised by
     * quadrature); must be safe to call from many threads. context is borrowed. */
    double (*quantile)(double probability, const void *context);
    const void *context;
};

struct height_moments {
    double mean, deviation;    /* of the raw distribution (Weibull scale 1), before standardising */
    double skewness, kurtosis; /* theory.md 3.26-3.30; kurtosis 3 for a Gaussian */
    double lowest, highest;    /* bounds in standard deviations about the mean; +-INFINITY if none,
                                  or unknown as for HEIGHTS_QUANTILE */
};

/* ERROR_INPUT: shape out of range, quantile function not rising or without finite moments. */
int heights_moments(const struct heights *heights, struct height_moments *out, struct error *err);
/* Standardised quantile at probability in (0, 1), given the moments above. */
double heights_quantile(const struct heights *heights, const struct height_moments *moments,
                        double probability);
/* Standardised probability density and cumulative probability; NaN for HEIGHTS_QUANTILE. */
double heights_pdf(const struct heights *heights, const struct height_moments *moments, double z);
double heights_cdf(const struct heights *heights, const struct height_moments *moments, double z);

#endif
