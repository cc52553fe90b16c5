/* Means over all summits. Given the curvature s (F6.3: -t1; of profiles -z''/sqrt(m4)), the height
 * of a summit is normal about `rise` times s, so that the moments of heights are those of s. */
#include "core/theory/nayak.h"
#include <math.h>

/* Returns the integral over s > 0 of s^n exp(-a s^2). */
static double half_moment(double n, double a) {
    return tgamma((n + 1) / 2) / (2 * pow(a, (n + 1) / 2));
}

/* Returns the mean of s^n over all summits of a surface (F6.6). */
static double surface_moment(double n) {
    double front = sqrt(3 / M_PI) / 2;
    return front * (half_moment(n + 2, 0.25) - 2 * half_moment(n, 0.25) + 2 * half_moment(n, 0.75));
}

/* The s of peaks is Rayleigh distributed. */
static double profile_moment(double n) {
    return half_moment(n + 1, 0.5);
}

static void heights_fill(double (*moment)(double), double rise, double rest,
                         struct summit_expectation *out) {
    double m1 = moment(1), m2 = moment(2), m3 = moment(3), m4 = moment(4);
    double second = m2 - m1 * m1, third = m3 - 3 * m1 * m2 + 2 * m1 * m1 * m1;
    double fourth = m4 - 4 * m1 * m3 + 6 * m1 * m1 * m2 - 3 * m1 * m1 * m1 * m1;
    if (!(rest > 0))
        return; /* outside the domain */
    double square = rise * rise, variance = square * second + rest;
    out->height_skewness = square * rise * third / (variance * sqrt(variance));
    out->height_kurtosis =
        (square * square * fourth + 6 * square * second * rest + 3 * rest * rest) /
        (variance * variance);
}

struct summit_expectation summit_expectation(int dimension, double m2, double m4, double alpha) {
    struct summit_expectation out;
    if (dimension == 2) {
        out = (struct summit_expectation){.density = nayak_summit_density(m2, m4),
                                          .height_mean = nayak_summit_mean(alpha),
                                          .height_variance = nayak_summit_variance(alpha),
                                          .height_skewness = NAN,
                                          .height_kurtosis = NAN,
                                          .curvature = nayak_overall_curvature()};
        heights_fill(surface_moment, sqrt(3 / (4 * alpha)), 1 - 1.5 / alpha, &out);
        return out;
    }
    /* Cartwright & Longuet-Higgins (1956) with epsilon^2 = 1 - 1/alpha. */
    const double half_pi = 1.5707963267948966;
    out = (struct summit_expectation){.density = profile_peak_density(m2, m4),
                                      .height_mean = sqrt(half_pi / alpha),
                                      .height_variance = 1 - (half_pi - 1) / alpha,
                                      .height_skewness = NAN,
                                      .height_kurtosis = NAN,
                                      .curvature = sqrt(half_pi)};
    heights_fill(profile_moment, 1 / sqrt(alpha), 1 - 1 / alpha, &out);
    return out;
}
