/* Height spectra, and their discrete form on a periodic cell.
 *
 * A spectrum is a shape; its scale is fixed on the cell by the wanted m0 or RMS slope, so that
 * the discrete sums of a surface are exact. Wave numbers are k = 2 pi m / L, m integer. */
#ifndef RUGO_CORE_SURFACE_SPECTRUM_H
#define RUGO_CORE_SURFACE_SPECTRUM_H

#include "core/surface/grid.h"

enum spectrum_type { SPECTRUM_SELF_AFFINE, SPECTRUM_EXPONENTIAL_ACF, SPECTRUM_TABLE };
enum spectrum_scale {
    SCALE_NONE,       /* m0 = 1 */
    SCALE_RMS_HEIGHT, /* sqrt(m00) = value */
    SCALE_RMS_SLOPE   /* profile sqrt(m2), surface sqrt(m20 + m02) = value */
};

struct spectrum {
    enum spectrum_type type;
    /* self-affine (FORMULAS.md, F2.1): wavelengths, long >= rolloff >= short > 0; the band lx/long
     * <= |m| <= lx/short includes both edges, with a relative guard of 1e-9 against rounding */
    double hurst; /* [0, 1] */
    double wavelength_long, wavelength_rolloff, wavelength_short;
    /* of surfaces: all waves are so many times as long along x as they are along y; 0 is as 1 */
    double anisotropy;
    /* exponential autocorrelation exp(-sqrt((tx/bx)^2 + (ty/by)^2)) (F2.2), as it is at the points
     * of the grid; it has no band limit and fills the grid */
    double correlation_x, correlation_y;
    /* table: isotropic density of any scale at rising |k|, interpolated in logarithms, 0 outside;
     * borrowed */
    size_t table_count;
    const double *table_wave_number; /* radians per length */
    const double *table_density;
    enum spectrum_scale scale;
    double scale_value; /* unused for SCALE_NONE */
};

/* The discrete spectrum on a grid: power P(mx, my) = |Z|^2, mean square height = sum over all
 * modes of the full plane. Half plane mx >= 0 is stored, for |mx| <= mode_x, |my| <= mode_y:
 * power[mx*(2*mode_y + 1) + my + mode_y]. P(0,0) = 0. Fields are read by all, changed by none. */
struct modes {
    struct grid grid;
    size_t mode_x, mode_y; /* highest wave number present (mode_y = 0 for a profile) */
    double *power;         /* owned, (mode_x + 1) x (2 mode_y + 1) */
    size_t count;          /* non-null modes of the full plane */
    double clipped; /* share of the power that was left out as negative: exponential_acf alone */
};

/* Samples the spectrum on the grid and scales it. ERROR_INPUT when the spectrum is out of range,
 * has no mode on this grid, or the grid does not resolve its shortest wavelength (needs at least 2
 * points a wave; the shared Nyquist mode of 2 points a wave is kept as one self-conjugate mode). */
int modes_create(struct modes **out, const struct spectrum *spectrum, const struct grid *grid,
                 struct error *err);
void modes_destroy(struct modes **modes);
static inline double modes_power(const struct modes *modes, size_t mx, long my) {
    return modes->power[mx * (2 * modes->mode_y + 1) + (size_t)(my + (long)modes->mode_y)];
}
/* How many modes of the full plane a stored one stands for. Column 0 and, for even nx, the Nyquist
 * column hold both signs of my themselves; every other column stands for its mirror image too. The
 * Nyquist row of an even ny is stored once, at +ny/2. */
static inline unsigned modes_weight(const struct grid *grid, size_t mx) {
    return mx == 0 || 2 * mx == grid->nx ? 1 : 2;
}

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

#endif
