#include "core/theory/nayak.h"
#include "core/theory/quadrature.h"
#include <math.h>
#include <stdbool.h>

/* With s = -t1 > 0 the joint density of summits (F6.1) is
 *   sqrt(3 C1)/(2 pi) w(s) exp(-C1 z^2 + b s - C1 s^2/2),
 *   w(s) = s^2 - 2 + 2 exp(-s^2/2),  C1 = alpha/(2 alpha - 3),  b = C1 sqrt(3/alpha) z.
 * Densities and curvatures are moments of it over s. Nayak's closed forms cancel for low z and
 * alpha near 3/2; quadrature of these positive integrands does not. */

static bool in_domain(double alpha) {
    return alpha > 1.5 && isfinite(alpha);
}

/* Returns w(s) without the cancellation of its three terms, s^4/4 for small s. */
static double weight(double s) {
    double h = s * s / 2;
    if (h > 0.05)
        return 2 * (expm1(-h) + h);
    double sum = 0, term = h * h;
    for (int n = 2; n < 12; n++) {
        sum += term;
        term *= -h / (n + 1);
    }
    return sum; /* 2 (h^2/2! - h^3/3! + ...) */
}

struct tilted {
    double c1, b, peak; /* exponent b s - C1 s^2/2, less its largest value */
    int order;
};

static double tilted_weight(double s, const void *context) {
    const struct tilted *t = context;
    double power = t->order != 0 ? s : 1;
    return power * weight(s) * exp(s * (t->b - t->c1 * s / 2) - t->peak);
}

/* An integrand is negligible in double precision where it is exp(-DEPTH) of its peak. */
static const double DEPTH = 80;
enum { PANELS = 24 };

/* Returns the integral over s > 0 of s^order w(s) exp(b s - C1 s^2/2 - peak), peak = max(0, b
 * |b|)/(2 C1). */
static double tilted_moment(double alpha, double z, int order) {
    double c1 = alpha / (2 * alpha - 3), b = c1 * sqrt(3 / alpha) * z;
    double centre = b / c1, reach = sqrt(2 * DEPTH / c1);
    struct tilted t = {c1, b, b > 0 ? b * centre / 2 : 0, order};
    double low = b > 0 ? fmax(0, centre - reach) : 0;
    double high = b > 0 ? centre + reach : 2 * DEPTH / (sqrt(b * b + 2 * c1 * DEPTH) - b);
    return quadrature(tilted_weight, &t, low, high, PANELS);
}

double nayak_summit_pdf(double z, double alpha) {
    if (!in_domain(alpha) || isnan(z))
        return NAN;
    double c1 = alpha / (2 * alpha - 3);
    double exponent = z > 0 ? -z * z / 2 : -c1 * z * z; /* with the peak of the moment */
    if (exponent < -700)
        return 0;
    return sqrt(3 * c1) / (2 * M_PI) * exp(exponent) * tilted_moment(alpha, z, 0);
}

double nayak_mean_curvature(double z, double alpha) {
    if (!in_domain(alpha) || !isfinite(z))
        return NAN;
    return tilted_moment(alpha, z, 1) / tilted_moment(alpha, z, 0) / sqrt(3);
}

double nayak_joint_pdf(double z, double t1, double alpha) {
    if (!in_domain(alpha) || isnan(z) || isnan(t1))
        return NAN;
    if (t1 >= 0)
        return 0;
    /* The exponents are added first, because the single exponentials overflow for alpha near 3/2.
     */
    double c1 = alpha / (2 * alpha - 3), slant = sqrt(12 / alpha);
    double exponent = -c1 * (z * z + (t1 * t1 + slant * t1 * z) / 2);
    return sqrt(3 * c1) / (2 * M_PI) * weight(-t1) * exp(exponent);
}

struct marginal {
    double slope, centre; /* erfc(slope (s - centre)) */
};

static double below_height(double s, const void *context) {
    const struct marginal *m = context;
    return weight(s) * exp(-s * s / 4) * erfc(m->slope * (s - m->centre));
}

double nayak_summit_cdf(double z, double alpha) {
    if (!in_domain(alpha) || isnan(z))
        return NAN;
    /* Given s, z is normal about s sqrt(3/(4 alpha)) with variance 1/(2 C1); s has the density
     * sqrt(3)/(2 sqrt(pi)) w(s) exp(-s^2/4), whatever alpha. */
    double rise = sqrt(3 / (4 * alpha)), c1 = alpha / (2 * alpha - 3);
    struct marginal m = {sqrt(c1) * rise, z / rise};
    double end = 2 * sqrt(DEPTH), window = 7 / m.slope;
    double low = fmin(fmax(m.centre - window, 0), end),
           high = fmin(fmax(m.centre + window, 0), end);
    double sum = quadrature(below_height, &m, 0, low, PANELS) +
                 quadrature(below_height, &m, low, high, PANELS) +
                 quadrature(below_height, &m, high, end, PANELS);
    return fmin(sqrt(3 / M_PI) / 4 * sum, 1);
}

double nayak_summit_density(double m2, double m4) {
    if (!(m2 > 0 && m4 >= 0 && isfinite(m2) && isfinite(m4)))
        return NAN;
    return m4 / (6 * M_PI * sqrt(3) * m2);
}

double nayak_summit_mean(double alpha) {
    return in_domain(alpha) ? 4 / sqrt(M_PI * alpha) : NAN;
}

double nayak_summit_variance(double alpha) {
    double variance_s = 4 * sqrt(3) + 2.0 / 3 - 64 / (3 * M_PI);
    return in_domain(alpha) ? 1 - (1.5 - 0.75 * variance_s) / alpha : NAN;
}

double nayak_overall_curvature(void) {
    return 8 / (3 * sqrt(M_PI));
}
