/* How the spectral density of a map differs by direction. */
#ifndef RUGO_CORE_STATISTICS_ANGULAR_SPECTRUM_H
#define RUGO_CORE_STATISTICS_ANGULAR_SPECTRUM_H

#include "core/statistics/map_spectrum.h"

enum { ANGULAR_SECTORS = 36 }; /* of a half turn */

/* The mean square of the waves that run in a sector of directions, over that which the same waves
 * would have if each had the mean density of its ring: 1 of an isotropic surface (FORMULAS.md,
 * F18.18). Of heights, which long waves have most of, and of slopes. */
enum angular_of { ANGULAR_HEIGHTS, ANGULAR_SLOPES, ANGULAR_KINDS };
struct angular_spectrum {
    double angle[ANGULAR_SECTORS]; /* middle of the sector, from x to y, radians, rising from
                                      -pi/2 */
    double power[ANGULAR_KINDS][ANGULAR_SECTORS];
    double error[ANGULAR_KINDS][ANGULAR_SECTORS]; /* standard error, of a Gaussian surface */
};
/* Surfaces alone. Sectors without waves, as of narrow maps, are NaN. */
void angular_spectrum_measure(const struct map_spectrum *spectrum, struct angular_spectrum *out);
/* Returns the angle of the sector where waves have most height; NaN where there is none. */
double angular_spectrum_peak(const struct angular_spectrum *spectrum);

#endif
