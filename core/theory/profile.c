/* Peaks of Gaussian profiles (Rice 1945; Cartwright & Longuet-Higgins 1956). With s =
 * -z''/sqrt(m4), z* and s are unit normals of correlation r = 1/sqrt(alpha), and peaks have the
 * density s exp(-(z^2 - 2 r z s + s^2)/(2 (1 - r^2))) / sqrt(2 pi (1 - r^2)). */
#include "core/theory/nayak.h"
#include <math.h>
#include <stdbool.h>

static bool in_domain(double alpha) {
    return alpha > 1 && isfinite(alpha);
}

/* The continued fraction starts at this term, with errors of 2e-14 at x = 1 and 1e-15 beyond. */
enum { TERMS = 200 };

/* Integrals over u > 0 of u and u^2, times exp(-u^2/2 - x u) and, for x < 0, times exp(-x^2/2).
 * By parts, J_(n+1) = n J_(n-1) - x J_n with J_1 = 1 - x J_0: upwards where nothing cancels, and
 * from x = 1 on downwards, as the continued fraction J_n/J_(n-1) = n/(x + J_(n+1)/J_n) of positive
 * terms (Gautschi 1967). */
static void half_normal_moments(double x, double out[2]) {
    if (x < 1) {
        double peak = x > 0 ? 1 : exp(-x * x / 2);
        double j0 = sqrt(M_PI / 2) * erfc(x / sqrt(2)) * (x > 0 ? exp(x * x / 2) : 1);
        out[0] = peak - x * j0;
        out[1] = j0 - x * out[0];
        return;
    }
    double ratio = (sqrt(x * x + 4 * (double)TERMS) - x) / 2, above = ratio;
    for (int n = TERMS - 1; n > 0; n--) {
        above = ratio;
        ratio = n / (x + above);
    }
    out[0] = ratio / (x + ratio);
    out[1] = above * out[0];
}

void profile_peak(double z, double alpha, double *pdf, double *curvature) {
    *pdf = *curvature = NAN;
    if (!in_domain(alpha) || isnan(z))
        return;
    /* At the height, s is a normal of this mean and deviation; u is s over the deviation. */
    double variance = (alpha - 1) / alpha, deviation = sqrt(variance), mean = z / sqrt(alpha);
    double exponent = z > 0 ? -z * z / 2 : -z * z / (2 * variance), moments[2];
    half_normal_moments(-mean / deviation, moments);
    *pdf = exponent < -700 ? 0 : exp(exponent) * moments[0] * sqrt(variance / (2 * M_PI));
    *curvature = isfinite(z) ? deviation * moments[1] / moments[0] : (double)NAN;
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
