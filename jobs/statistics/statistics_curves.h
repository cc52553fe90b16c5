/* From tallies to curves: densities, cumulative densities, curvature, spectra. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_CURVES_H
#define RUGO_JOBS_STATISTICS_STATISTICS_CURVES_H

#include "jobs/statistics/statistics_tally.h"

/* An array of curves; caller deletes. moments are those of modes. */
int statistics_curves(const struct statistics_case *study, const struct modes *modes,
                      const struct moments *moments, const struct statistics_tally *tally,
                      cJSON **out, struct error *err);

#endif
