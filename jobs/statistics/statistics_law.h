/* The law difference of statistics: some realisations are also made under the other law of heights
 * (other_law.h), from the same random numbers. The changes of summits, pits and heights in these
 * pairs estimate what that law would give, each surface in units of its own moments. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_LAW_H
#define RUGO_JOBS_STATISTICS_STATISTICS_LAW_H

#include "jobs/statistics/statistics_scalars.h"

/* Sums of all pairs, by groups of pairs: of the surfaces of the case, and of those of the other
 * law. Both are empty where there is one law. */
enum pair_surface { PAIR_OWN, PAIR_OTHER, PAIR_SURFACES };

struct statistics_law;
/* Borrows the case. *out is NULL where heights are Gaussian, which have one law. moments: of the
 * surfaces of the case. */
int statistics_law_create(struct statistics_law **out, const struct statistics_case *one_case,
                          const struct moments *moments, struct error *err);
void statistics_law_destroy(struct statistics_law **law);
/* Fills the scalars of the surface of the other law, and adds both surfaces to the sums of pairs,
 * if this realisation is one that has them and there are such surfaces. own: the summits and pits
 * of the surface of the case. */
int statistics_law_measure(struct statistics_law *law, const struct realisation *realisation,
                           const struct summit_list own[],
                           struct statistics_groups pairs[PAIR_SURFACES],
                           double scalars[SCALAR_COUNT], struct error *err);
/* Return the bytes of this object, the mean CPU seconds a realisation on a 3 GHz core, and what
 * a realisation takes beyond that. */
double statistics_law_bytes(const struct statistics_case *one_case);
double statistics_law_seconds(const struct statistics_case *one_case);
double statistics_law_beyond_seconds(const struct statistics_case *one_case, uint64_t realisation);

/* Adds one surface of a pair, in its scales, to the sums of curves of a group. counts: scratch. */
void statistics_pair_add(const struct statistics_case *one_case, struct summit_counts *counts,
                         const struct summit_scales *scales, size_t group, const double *z,
                         const struct summit_list summits[], struct statistics_groups *sums);

/* Returns whether sums of pairs can be those of some realisations of a tally. */
bool statistics_law_fits(const struct statistics_groups pairs[PAIR_SURFACES],
                         const struct statistics_tally *tally);
/* Adds the law difference to the scalars that are measured again, to densities, and to curves of
 * heights, summits and pits; the joint density and spectra have none. */
int statistics_law_differences(const struct statistics_case *one_case,
                               const struct realisations *realisations,
                               const struct statistics_groups pairs[PAIR_SURFACES],
                               struct case_result *out, struct error *err);

#endif
