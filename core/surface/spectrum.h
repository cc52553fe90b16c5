/* Height spectra, and their discrete form on a periodic cell.
 *
 * A spectrum is a shape; its scale is fixed on the cell by the wanted m0 or RMS slope, so that
 * the discrete sums of a surface are exact. Wave numbers are k = 2 pi m / L, m integer. */
#ifndef RUGO_CORE_SURFACE_SPECTRUM_H
#define RUGO_CORE_SURFACE_SPECTRUM_H

#include "core/surface/modes.h"

/* Samples the spectrum on the grid and scales it. ERROR_INPUT when the spectrum is out of range,
 * has no mode on this grid, or the grid does not resolve its shortest wavelength (needs at least 2
 * points a wave; the shared Nyquist mode of 2 points a wave is kept as one self-conjugate mode). */
int modes_create(struct modes **out, const struct spectrum *spectrum, const struct grid *grid,
                 struct error *err);
void modes_destroy(struct modes **modes);

/* Spectral moments (FORMULAS.md, F2.3). A profile has m00 = m0, m20 = m2, m40 = m4; the others are
 * 0. */
struct moments {
    double m00, m20, m02, m11, m22, m40, m04, m31, m13;
    double m0, m2, m4;                           /* isotropic: m00, (m20+m02)/2, (m40+m04)/2 */
    double nayak_alpha;                          /* m0 m4 / m2^2 (F2.4) */
    double rms_height, rms_slope, rms_curvature; /* F1.2 */
};
/* Whether moments are those of an isotropic surface, which has m20 = m02 and 3 m22 = m40 = m04,
 * within a quarter: a lattice of four or twelve modes has not, one of forty has. False for
 * profiles. */
bool moments_isotropic(const struct moments *moments);
/* Sums pairwise or compensated, with a relative error of about 1e-15. */
void modes_moments(const struct modes *modes, struct moments *out);
/* The same of a spectrum on a grid, for those who need nothing else of its modes. Fails as
 * modes_create does; *out is untouched then. */
int spectrum_moments(const struct spectrum *spectrum, const struct grid *grid, struct moments *out,
                     struct error *err);

/* Nayak parameter of the continuous self-affine spectrum (F2.5) of dimension 1 or 2; ratio_long is
 * lambda_l/lambda_s, ratio_rolloff lambda_l/lambda_r >= 1. NaN outside of the domain. */
double spectrum_alpha_continuous(int dimension, double hurst, double ratio_long,
                                 double ratio_rolloff);
/* The wavelength ratio lambda_l/lambda_s that gives alpha; ERROR_NUMERIC with the range that can
 * be reached when none does. */
int spectrum_ratio_continuous(int dimension, double hurst, double ratio_rolloff, double alpha,
                              double *ratio, struct error *err);
/* The same by the discrete sums of a cell of length_ratio long waves (square). The discrete alpha
 * is a step function of the ratio; the returned ratio's lambda_s is that of the mode ring whose
 * alpha is nearest, and *reached says which alpha that is. */
int spectrum_ratio_discrete(int dimension, double hurst, double ratio_rolloff, double length_ratio,
                            double alpha, double *ratio, double *reached, struct error *err);
/* The same of surfaces on a cell of length_x by length_y long waves. */
int spectrum_ratio_rectangle(double hurst, double ratio_rolloff, double length_x, double length_y,
                             double alpha, double *ratio, double *reached, struct error *err);

#endif
