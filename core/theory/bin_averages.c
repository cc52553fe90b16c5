#include "core/theory/bin_averages.h"
#include "core/theory/contact.h"
#include "core/theory/nayak.h"
#include "core/theory/quadrature.h"
#include <math.h>
#include <stdbool.h>

/* Below this mean density a bin's mean curvature is that at its centre: numerator and denominator
 * underflow there, while the curvature itself is smooth. */
static const double DENSITY_LEAST = 1e-200;

/* Wide bins are integrated so far from the load: beyond, Persson's density is below exp(-128). */
static const double PERSSON_REACH = 8;
enum { PERSSON_PANELS = 4 };

/* Parts of a bin, each of which has the 4-point rule. Wide bins are divided, and beyond REACH,
 * where densities are below 1e-170 of their highest values, have none. */
struct bin_parts {
    size_t count;
    double centre, width; /* of the first part, and of each */
    double share;         /* of the bin in each part */
};
static const double PART_MOST = 0.25, REACH = 40;

static struct bin_parts parts_of(const struct bins *bins, size_t b) {
    double width = bins_width(bins), centre = bins_centre(bins, b);
    if (width <= PART_MOST)
        return (struct bin_parts){1, centre, width, 1};
    double low = fmax(centre - width / 2, -REACH), high = fmin(centre + width / 2, REACH);
    if (!(high > low))
        return (struct bin_parts){0, centre, 0, 0};
    size_t count = (size_t)ceil((high - low) / PART_MOST);
    double part = (high - low) / (double)count;
    return (struct bin_parts){count, low + part / 2, part, part / width};
}

/* Return the number of nodes of a bin, node n, and its weight: weights add up to twice
 * the share of the bin that has parts. */
static size_t nodes_of(const struct bin_parts *parts) {
    return GAUSS_4 * parts->count;
}

static double node_at(const struct bin_parts *parts, size_t n) {
    const size_t part = n / GAUSS_4;
    return parts->centre + (double)part * parts->width +
           parts->width / 2 * GAUSS_4_NODES[n % GAUSS_4];
}

static double weight_at(const struct bin_parts *parts, size_t n) {
    return parts->share * GAUSS_4_WEIGHTS[n % GAUSS_4];
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
        const struct bin_parts parts = parts_of(bins, b);
        for (size_t n = 0; n < nodes_of(&parts); n++) {
            double z = node_at(&parts, n), weight = weight_at(&parts, n);
            double p, kappa;
            if (surface) {
                p = nayak_summit_pdf(z, alpha);
                kappa = nayak_mean_curvature(z, alpha);
            } else {
                profile_peak(z, alpha, &p, &kappa);
            }
            density += weight / 2 * p;
            moment += weight / 2 * p * kappa;
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
        const struct bin_parts parts = parts_of(bins, b);
        pdf[b] = 0;
        for (size_t n = 0; n < nodes_of(&parts); n++)
            pdf[b] += weight_at(&parts, n) / 2 * curvature_pdf(dimension, node_at(&parts, n));
    }
}

static double joint_mean(int dimension, double alpha, const struct bins *height, size_t zb,
                         const struct bins *t1, size_t tb) {
    const struct bin_parts heights = parts_of(height, zb), curvatures = parts_of(t1, tb);
    double density = 0;
    for (size_t p = 0; p < nodes_of(&heights); p++)
        for (size_t q = 0; q < nodes_of(&curvatures); q++) {
            double z = node_at(&heights, p), t = node_at(&curvatures, q);
            double joint =
                dimension == 2 ? nayak_joint_pdf(z, t, alpha) : profile_peak_joint_pdf(z, t, alpha);
            density += weight_at(&heights, p) * weight_at(&curvatures, q) / 4 * joint;
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
    const double width = bins_width(bins);
    const bool wide = width > PERSSON_REACH;
    for (size_t b = 0; b < bins->count; b++) {
        double low = bins->low + (double)b * width, high = low + width;
        if (wide) {
            low = fmax(low, load - PERSSON_REACH);
            high = fmax(low, fmin(high, load + PERSSON_REACH));
        }
        size_t panels = wide ? 2 * PERSSON_PANELS : PERSSON_PANELS;
        pdf[b] = quadrature(persson_density, &load, low, high, panels) / width;
    }
}
