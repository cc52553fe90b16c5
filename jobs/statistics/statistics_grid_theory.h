/* Theory of the grid in use (F8.4, F8.5) beside theory without a grid: the series "grid" of curves
 * of summits, and `grid` of scalars. Among these, `isotropy` (3 m22/m4), which is 1 in theory where
 * the spectrum is isotropic, and `spectrum_clipped` depend on the spectrum alone. Theory of summits
 * exists for Gaussian surfaces and for translated ones, of these but for densities of curvatures
 * and for exact curvatures; refined summits need none. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_GRID_THEORY_H
#define RUGO_JOBS_STATISTICS_STATISTICS_GRID_THEORY_H

#include "core/theory/sampled_summits.h"
#include "jobs/statistics/statistics_case.h"

extern const char STATISTICS_GRID_THEORY[]; /* "grid" */

/* Returns whether moments by differences follow from the spectrum: not with grooves or kinks, nor
 * where iterated heights are set point by point and so have waves outside of it. */
bool statistics_grid_theory_moments(const struct statistics_case *one_case);
/* Returns whether there is a theory of summits on the grid. */
bool statistics_grid_theory_applies(const struct statistics_case *one_case);
/* Computes it; pits: of the summits of the mirrored surface. bins as sampled_summits has them. */
int statistics_grid_theory_summits(const struct statistics_case *one_case,
                                   const struct surface_basis *basis, bool pits,
                                   struct sampled_summits *out, const struct sampled_bins *bins,
                                   struct error *err);
/* Adds the theory to the curves and scalars of a result, whose arena owns it; of the joint density
 * its name alone. */
int statistics_grid_theory(const struct statistics_case *one_case,
                           const struct surface_basis *basis, struct case_result *out,
                           struct error *err);
/* Fills its joint density, height.count x equivalent.count values, in which t1 runs fastest. */
int statistics_grid_theory_joint(const struct statistics_case *one_case,
                                 const struct surface_basis *basis, double *pdf, struct error *err);

#endif
