/* The areal parameters of ISO 25178-2, of surfaces. */
#ifndef RUGO_CORE_STATISTICS_HEIGHTS_AREAL_H
#define RUGO_CORE_STATISTICS_HEIGHTS_AREAL_H

#include "core/statistics/heights/roughness.h"
#include "core/statistics/measured_map.h"
#include "core/statistics/spectra/correlation.h"
#include "core/statistics/summits/summit_list.h"

/* FORMULAS.md, F18.9 and F18.10; NaN where a map has no value. */
struct areal {
    double sa, sq, ssk,
        sku;           /* of the heights about their mean: mean size, RMS, skewness, kurtosis */
    double sp, sv, sz; /* highest, depth of the lowest, and their sum */
    double sdq, sdr;   /* RMS slope; developed area over that of the plane, less 1 */
    double sal, str;   /* shortest lag at which the correlation is 0.2; over the longest */
    double spd, spc;   /* density of hills, and mean curvature at their peaks */
};
/* roughness: of the map, by open_roughness_measure() whether it repeats or not. list: an empty one
 * that the peaks of hills are put in, or NULL. */
int areal_measure(const struct measured_map *map, const struct roughness *roughness,
                  const struct correlation *correlation, struct summit_list *list,
                  struct areal *out, struct error *err);
/* The same without hills, whose values are NaN. */
void areal_measure_heights(const struct measured_map *map, const struct roughness *roughness,
                           const struct correlation *correlation, struct areal *out);

#endif
