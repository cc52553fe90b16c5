#include "jobs/statistics/statistics_theory.h"
#include "core/theory/bin_averages.h"

bool statistics_theory_applies(const struct statistics_case *one_case,
                               const struct moments *moments) {
    if (one_case->surface.spectrum.type == SPECTRUM_EXPONENTIAL_ACF)
        return false; /* m2 and m4 grow without limit on finer grids */
    if (one_case->surface.dimension == 1)
        return moments->nayak_alpha > 1;
    return moments->nayak_alpha > 1.5 && moments_isotropic(moments);
}

const char *statistics_theory_name(const struct statistics_case *one_case) {
    return one_case->surface.dimension == 2 ? "nayak" : "longuet_higgins";
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
