/* Spectral densities as prescribed, of any scale. */
#ifndef RUGO_CORE_SURFACE_SPECTRUM_DENSITY_H
#define RUGO_CORE_SURFACE_SPECTRUM_DENSITY_H

#include "core/surface/modes.h"

/* A mode whose relative distance to a band edge is below this counts as on the edge, because
 * wavelengths and cells come from divisions. */
#define BAND_EDGE 1e-9

/* Returns the density at the wave number |k| of waves along y, 0 outside the band; 0 for an
 * exponential autocorrelation, which has no band. */
double spectrum_density(const struct spectrum *spectrum, bool profile, double k);
/* Finds the first and the last wave number of the band; false for one that has none. */
bool spectrum_band(const struct spectrum *spectrum, double *low, double *high);

#endif
