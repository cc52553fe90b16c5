/* How fields that are made of a Gaussian surface are correlated: its heights, their powers,
 * products of its slopes; sampled as far as the correlation reaches. */
#ifndef RUGO_CORE_STATISTICS_CORRELATION_FIELD_H
#define RUGO_CORE_STATISTICS_CORRELATION_FIELD_H

#include "core/statistics/correlation.h"

enum { FIELD_LAGS = 20, FIELD_SIDE = 2 * FIELD_LAGS + 1 };

/* value[b][a] is that at the lag ((a - FIELD_LAGS) step, (b - FIELD_LAGS) step), of any scale; 0
 * beyond the reach, of profiles in all rows but the middle one. */
struct correlation_field {
    double step; /* a length */
    double value[FIELD_SIDE][FIELD_SIDE];
};

/* Returns the longest lag, over directions, at which the correlation first falls to 0.2; NaN where
 * it does not within half a side in each. */
double correlation_length(const struct correlation *correlation);
/* Fills in a power of the correlation: that of a Hermite polynomial of the heights. It is followed
 * up to 2.5 lengths, behind which there is mostly chance. */
void correlation_field_power(const struct correlation *correlation, const struct grid *grid,
                             double length, int power, struct correlation_field *out);
/* Fills in the square of its Laplacian by differences over a lag, which is a length: that of
 * products of two slopes over this lag, as a mean over directions. */
void correlation_field_slopes(const struct correlation *correlation, const struct grid *grid,
                              double length, double lag, struct correlation_field *out);

#endif
