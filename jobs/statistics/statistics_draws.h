/* What a patch leaves open of the statistics of surfaces like it: some realisations are also made
 * with drawn parameters (jobs/like/like_draw.h), from the same random numbers. The changes of
 * scalars, heights, summits and pits in these pairs estimate the error "patch". Heights and
 * curvatures over moments are over those of the surfaces that they are of. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_DRAWS_H
#define RUGO_JOBS_STATISTICS_STATISTICS_DRAWS_H

#include "jobs/like/like_draw.h"
#include "jobs/statistics/statistics_law.h"

struct statistics_draws;
/* Borrows the case. *out is NULL where it has no draws. moments: of the surfaces of the case. */
int statistics_draws_create(struct statistics_draws **out, const struct statistics_case *one_case,
                            const struct moments *moments, struct error *err);
void statistics_draws_destroy(struct statistics_draws **draws);
/* Adds the realisation and the surface of drawn parameters to the sums of pairs, which are by draw,
 * if this realisation is one that has a draw, and there is such a surface. own: the summits and
 * pits of the realisation, scalars its own. Does nothing for NULL. */
int statistics_draws_measure(struct statistics_draws *draws, const struct realisation *realisation,
                             const struct summit_list own[], const double scalars[SCALAR_COUNT],
                             struct statistics_groups pairs[PAIR_SURFACES], struct error *err);
/* Makes empty sums; none where the case has no draws. */
int statistics_draws_sums(struct statistics_groups pairs[PAIR_SURFACES],
                          const struct statistics_case *one_case, struct error *err);
/* Returns whether sums can be those of draws of so many realisations. */
bool statistics_draws_fit(const struct statistics_groups pairs[PAIR_SURFACES],
                          uint64_t realisations);
/* Return the bytes of this object with its sums, and the CPU seconds of a draw on a 3 GHz core. */
double statistics_draws_bytes(const struct statistics_case *one_case);
double statistics_draws_seconds(const struct statistics_case *one_case);

/* Adds the error "patch" to the scalars of surfaces, and to densities, cumulative ones and curves
 * of heights, summits and pits. It is not known of spectra and of the joint density. */
int statistics_draws_errors(const struct statistics_case *one_case,
                            const struct statistics_groups pairs[PAIR_SURFACES],
                            struct case_result *out, struct error *err);

#endif
