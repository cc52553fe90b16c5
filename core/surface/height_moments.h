/* Moments of a height distribution. */
#ifndef RUGO_CORE_SURFACE_HEIGHT_MOMENTS_H
#define RUGO_CORE_SURFACE_HEIGHT_MOMENTS_H

struct height_moments {
    double mean, deviation;    /* of the raw distribution, before standardising */
    double skewness, kurtosis; /* F4.2; kurtosis 3 for a Gaussian */
    double lowest, highest;    /* bounds in standard deviations about the mean; +-INFINITY if none,
                                  or unknown as for HEIGHTS_QUANTILE */
};

#endif
