#include "core/theory/bin_averages.h"
#include "core/theory/contact.h"
#include "core/theory/nayak.h"
#include "core/theory/quadrature.h"
#include <math.h>
#include <stdbool.h>

/* Below this mean density a bin's mean curvature is that at its centre: numerator and denominator
 * underflow there, while the curvature itself is smooth. */
static const double DENSITY_LEAST = 1e-200;

enum { PERSSON_PANELS = 4 };

static double node_in(const struct bins *bins, size_t b, int q) {
    return bins_centre(bins, b) + bins_width(bins) / 2 * GAUSS_4_NODES[q];
}

static double upper_edge(const struct bins *bins, size_t b) {
    return bins->low + (double)(b + 1) * bins_width(bins);
}

int bin_averages_heights(const struct heights *heights, const struct bins *bins, double *pdf,
                         double *cdf, struct error *err) {
    struct height_moments moments;
    int status = heights_moments(heights, &moments, err);
    if (status != 0)
        return status;
    double before = heights_cdf(heights, &moments, bins->low);
    for (size_t b = 0; b < bins->count; b++) {
        cdf[b] = heights_cdf(heights, &moments, upper_edge(bins, b));
        pdf[b] = (cdf[b] - before) / bins_width(bins);
        before = cdf[b];
    }
    return 0;
}

void bin_averages_summits(int dimension, double alpha, const struct bins *bins, double *pdf,
                          double *cdf, double *curvature) {
    bool surface = dimension == 2;
    for (size_t b = 0; b < bins->count; b++) {
        double density = 0, moment = 0, edge = upper_edge(bins, b);
        for (int q = 0; q < GAUSS_4; q++) {
            double z = node_in(bins, b, q);
            double p, kappa;
            if (surface) {
                p = nayak_summit_pdf(z, alpha);
                kappa = nayak_mean_curvature(z, alpha);
            } else {
                profile_peak(z, alpha, &p, &kappa);
            }
            density += GAUSS_4_WEIGHTS[q] / 2 * p;
            moment += GAUSS_4_WEIGHTS[q] / 2 * p * kappa;
        }
        double centre = bins_centre(bins, b);
        pdf[b] = density;
        cdf[b] = surface ? nayak_summit_cdf(edge, alpha) : profile_peak_cdf(edge, alpha);
        curvature[b] = density > DENSITY_LEAST ? moment / density
                       : surface               ? nayak_mean_curvature(centre, alpha)
                                               : profile_mean_curvature(centre, alpha);
    }
}

/* Returns the density of t1 over all summits: F6.6 with s = -t1; of profiles the Rayleigh density
 * (Rice 1945). */
static double curvature_pdf(int dimension, double t1) {
    static const double FRONT = 0.4886025119029199; /* sqrt(3)/(2 sqrt(pi)) */
    if (!(t1 < 0))
        return 0;
    double square = t1 * t1;
    if (dimension == 1)
        return -t1 * exp(-square / 2);
    return FRONT * (square + 2 * expm1(-square / 2)) * exp(-square / 4);
}

void bin_averages_curvatures(int dimension, const struct bins *bins, double *pdf) {
    for (size_t b = 0; b < bins->count; b++) {
        pdf[b] = 0;
        for (int q = 0; q < GAUSS_4; q++)
            pdf[b] += GAUSS_4_WEIGHTS[q] / 2 * curvature_pdf(dimension, node_in(bins, b, q));
    }
}

static double joint_mean(int dimension, double alpha, const struct bins *height, size_t zb,
                         const struct bins *t1, size_t tb) {
    double density = 0;
    for (int p = 0; p < GAUSS_4; p++)
        for (int q = 0; q < GAUSS_4; q++) {
            double z = node_in(height, zb, p), t = node_in(t1, tb, q);
            double joint =
                dimension == 2 ? nayak_joint_pdf(z, t, alpha) : profile_peak_joint_pdf(z, t, alpha);
            density += GAUSS_4_WEIGHTS[p] * GAUSS_4_WEIGHTS[q] / 4 * joint;
        }
    return density;
}

void bin_averages_joint(int dimension, double alpha, const struct bins *height,
                        const struct bins *t1, double *pdf) {
    for (size_t zb = 0; zb < height->count; zb++)
        for (size_t tb = 0; tb < t1->count; tb++)
            pdf[zb * t1->count + tb] = joint_mean(dimension, alpha, height, zb, t1, tb);
}

static double persson_density(double x, const void *load) {
    return persson_pressure_pdf(x, *(const double *)load);
}

void bin_averages_persson(double load, const struct bins *bins, double *pdf) {
    double width = bins_width(bins);
    for (size_t b = 0; b < bins->count; b++) {
        double low = bins->low + (double)b * width;
        pdf[b] = quadrature(persson_density, &load, low, low + width, PERSSON_PANELS) / width;
    }
}
