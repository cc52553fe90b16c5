/* How much the spectrum of a map scatters, from its heights themselves. */
#ifndef RUGO_CORE_STATISTICS_UNCERTAINTY_SPECTRUM_SCORES_H
#define RUGO_CORE_STATISTICS_UNCERTAINTY_SPECTRUM_SCORES_H

#include "core/statistics/spectra/spectrum_law.h"
#include "core/statistics/uncertainty/low_modes.h"

/* By how much more a spectrum scatters than that of a Gaussian surface: variance of the logarithm
 * of its density at the reference of the problem, that of its slope over the logarithm of the wave
 * number, and their covariance. 0 where it scatters no more. */
struct spectrum_scatter {
    double density, slope, both;
};
/* Powers of waves of a surface that is not Gaussian rise and fall together. The most likely change
 * of scale and slope is a mean over the map of products of heights and of filtered heights, so that
 * the slow waves of these products have its variance (FORMULAS.md, F18.76). Rings count as
 * far as waves of the law govern them, up to SPECTRUM_BLURRED before a sharp end. The problem has
 * what law_covariance() of the law left in it; map: that of its spectrum. ERROR_MEMORY. */
int spectrum_scatter_measure(const struct law_problem *problem, const struct law *law,
                             const struct measured_map *map, const struct low_modes *modes,
                             struct spectrum_scatter *out, struct error *err);

#endif
