/* How the modes of a ring are spread, and how much of what they tell is independent. Private to
 * map_spectrum.c. */
#ifndef RUGO_CORE_STATISTICS_RING_MODES_H
#define RUGO_CORE_STATISTICS_RING_MODES_H

#include "core/error.h"
#include "core/statistics/spectrum_rings.h"

/* The squared correlation of two modes d apart along one axis, under Hann's window. */
static inline double window_correlation(long d) {
    d = d < 0 ? -d : d;
    return d == 0 ? 1 : d == 1 ? 4. / 9 : d == 2 ? 1. / 36 : 0;
}

/* Fills rings, freedom, covariance, share and distance of a spectrum that has its densities
 * (FORMULAS.md, F18.12); heights: share of the points that are no holes. ERROR_MEMORY alone. */
int ring_modes_measure(struct map_spectrum *spectrum, double heights, struct error *err);

#endif
