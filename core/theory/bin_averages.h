/* Theoretical densities averaged over the bins of a histogram, which are the expected values of its
 * counts. dimension is 1 for profiles and 2 for surfaces; heights are z* = z/sqrt(m0) and t1 is the
 * curvature of nayak.h. Output arrays have bins->count entries unless stated. */
#ifndef RUGO_CORE_THEORY_BIN_AVERAGES_H
#define RUGO_CORE_THEORY_BIN_AVERAGES_H

#include "core/statistics/heights/histogram.h"
#include "core/surface/heights.h"

/* Of a height distribution: mean density of each bin, and cumulative probability at its upper edge.
 * Errors of heights_moments. */
int bin_averages_heights(const struct heights *heights, const struct bins *bins, double *pdf,
                         double *cdf, struct error *err);
/* Of summit (peak) heights: the same, and the mean curvature over sqrt(m4) of the summits in each
 * bin (F6.2, F6.3, F6.5; F7.1). */
void bin_averages_summits(int dimension, double alpha, const struct bins *bins, double *pdf,
                          double *cdf, double *curvature);
/* Mean density of t1 over all summits in each bin (F6.6; profiles: Rayleigh). It does not depend on
 * alpha. */
void bin_averages_curvatures(int dimension, const struct bins *bins, double *pdf);
/* Mean joint density of height and t1 (F6.1, F7.1): pdf[height bin * t1->count + t1 bin]. */
void bin_averages_joint(int dimension, double alpha, const struct bins *height,
                        const struct bins *t1, double *pdf);
/* Mean of Persson's pressure density (F13.1) at a load in each bin of p/(E* h'). */
void bin_averages_persson(double load, const struct bins *bins, double *pdf);

#endif
