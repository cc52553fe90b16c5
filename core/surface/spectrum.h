/* Height spectra, and their discrete form on a periodic cell.
 *
 * A spectrum is a shape; its scale on the cell follows from the prescribed m0 or RMS slope, so that
 * the discrete sums of a surface are exact. Wave numbers are k = 2 pi m / L, m integer. */
#ifndef RUGO_CORE_SURFACE_SPECTRUM_H
#define RUGO_CORE_SURFACE_SPECTRUM_H

#include "core/surface/modes.h"
#include "core/surface/moments.h"

/* The exponential autocorrelation (FORMULAS.md, F2.2) of a periodic cell. It is prescribed at the
 * points of the grid, and the spectrum is its transform there. */

/* Returns the autocorrelation over its value at 0 for the lag (i dx, j dy), or its shorter periodic
 * image. */
double exponential_correlation(const struct spectrum *spectrum, const struct grid *grid, size_t i,
                               size_t j);
/* Fills the powers of modes, whose band is the whole grid, and their count. No surface has a
 * negative power: there it is set to 0, and modes->clipped is the share of these modes in all.
 * ERROR_MEMORY; ERROR_INPUT for too long a side. */
int exponential_fill(struct modes *modes, const struct spectrum *spectrum, struct error *err);

/* Quick estimates from the radial spectrum alone, before a discrete spectrum is made. */

/* Estimates the number of summits (of profiles: peaks) on a cell of the grid's size, and the Nayak
 * parameter, by Nayak's density (F6.7, F7.2). Its moments are integrals of the radial spectrum from
 * wave number long_waves to short_waves, both in waves per side lx of the cell. A table counts as a
 * constant density. */
double spectrum_expected_summits(const struct spectrum *spectrum, const struct grid *grid,
                                 double long_waves, double short_waves, double *alpha);

/* Samples the spectrum on the grid and scales it. ERROR_INPUT when the spectrum is out of range,
 * has no mode on this grid, or the grid does not resolve its shortest wavelength (needs at least 2
 * points a wave; the shared Nyquist mode of 2 points a wave is kept as one self-conjugate mode),
 * and for two faces, or strata, of which one is translated; ERROR_MEMORY. */
int modes_create(struct modes **out, const struct spectrum *spectrum, const struct grid *grid,
                 struct error *err);
void modes_destroy(struct modes **modes);
/* Returns whether a wave of the grid's cell lies in the band of a valid spectrum, its first face
 * alone: else modes_create() refuses it. The number of points does not matter. Time grows with the
 * waves outside the band, up to all of the cell. */
bool spectrum_has_mode(const struct spectrum *spectrum, const struct grid *grid);

/* Moments of the surface, also of one that is translated from a Gaussian field of this spectrum.
 * Sums pairwise or compensated, with a relative error of about 1e-15. */
void modes_moments(const struct modes *modes, struct moments *out);
/* Moments of the spectrum itself: of a surface that is translated, those of its Gaussian field. */
void modes_gaussian_moments(const struct modes *modes, struct moments *out);
/* As modes_moments, of a spectrum on a grid. Fails as modes_create does; *out is untouched then. */
int spectrum_moments(const struct spectrum *spectrum, const struct grid *grid, struct moments *out,
                     struct error *err);

/* Returns the Nayak parameter of the continuous self-affine spectrum (F2.5) of dimension 1 or 2;
 * ratio_long is lambda_l/lambda_s, ratio_rolloff lambda_l/lambda_r >= 1. NaN outside the domain. */
double spectrum_alpha_continuous(int dimension, double hurst, double ratio_long,
                                 double ratio_rolloff);
/* Finds the wavelength ratio lambda_l/lambda_s that gives alpha. ERROR_NUMERIC, with the range that
 * can be reached, when none does. */
int spectrum_ratio_continuous(int dimension, double hurst, double ratio_rolloff, double alpha,
                              double *ratio, struct error *err);
/* Finds that ratio by the discrete sums of a cell of length_ratio long waves (square). The discrete
 * alpha is a step function of the ratio. The returned ratio's lambda_s is that of the mode ring
 * whose alpha is nearest; *reached is that alpha. ERROR_INPUT for
 * arguments out of range; ERROR_NUMERIC, with the range, where no ratio gives alpha, and on
 * surfaces where the nearest is off by more than 1 %; ERROR_MEMORY. Sums of modes that are not
 * isotropic (isotropy below 0.9 or above 1.1) are left out. */
int spectrum_ratio_discrete(int dimension, double hurst, double ratio_rolloff, double length_ratio,
                            double alpha, double *ratio, double *reached, struct error *err);
/* As above, of surfaces on a cell of length_x by length_y long waves. */
int spectrum_ratio_rectangle(double hurst, double ratio_rolloff, double length_x, double length_y,
                             double alpha, double *ratio, double *reached, struct error *err);
/* Find the least Hurst exponent, from 0.001 to 1, that gives alpha at a wavelength ratio: by the
 * continuous formula, or by the sums of a cell of length_x by length_y long waves (profiles: twice
 * the same). ERROR_NUMERIC, with the range that can be reached; ERROR_INPUT for cells of too many
 * waves; ERROR_MEMORY. */
int spectrum_hurst_continuous(int dimension, double ratio, double ratio_rolloff, double alpha,
                              double *hurst, struct error *err);
int spectrum_hurst_discrete(int dimension, double ratio, double ratio_rolloff, double length_x,
                            double length_y, double alpha, double *hurst, struct error *err);

#endif
