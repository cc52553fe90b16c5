/* Whether a map is stationary: its parameters over sub-areas differ no more than those of parts of
 * a stationary surface. */
#ifndef RUGO_CORE_STATISTICS_UNCERTAINTY_STATIONARITY_H
#define RUGO_CORE_STATISTICS_UNCERTAINTY_STATIONARITY_H

#include "core/statistics/uncertainty/cell_heights.h"

enum stationary { STATIONARY_MEAN, STATIONARY_RMS, STATIONARY_SKEWNESS, STATIONARY_SLOPE };
enum { STATIONARY_PARAMETERS = STATIONARY_SLOPE + 1 };
/* Sub-areas: 2 x 2 and 4 x 4, of profiles 4 and 16. */
enum { STATIONARY_DIVISIONS = 2 };

/* Of one parameter over the sub-areas of a division: standard deviations, of the RMS height and
 * slope over their values, of the mean height over the RMS height. */
struct spread {
    double found;
    double expected; /* by how parts of sub-areas differ, and by the correlation */
    double p_value;
};
/* FORMULAS.md, F18.19. */
struct stationarity {
    struct spread spread[STATIONARY_DIVISIONS][STATIONARY_PARAMETERS];
    double p_value[STATIONARY_DIVISIONS]; /* of the parameters together */
};
/* differences: over a lag of one point. Where the trend was taken out of the map, with so many
 * terms, as many degrees of freedom of the mean are left out. */
void stationarity_measure(const struct measured_map *map, const struct cell_heights *heights,
                          const struct cell_differences *differences,
                          const struct low_modes *lattice, const struct correlation *correlation,
                          struct stationarity *out);

#endif
