/* A band of waves whose spectra are measured one after the other, as those of realisations with
 * random amplitudes are: nothing is allocated, planned or found twice, and only waves of the band
 * are visited. One thread at a time. */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_SPECTRAL_BAND_H
#define RUGO_CORE_STATISTICS_SPECTRA_SPECTRAL_BAND_H

#include "core/statistics/heights/roughness.h"

struct spectral_band;
int spectral_band_create(struct spectral_band **out, const struct grid *grid, size_t mode_x,
                         size_t mode_y, struct error *err);
void spectral_band_destroy(struct spectral_band **band);
double spectral_band_bytes(const struct grid *grid, size_t mode_x, size_t mode_y);

/* All take modes of this band on this grid. */

/* Fills the moments as modes_moments does, and the parameters by finite differences as
 * sampled_moments does, but for rounding, with the RMS height. The mean is 0; what heights alone
 * have is NaN. */
void spectral_band_moments(const struct spectral_band *band, const struct modes *modes,
                           struct moments *moments, struct roughness *roughness);
/* Fills density[radial_bins] with the digits of psd_of_modes. */
void spectral_band_density(const struct spectral_band *band, const struct modes *modes,
                           double *density);
/* Fills correlation[acf_lags] as acf_of_modes does but for rounding. Means over rings need the part
 * of the field that is even in x and in y, and on a square also its mean with x and y exchanged: a
 * quarter or an eighth of it is transformed and summed. */
void spectral_band_correlation(struct spectral_band *band, const struct modes *modes,
                               double *correlation);

#endif
