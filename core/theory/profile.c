/* Peaks of Gaussian profiles (Rice 1945; Cartwright & Longuet-Higgins 1956). With s =
 * -z''/sqrt(m4), z* and s are unit normals of correlation r = 1/sqrt(alpha), and peaks have the
 * density s exp(-(z^2 - 2 r z s + s^2)/(2 (1 - r^2))) / sqrt(2 pi (1 - r^2)). */
#include "core/theory/nayak.h"
#include "core/theory/quadrature.h"
#include <math.h>
#include <stdbool.h>

static bool in_domain(double alpha) {
    return alpha > 1 && isfinite(alpha);
}

struct conditional {
    double mean, deviation; /* of s at the height */
    double peak;            /* exponent less its largest value for s > 0 */
};

/* s and s^2, times the exponential. */
static void conditional_weights(double s, const void *context, double out[2]) {
    const struct conditional *c = context;
    double t = (s - c->mean) / c->deviation, weight = exp(c->peak - t * t / 2);
    out[0] = s * weight;
    out[1] = s * s * weight;
}

static const double DEPTH = 80;
enum { PANELS = 24 };

/* Integrals over s > 0 of s and s^2, times exp(-(s - r z)^2/(2 (1 - r^2)) + peak). */
static void conditional_moments(double z, double alpha, double out[2]) {
    double r = 1 / sqrt(alpha), deviation = sqrt((alpha - 1) / alpha);
    struct conditional c = {r * z, deviation, 0};
    double start = -c.mean / deviation; /* of s = 0 */
    double reach = deviation * sqrt(2 * DEPTH);
    double low = fmax(c.mean - reach, 0), high = c.mean + reach;
    if (start > 0) {
        c.peak = start * start / 2;
        high = deviation * 2 * DEPTH / (sqrt(start * start + 2 * DEPTH) + start);
    }
    quadrature_pair(conditional_weights, &c, low, high, PANELS, out);
}

void profile_peak(double z, double alpha, double *pdf, double *curvature) {
    *pdf = *curvature = NAN;
    if (!in_domain(alpha) || isnan(z))
        return;
    double variance = (alpha - 1) / alpha, moments[2];
    double exponent = z > 0 ? -z * z / 2 : -z * z / (2 * variance);
    conditional_moments(z, alpha, moments);
    *pdf = exponent < -700 ? 0 : exp(exponent) * moments[0] / sqrt(2 * M_PI * variance);
    *curvature = isfinite(z) ? moments[1] / moments[0] : (double)NAN;
}

double profile_peak_pdf(double z, double alpha) {
    double pdf, curvature;
    profile_peak(z, alpha, &pdf, &curvature);
    return pdf;
}

static double normal_below(double x) {
    return erfc(-x / sqrt(2)) / 2;
}

double profile_peak_cdf(double z, double alpha) {
    if (!in_domain(alpha) || isnan(z))
        return NAN;
    double r = 1 / sqrt(alpha), deviation = sqrt((alpha - 1) / alpha);
    double below =
        normal_below(z / deviation) - r * exp(-z * z / 2) * normal_below(r * z / deviation);
    return fmin(fmax(below, 0), 1);
}

double profile_peak_joint_pdf(double z, double t1, double alpha) {
    if (!in_domain(alpha) || isnan(z) || isnan(t1))
        return NAN;
    if (t1 >= 0)
        return 0;
    double r = 1 / sqrt(alpha), variance = (alpha - 1) / alpha;
    double exponent = -(z * z + 2 * r * z * t1 + t1 * t1) / (2 * variance);
    return -t1 * exp(exponent) / sqrt(2 * M_PI * variance);
}

double profile_mean_curvature(double z, double alpha) {
    double pdf, curvature;
    profile_peak(z, alpha, &pdf, &curvature);
    return curvature;
}

double profile_peak_density(double m2, double m4) {
    return sqrt(m4 / m2) / (2 * M_PI);
}

struct summit_expectation summit_expectation(int dimension, double m2, double m4, double alpha) {
    const double half_pi = 1.5707963267948966;
    if (dimension == 2)
        return (struct summit_expectation){.density = nayak_summit_density(m2, m4),
                                           .height_mean = nayak_summit_mean(alpha),
                                           .height_variance = nayak_summit_variance(alpha),
                                           .curvature = nayak_overall_curvature()};
    /* Cartwright & Longuet-Higgins (1956) with epsilon^2 = 1 - 1/alpha; curvatures of all peaks are
     * Rayleigh distributed. */
    return (struct summit_expectation){.density = profile_peak_density(m2, m4),
                                       .height_mean = sqrt(half_pi / alpha),
                                       .height_variance = 1 - (half_pi - 1) / alpha,
                                       .curvature = sqrt(half_pi)};
}
