#include "core/surface/spectrum_estimate.h"
#include <math.h>

static const double TWO_PI = 6.283185307179586;

enum { STEPS = 200 }; /* midpoints of the integrals over log k */

/* Returns the radial density at k > 0 in any scale (F2.1, F2.2). */
static double radial_density(const struct spectrum *spectrum, int dimension, double k) {
    double exponent = dimension;
    if (spectrum->type == SPECTRUM_SELF_AFFINE)
        return pow(fmax(1, k * spectrum->wavelength_rolloff / TWO_PI),
                   -(2 * spectrum->hurst + exponent));
    if (spectrum->type == SPECTRUM_EXPONENTIAL_ACF)
        return pow(1 + k * k * spectrum->correlation_x * spectrum->correlation_y,
                   -(1 + exponent) / 2);
    return 1;
}

/* The means of cos^2 and cos^4 over directions turn radial moments of a surface into m2 and m4 of
 * its plane sections. */
double spectrum_expected_summits(const struct spectrum *spectrum, const struct grid *grid,
                                 double long_waves, double short_waves, double *alpha) {
    int dimension = grid_is_profile(grid) ? 1 : 2;
    double section2 = dimension == 2 ? 1.0 / 2 : 1, section4 = dimension == 2 ? 3.0 / 8 : 1;
    double low = TWO_PI * long_waves / grid->lx, high = TWO_PI * short_waves / grid->lx;
    double step = log(fmax(high / low, 1 + 1e-6)) / STEPS, m0 = 0, m2 = 0, m4 = 0;
    for (int a = 0; a < STEPS; a++) {
        double k = low * exp((a + 0.5) * step);
        double power = radial_density(spectrum, dimension, k) * pow(k, dimension);
        m0 += power;
        m2 += power * k * k * section2;
        m4 += power * k * k * k * k * section4;
    }
    *alpha = m0 * m4 / (m2 * m2);
    if (dimension == 1)
        return grid->lx * sqrt(m4 / m2) / TWO_PI;
    return grid->lx * grid->ly * m4 / m2 / (3 * sqrt(3) * TWO_PI);
}
