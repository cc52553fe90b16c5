/* Curves of statistics by groups of realisations, of which differences of cases of the same random
 * numbers are made. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_PAIRS_H
#define RUGO_JOBS_STATISTICS_STATISTICS_PAIRS_H

#include "jobs/statistics/statistics_tally.h"

/* As job_kind has it: of densities, cumulative ones and the mean curvature of summits. */
bool statistics_point_groups(const struct statistics_tally *tally, const struct curve *curve,
                             size_t at, struct point_groups *out);

#endif
