#include "jobs/statistics/statistics_theory.h"
#include "core/theory/nayak.h"
#include "jobs/statistics/statistics_scalars.h"
#include <math.h>

/* Gauss-Legendre on [-1, 1]. */
enum { NODES = 4 };
static const double NODE[NODES] = {-0.86113631159405258, -0.33998104358485626, 0.33998104358485626,
                                   0.86113631159405258};
static const double WEIGHT[NODES] = {0.34785484513745386, 0.65214515486254614, 0.65214515486254614,
                                     0.34785484513745386};

static double node_in(const struct bins *bins, size_t b, int q) {
    return bins_centre(bins, b) + bins_width(bins) / 2 * NODE[q];
}

static double upper_edge(const struct bins *bins, size_t b) {
    return bins->low + (double)(b + 1) * bins_width(bins);
}

bool statistics_theory_applies(const struct statistics_case *study, const struct moments *moments) {
    const struct spectrum *spectrum = &study->surface.spectrum;
    if (study->surface.dimension == 1)
        return moments->nayak_alpha > 1;
    return moments->nayak_alpha > 1.5 && (spectrum->type != SPECTRUM_EXPONENTIAL_ACF ||
                                          spectrum->correlation_x == spectrum->correlation_y);
}

const char *statistics_theory_name(const struct statistics_case *study) {
    return study->surface.dimension == 2 ? "nayak" : "longuet_higgins";
}

static void theory_of_summits(const struct statistics_case *study, const struct moments *moments,
                              double *out) {
    double alpha = moments->nayak_alpha, ratio = study->surface.wavelength_ratio;
    if (study->surface.dimension == 2) {
        out[SCALAR_SUMMIT_DENSITY] = nayak_summit_density(moments->m2, moments->m4);
        out[SCALAR_SUMMIT_DENSITY_PER_AREA] = out[SCALAR_SUMMIT_DENSITY] * ratio * ratio;
        out[SCALAR_SUMMITS] =
            out[SCALAR_SUMMIT_DENSITY] * study->surface.grid.lx * study->surface.grid.ly;
        out[SCALAR_SUMMIT_HEIGHT_MEAN] = nayak_summit_mean(alpha);
        out[SCALAR_SUMMIT_HEIGHT_VARIANCE] = nayak_summit_variance(alpha);
        out[SCALAR_SUMMIT_CURVATURE_MEAN] = nayak_overall_curvature();
        return;
    }
    /* Cartwright & Longuet-Higgins (1956), epsilon^2 = 1 - 1/alpha: mean sqrt(pi/2) / sqrt(alpha),
     * variance 1 - (pi/2 - 1)/alpha; curvatures of all peaks are Rayleigh distributed. */
    const double half_pi = 1.5707963267948966;
    out[SCALAR_SUMMIT_DENSITY] = profile_peak_density(moments->m2, moments->m4);
    out[SCALAR_SUMMIT_DENSITY_PER_AREA] = out[SCALAR_SUMMIT_DENSITY] * ratio;
    out[SCALAR_SUMMITS] = out[SCALAR_SUMMIT_DENSITY] * study->surface.grid.lx;
    out[SCALAR_SUMMIT_HEIGHT_MEAN] = sqrt(half_pi / alpha);
    out[SCALAR_SUMMIT_HEIGHT_VARIANCE] = 1 - (half_pi - 1) / alpha;
    out[SCALAR_SUMMIT_CURVATURE_MEAN] = sqrt(half_pi);
}

