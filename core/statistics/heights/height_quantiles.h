/* The bearing curve of a map as quantiles of its heights, fit to be the heights of a study. */
#ifndef RUGO_CORE_STATISTICS_HEIGHTS_HEIGHT_QUANTILES_H
#define RUGO_CORE_STATISTICS_HEIGHTS_HEIGHT_QUANTILES_H

#include "core/statistics/measured_map.h"

/* Returns how many quantiles n heights have: at standard Gaussian scores 0.1 apart, as long as ten
 * heights lie beyond; 0 for fewer than 50 heights. */
size_t height_quantiles_count(size_t n);
/* Fills in the quantiles of n heights (FORMULAS.md, F18.11), which are those of the map that are no
 * holes; arrays have height_quantiles_count(n) entries. Fails with ERROR_MEMORY alone. */
int height_quantiles_measure(const struct measured_map *map, size_t n, double *probability,
                             double *quantile, struct error *err);

#endif
