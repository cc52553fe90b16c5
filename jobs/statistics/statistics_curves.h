/* Makes curves of tallies: densities, cumulative densities, curvature, spectra. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_CURVES_H
#define RUGO_JOBS_STATISTICS_STATISTICS_CURVES_H

#include "jobs/statistics/statistics_tally.h"
#include "jobs/statistics/statistics_theory.h"
#include "schema/result/result.h"

/* Appends all curves to the result, whose arena owns them. */
int statistics_curves(const struct statistics_case *one_case, const struct modes *modes,
                      const struct summit_theories *theories, const struct statistics_tally *tally,
                      struct case_result *out, struct error *err);
/* Makes the theories of which the curves have the name alone (that of the joint density). */
int statistics_curves_complete(const struct statistics_case *one_case,
                               const struct surface_basis *basis, struct case_result *result,
                               struct error *err);

#endif