void statistics_theory_scalars(const struct statistics_case *study, const struct moments *moments,
                               double *out) {
    struct height_moments heights;
    for (size_t a = 0; a < SCALAR_COUNT; a++)
        out[a] = NAN;
    out[SCALAR_RMS_HEIGHT] = moments->rms_height;
    out[SCALAR_RMS_SLOPE] = moments->rms_slope;
    out[SCALAR_RMS_CURVATURE] = moments->rms_curvature;
    if (heights_moments(&study->surface.options.heights, &heights, NULL) == 0) {
        out[SCALAR_SKEWNESS] = heights.skewness;
        out[SCALAR_KURTOSIS] = heights.kurtosis;
    }
    out[SCALAR_M2_DIFFERENCE] = moments->m2;
    out[SCALAR_M4_DIFFERENCE] = moments->m4;
    out[SCALAR_NAYAK_ALPHA_DIFFERENCE] = moments->nayak_alpha;
    if (!surface_case_exact(&study->surface)) {
        out[SCALAR_M0] = moments->m0;
        out[SCALAR_M2] = moments->m2;
        out[SCALAR_M4] = moments->m4;
        out[SCALAR_NAYAK_ALPHA] = moments->nayak_alpha;
    }
    if (statistics_theory_applies(study, moments))
        theory_of_summits(study, moments, out);
}

int statistics_theory_heights(const struct statistics_case *study, double *pdf, double *cdf,
                              struct error *err) {
    const struct heights *heights = &study->surface.options.heights;
    const struct bins *bins = &study->height;
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

void statistics_theory_summits(const struct statistics_case *study, double alpha, double *pdf,
                               double *cdf, double *curvature) {
    const struct bins *bins = &study->height;
    bool surface = study->surface.dimension == 2;
    for (size_t b = 0; b < bins->count; b++) {
        double density = 0, moment = 0, edge = upper_edge(bins, b);
        for (int q = 0; q < NODES; q++) {
            double z = node_in(bins, b, q);
            double p = surface ? nayak_summit_pdf(z, alpha) : profile_peak_pdf(z, alpha);
            double kappa =
                surface ? nayak_mean_curvature(z, alpha) : profile_mean_curvature(z, alpha);
            density += WEIGHT[q] / 2 * p;
            moment += WEIGHT[q] / 2 * p * kappa;
        }
        double centre = bins_centre(bins, b);
        pdf[b] = density;
        cdf[b] = surface ? nayak_summit_cdf(edge, alpha) : profile_peak_cdf(edge, alpha);
        /* far out both underflow: the curvature itself is smooth there */
        curvature[b] = density > 1e-200 ? moment / density
                       : surface        ? nayak_mean_curvature(centre, alpha)
                                        : profile_mean_curvature(centre, alpha);
    }
}

/* Marginal of the joint density over heights: Gaussian in z*, so that alpha drops out. Profiles:
 * Rice.*/
static double equivalent_pdf(int dimension, double t1) {
    if (!(t1 < 0))
        return 0;
    double square = t1 * t1;
    if (dimension == 1)
        return -t1 * exp(-square / 2);
    return 0.4886025119029199 * (square + 2 * expm1(-square / 2)) * exp(-square / 4);
}

void statistics_theory_equivalent(const struct statistics_case *study, double *pdf) {
    const struct bins *bins = &study->equivalent;
    for (size_t b = 0; b < bins->count; b++) {
        pdf[b] = 0;
        for (int q = 0; q < NODES; q++)
            pdf[b] += WEIGHT[q] / 2 * equivalent_pdf(study->surface.dimension, node_in(bins, b, q));
    }
}

void statistics_theory_joint(const struct statistics_case *study, double alpha, double *pdf) {
    const struct bins *height = &study->height, *equivalent = &study->equivalent;
    bool surface = study->surface.dimension == 2;
    for (size_t zb = 0; zb < height->count; zb++) {
        for (size_t tb = 0; tb < equivalent->count; tb++) {
            double density = 0;
            for (int p = 0; p < NODES; p++) {
                for (int q = 0; q < NODES; q++) {
                    double z = node_in(height, zb, p), t1 = node_in(equivalent, tb, q);
                    double joint = surface ? nayak_joint_pdf(z, t1, alpha)
                                           : profile_peak_joint_pdf(z, t1, alpha);
                    density += WEIGHT[p] * WEIGHT[q] / 4 * joint;
                }
            }
            pdf[zb * equivalent->count + tb] = density;
        }
    }
}
