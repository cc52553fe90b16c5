/* Whether a surface is alike in all directions: by the mean products of its slopes at a scale. */
#ifndef RUGO_CORE_STATISTICS_UNCERTAINTY_ISOTROPY_H
#define RUGO_CORE_STATISTICS_UNCERTAINTY_ISOTROPY_H

#include "core/statistics/spectra/map_spectrum.h"
#include "core/statistics/uncertainty/cell_heights.h"

/* How the spectral density of a map differs by direction. */

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

/* FORMULAS.md, F18.18; errors and p_value are NaN where the map is too small for them, all NaN for
 * a flat one. */
struct isotropy {
    double length;     /* of the differences */
    double anisotropy; /* (a - b)/(a + b) of the mean square slopes across and along, a >= b; 0 of
                          isotropic surfaces, 1 of grooves */
    double ratio;      /* sqrt(a/b) */
    double direction;  /* of the steepest slopes, from x to y, radians in (-pi/2, pi/2]; grooves
                          run at right angles to it */
    double anisotropy_error, ratio_error, direction_error; /* standard errors */
    double p_value; /* of an isotropic surface to have as much anisotropy */
};
/* excess: by low_modes_excess_slopes; NaN where errors are not known. Surfaces alone. */
void isotropy_measure(const struct cell_differences *differences, double length,
                      const struct low_modes *modes, double excess, struct isotropy *out);
/* Returns the p-value of the least of n independent ones. */
double least_p_value(const double *p_values, size_t n);

#endif
