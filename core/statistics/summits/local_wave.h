/* A map between its points, and its derivatives, from the points nearby alone: Lagrange's
 * polynomials through LOCAL_POINTS points along each axis. Unlike Fourier's interpolation it needs
 * no periodic map. Waves of 4, 5, 6 and 8 points have heights within 1e-3, 5e-5, 3e-6 and 4e-8 of
 * their amplitude, curvatures within 4e-3, 3e-4, 3e-5 and 7e-7; of 3 points, 3 and 8 %. So a
 * surface with 4 points or more a shortest wave has its summits; with 3 or fewer, 3 % too many. */
#ifndef RUGO_CORE_STATISTICS_SUMMITS_LOCAL_WAVE_H
#define RUGO_CORE_STATISTICS_SUMMITS_LOCAL_WAVE_H

#include "core/statistics/measured_map.h"
#include "core/surface/spectrum.h"

enum { LOCAL_HALF = 8, LOCAL_POINTS = 2 * LOCAL_HALF };

/* Weights of the points 1 - LOCAL_HALF .. LOCAL_HALF, for the value and the first two derivatives
 * at t in [-1/4, 5/4], in units of the spacing. */
struct local_basis {
    double value[LOCAL_POINTS], slope[LOCAL_POINTS], bend[LOCAL_POINTS];
};
void local_basis_at(double t, struct local_basis *basis);

/* Moments of an open map by derivatives at its points, central differences of order 2 LOCAL_HALF
 * over the points whose LOCAL_HALF neighbours to all sides are there (FORMULAS.md, F18.4). NaN
 * where there are none. ERROR_MEMORY alone. */
int local_moments_measure(const struct measured_map *map, struct moments *out, struct error *err);

#endif
