/* A Gaussian surface at a grid point and its neighbours.
 *
 * Opposite neighbours a and -a make a pair. With s = z(0) - (z(a) + z(-a))/2 and t = (z(a) -
 * z(-a))/2, the point is above both where |t| < s. Any s and any t are uncorrelated, since the
 * autocorrelation is even; so are z(0) and any t. */
#ifndef RUGO_CORE_THEORY_SAMPLED_FIELD_H
#define RUGO_CORE_THEORY_SAMPLED_FIELD_H

#include "core/surface/spectrum.h"

/* Numbers of pairs of a profile, a five-point and a nine-point stencil, in the order along x, along
 * y, and along the two diagonals. */
enum { PAIRS_PROFILE = 1, PAIRS_FIVE_POINT = 2, PAIRS_NINE_POINT = 4, PAIRS_MOST = 4 };
/* The even vector holds s of each pair, then z(0), then the exact mean curvature at the point
 * -(z_xx + z_yy)/2 (profiles: -z''). */
enum { EVEN_MOST = PAIRS_MOST + 2 };

/* Heights are in sqrt(m0), the exact curvature in sqrt(m4) of the spectrum. */
struct sampled_field {
    size_t pairs;
    double even[EVEN_MOST][EVEN_MOST]; /* covariances of the first pairs + 2 */
    double odd[PAIRS_MOST][PAIRS_MOST];
    /* The curvature by finite differences, in sqrt(m4), is the sum of these times s along x, y. */
    double bend[2];
};

/* Sums over the spectrum, in which nothing cancels on fine grids. ERROR_MEMORY alone. */
int sampled_field_fill(const struct modes *modes, const struct moments *moments, size_t pairs,
                       struct sampled_field *out, struct error *err);

/* Expected values of finite differences (F1.3) on surfaces with exactly this spectrum, as in struct
 * roughness; and the mean kurtosis of their heights over random phases (F3.3). Of translated
 * surfaces those of the whole law, and no kurtosis (NaN). */
struct sampled_moments {
    double rms_slope, rms_curvature, m2, m4, nayak_alpha;
    double kurtosis;
    double isotropy; /* 3 m22/m40 with m40 the mean of m40 and m04, by differences; NaN: profiles */
};
void sampled_moments(const struct modes *modes, struct sampled_moments *out);

#endif
