/* The Gaussian heights whose order is that of a map: of a surface that was translated from a
 * Gaussian field, that field (FORMULAS.md, F18.46). */
#ifndef RUGO_CORE_STATISTICS_HEIGHTS_NORMAL_SCORES_H
#define RUGO_CORE_STATISTICS_HEIGHTS_NORMAL_SCORES_H

#include "core/statistics/measured_map.h"

/* Fills out (a value a point, holes stay NaN) with Gaussian quantiles in the order of the heights,
 * equal ones in that of their points, with mean 0 and the heights' standard deviation. ERROR_INPUT
 * for fewer than two heights, or heights that are all equal; ERROR_MEMORY. */
int normal_scores_fill(const struct measured_map *map, double *out, struct error *err);

#endif
