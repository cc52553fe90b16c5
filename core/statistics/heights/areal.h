/* The areal parameters of ISO 25178-2, of surfaces. */
#ifndef RUGO_CORE_STATISTICS_HEIGHTS_AREAL_H
#define RUGO_CORE_STATISTICS_HEIGHTS_AREAL_H

#include "core/statistics/heights/roughness.h"
#include "core/statistics/measured_map.h"
#include "core/statistics/spectra/correlation.h"
#include "core/statistics/summits/summit_list.h"

/* Hills of a surface that stand out: each has one peak. Its height is how far one must go down from
 * the peak to reach a higher one. */

struct hills {
    size_t count;
    double density;   /* per area of the points all of whose 8 neighbours are there */
    double curvature; /* mean of -(z_xx + z_yy)/2 at the peaks, central differences; NaN: no hill */
};
/* Finds the peaks whose hills are `least` or more above their highest saddle to a higher peak,
 * after Wolf's pruning of the change tree (FORMULAS.md, F18.10). A point has 8 neighbours. Points
 * at the side of an open map and beside holes prune others, but do not count: they may be the slope
 * of a higher one. Surfaces alone. peaks: an
 * empty list that those which count are put in, or NULL. ERROR_MEMORY, or ERROR_INPUT for 2^32 - 1
 * points or more. */
int hills_find(const struct measured_map *map, double least, struct summit_list *peaks,
               struct hills *out, struct error *err);

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

#endif
