/* The theory of each curve, averaged over bins, as that is what a histogram estimates. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_THEORY_H
#define RUGO_JOBS_STATISTICS_STATISTICS_THEORY_H

#include "jobs/statistics/statistics_case.h"

/* Returns whether theory of summits without a grid applies: an isotropic spectrum of finite moments
 * with alpha above 3/2 (profiles: 1). */
bool statistics_theory_applies(const struct statistics_case *one_case,
                               const struct moments *moments);
/* Returns its name: "nayak", and for profiles "longuet_higgins" (Cartwright & Longuet-Higgins
 * 1956). */
const char *statistics_theory_name(const struct statistics_case *one_case);

/* Fills the prescribed height distribution: mean density of each bin; cumulative at its upper
 * edge. */
int statistics_theory_heights(const struct statistics_case *one_case, double *pdf, double *cdf,
                              struct error *err);
/* Fills the same of summit heights, and the mean curvature kappa_m/sqrt(m4) of the summits in each
 * bin. */
void statistics_theory_summits(const struct statistics_case *one_case, double alpha, double *pdf,
                               double *cdf, double *curvature);
/* Computes the mean density of each t1 bin. */
void statistics_theory_equivalent(const struct statistics_case *one_case, double *pdf);
/* Fills height.count x equivalent.count values, in which t1 runs fastest. */
void statistics_theory_joint(const struct statistics_case *one_case, double alpha, double *pdf);

#endif
