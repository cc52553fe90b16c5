/* The law difference of statistics: some realisations are also made under the other law of heights
 * (other_law.h), from the same random numbers. The changes of summits, pits and heights in these
 * pairs estimate what that law would give. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_LAW_H
#define RUGO_JOBS_STATISTICS_STATISTICS_LAW_H

#include "jobs/statistics/statistics_scalars.h"

struct statistics_law;
/* Borrows the case. *out is NULL where heights are Gaussian, which have one law. */
int statistics_law_create(struct statistics_law **out, const struct statistics_case *one_case,
                          struct error *err);
void statistics_law_destroy(struct statistics_law **law);
/* Fills the scalars of the surface of the other law, if this realisation is one that has them and
 * there are such surfaces. */
int statistics_law_measure(struct statistics_law *law, struct random_key key,
                           double scalars[SCALAR_COUNT], struct error *err);
/* Return the bytes of this object, and the mean CPU seconds a realisation on a 3 GHz core. */
double statistics_law_bytes(const struct statistics_case *one_case);
double statistics_law_seconds(const struct statistics_case *one_case);

/* Adds the law difference to the scalars that are measured again and to densities. Curves have
 * none: of summits and pits under a translation there is the exact theory instead (F6.12). */
int statistics_law_differences(const struct statistics_case *one_case,
                               const struct realisations *realisations, struct case_result *out,
                               struct error *err);

#endif
