/* The error "generation": on some realisations the surface is found again in other ways
 * (surface_paths.h). What summits, pits and heights change in these pairs is what a surface owes to
 * the way it was found. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_GENERATION_H
#define RUGO_JOBS_STATISTICS_STATISTICS_GENERATION_H

#include "jobs/statistics/statistics_scalars.h"

/* Whether anything is iterated: heights are not Gaussian. */
bool statistics_generation_applies(const struct statistics_case *one_case);

struct statistics_generation;
/* Borrows the case and the finder. *out is NULL where it does not apply. moments: of the prescribed
 * spectrum. */
int statistics_generation_create(struct statistics_generation **out,
                                 const struct statistics_case *one_case,
                                 const struct moments *moments, struct summit_finder *finder,
                                 struct error *err);
void statistics_generation_destroy(struct statistics_generation **generation);
/* Fills the other scalars of this realisation where it is one of those that are measured again;
 * own: what its own generation did. */
int statistics_generation_measure(struct statistics_generation *generation, struct random_key key,
                                  const struct surface_report *own, double scalars[SCALAR_COUNT],
                                  struct error *err);
/* Of this object; and CPU seconds a realisation in the mean of many, on a 3 GHz core. */
double statistics_generation_bytes(const struct statistics_case *one_case);
double statistics_generation_seconds(const struct statistics_case *one_case);

/* Tells the error of every scalar and curve of a result. */
int statistics_generation_errors(const struct statistics_case *one_case,
                                 const struct realisations *realisations, struct case_result *out,
                                 struct error *err);

#endif
