#include "jobs/statistics/statistics_theory.h"
#include "core/theory/bin_averages.h"
#include "core/theory/nayak.h"
#include "jobs/statistics/statistics_scalars.h"
#include <math.h>

bool statistics_theory_applies(const struct statistics_case *one_case,
                               const struct moments *moments) {
    const struct spectrum *spectrum = &one_case->surface.spectrum;
    if (one_case->surface.dimension == 1)
        return moments->nayak_alpha > 1;
    return moments->nayak_alpha > 1.5 && (spectrum->type != SPECTRUM_EXPONENTIAL_ACF ||
                                          spectrum->correlation_x == spectrum->correlation_y);
}

const char *statistics_theory_name(const struct statistics_case *one_case) {
    return one_case->surface.dimension == 2 ? "nayak" : "longuet_higgins";
}

static void theory_of_summits(const struct statistics_case *one_case, const struct moments *moments,
                              double *out) {
    int dimension = one_case->surface.dimension;
    double ratio = one_case->surface.wavelength_ratio, lx = one_case->surface.grid.lx;
    struct summit_expectation expected =
        summit_expectation(dimension, moments->m2, moments->m4, moments->nayak_alpha);
    out[SCALAR_SUMMIT_DENSITY] = expected.density;
    out[SCALAR_SUMMIT_DENSITY_PER_AREA] = expected.density * ratio;
    out[SCALAR_SUMMITS] = expected.density * lx;
    if (dimension == 2) {
        out[SCALAR_SUMMIT_DENSITY_PER_AREA] *= ratio;
        out[SCALAR_SUMMITS] *= one_case->surface.grid.ly;
    }
    out[SCALAR_SUMMIT_HEIGHT_MEAN] = expected.height_mean;
    out[SCALAR_SUMMIT_HEIGHT_VARIANCE] = expected.height_variance;
    out[SCALAR_SUMMIT_CURVATURE_MEAN] = expected.curvature;
}

void statistics_theory_scalars(const struct statistics_case *one_case,
                               const struct moments *moments, double *out) {
    struct height_moments heights;
    for (size_t a = 0; a < SCALAR_COUNT; a++)
        out[a] = NAN;
    out[SCALAR_RMS_HEIGHT] = moments->rms_height;
    out[SCALAR_RMS_SLOPE] = moments->rms_slope;
    out[SCALAR_RMS_CURVATURE] = moments->rms_curvature;
    if (heights_moments(&one_case->surface.options.heights, &heights, NULL) == 0) {
        out[SCALAR_SKEWNESS] = heights.skewness;
        out[SCALAR_KURTOSIS] = heights.kurtosis;
    }
    out[SCALAR_M2_DIFFERENCE] = moments->m2;
    out[SCALAR_M4_DIFFERENCE] = moments->m4;
    out[SCALAR_NAYAK_ALPHA_DIFFERENCE] = moments->nayak_alpha;
    if (!surface_case_exact(&one_case->surface)) {
        out[SCALAR_M0] = moments->m0;
        out[SCALAR_M2] = moments->m2;
        out[SCALAR_M4] = moments->m4;
        out[SCALAR_NAYAK_ALPHA] = moments->nayak_alpha;
    }
    if (statistics_theory_applies(one_case, moments))
        theory_of_summits(one_case, moments, out);
}

int statistics_theory_heights(const struct statistics_case *one_case, double *pdf, double *cdf,
                              struct error *err) {
    return bin_averages_heights(&one_case->surface.options.heights, &one_case->height, pdf, cdf,
                                err);
}

void statistics_theory_summits(const struct statistics_case *one_case, double alpha, double *pdf,
                               double *cdf, double *curvature) {
    bin_averages_summits(one_case->surface.dimension, alpha, &one_case->height, pdf, cdf,
                         curvature);
}

void statistics_theory_equivalent(const struct statistics_case *one_case, double *pdf) {
    bin_averages_curvatures(one_case->surface.dimension, &one_case->equivalent, pdf);
}

void statistics_theory_joint(const struct statistics_case *one_case, double alpha, double *pdf) {
    bin_averages_joint(one_case->surface.dimension, alpha, &one_case->height, &one_case->equivalent,
                       pdf);
}
