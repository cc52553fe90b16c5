/* The autocorrelation of a map by its lag: the mean product of two heights about their mean, over
 * the pairs that are there, over the mean square. */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_CORRELATION_H
#define RUGO_CORE_STATISTICS_SPECTRA_CORRELATION_H

#include "core/statistics/measured_map.h"

struct correlation;
/* Measures at all lags up to half of the sides (FORMULAS.md, F18.8); a flat map has NaN. */
int correlation_create(struct correlation **out, const struct measured_map *map, struct error *err);
void correlation_destroy(struct correlation **correlation);

/* Returns the value at a lag in points, by cubic interpolation; NaN beyond half a side, and where
 * no pair is there. */
double correlation_at(const struct correlation *correlation, double x, double y);

/* Returns how many rings the next function fills. */
size_t correlation_rings(const struct correlation *correlation);
/* Means over rings about lags 0, dx, 2 dx, ..., of a profile the values at these lags. */
void correlation_radial(const struct correlation *correlation, double *lag, double *mean);

/* The shortest and the longest lag, over directions, at which the correlation first falls to a
 * level; NaN: the shortest where it does so in no direction, the longest where not in each. */
void correlation_lengths(const struct correlation *correlation, double level, double *shortest,
                         double *longest);

#endif
