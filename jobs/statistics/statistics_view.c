/* How the results of studies of statistics are shown: the summits of each case beside theory. */
#include "jobs/statistics/statistics_view.h"
#include "schema/result/view.h"

static const char *const HEADLINES[] = {"nayak_alpha",
                                        "summit_density",
                                        "summit_height_mean",
                                        "summit_curvature_mean",
                                        "eps_h",
                                        "eps_s",
                                        "generator_converged",
                                        "percentile_skewness",
                                        "percentile_kurtosis",
                                        "percentile_correlation_length",
                                        "percentile_summit_density",
                                        "percentile_summit_curvature_mean",
                                        NULL};
static const struct logarithmic_picture LOGARITHMIC[] = {
    {"psd", NULL}, {"nayak_alpha_by_ratio", NULL}, {NULL, NULL}};
const struct result_view STATISTICS_VIEW = {.headlines = HEADLINES, .logarithmic = LOGARITHMIC};
