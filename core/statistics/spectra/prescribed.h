/* Spectral density and autocorrelation that a spectrum prescribes, over the rings of roughness.h:
 * beside what the discrete spectrum of a cell has, which lacks the mean height and parts of the
 * rings at the ends of its band. */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_PRESCRIBED_H
#define RUGO_CORE_STATISTICS_SPECTRA_PRESCRIBED_H

#include "core/surface/spectrum.h"

/* modes are those of the spectrum. Isotropic densities are those at the wave number of a ring, with
 * the scale of the cell; that of an exponential autocorrelation is the mean of its endless
 * surface's over the ring. Anisotropic densities are means over a ring: with `band` over its waves
 * of the band alone, else over all. Arrays have radial_bins entries. */
int psd_prescribed(const struct spectrum *spectrum, const struct modes *modes, bool band,
                   double *wave_number, double *density, struct error *err);
/* The exponential autocorrelation as it stands; of others, known by their spectrum, that of modes.
 * Arrays have acf_lags entries. */
int acf_prescribed(const struct spectrum *spectrum, const struct modes *modes, double *lag,
                   double *correlation, struct error *err);

#endif
