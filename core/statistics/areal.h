/* The areal parameters of ISO 25178-2, of surfaces. */
#ifndef RUGO_CORE_STATISTICS_AREAL_H
#define RUGO_CORE_STATISTICS_AREAL_H

#include "core/statistics/correlation.h"
#include "core/statistics/measured_map.h"
#include "core/statistics/summit_list.h"

/* FORMULAS.md, F18.9 and F18.10; NaN where a map does not tell. */
struct areal {
    double sa, sq, ssk,
        sku;           /* of the heights about their mean: mean size, RMS, skewness, kurtosis */
    double sp, sv, sz; /* highest, depth of the lowest, and their sum */
    double sdq, sdr;   /* RMS slope; developed area over that of the plane, less 1 */
    double sal, str;   /* shortest lag at which the correlation is 0.2; over the longest */
    double spd, spc;   /* density of hills, and mean curvature at their peaks */
};
/* list: an empty one that the peaks of hills are put in, or NULL. */
int areal_measure(const struct measured_map *map, const struct correlation *correlation,
                  struct summit_list *list, struct areal *out, struct error *err);

#endif
