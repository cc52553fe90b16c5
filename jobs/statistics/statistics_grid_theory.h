/* Theory of the grid in use (F8.4, F8.5) beside theory without a grid: the series "grid" of curves
 * of summits, and `grid` of scalars. Among these, `isotropy` (3 m22/m40) and `spectrum_clipped`
 * depend on the spectrum alone. Theory of summits exists for Gaussian heights alone; refined
 * summits need none. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_GRID_THEORY_H
#define RUGO_JOBS_STATISTICS_STATISTICS_GRID_THEORY_H

#include "jobs/statistics/statistics_case.h"

extern const char STATISTICS_GRID_THEORY[]; /* "grid" */

/* Adds the theory to the curves and scalars of a result, whose arena owns it; of the joint density
 * its name alone. */
int statistics_grid_theory(const struct statistics_case *one_case,
                           const struct surface_basis *basis, struct case_result *out,
                           struct error *err);
/* Fills its joint density, height.count x equivalent.count values, in which t1 runs fastest. */
int statistics_grid_theory_joint(const struct statistics_case *one_case,
                                 const struct surface_basis *basis, double *pdf, struct error *err);

#endif
