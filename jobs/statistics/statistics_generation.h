/* The error "generation": some realisations are also made by alternative generators
 * (surface_paths.h). The changes of summits, pits and heights in these pairs estimate the error. */
#ifndef RUGO_JOBS_STATISTICS_STATISTICS_GENERATION_H
#define RUGO_JOBS_STATISTICS_STATISTICS_GENERATION_H

#include "jobs/statistics/statistics_scalars.h"

/* Returns whether surfaces are made by iteration: heights are not Gaussian. */
bool statistics_generation_applies(const struct statistics_case *one_case);

struct statistics_generation;
/* Borrows the case and the finder. *out is NULL where the error does not apply. moments: of the
 * prescribed spectrum. */
int statistics_generation_create(struct statistics_generation **out,
                                 const struct statistics_case *one_case,
                                 const struct moments *moments, struct summit_finder *finder,
                                 struct error *err);
void statistics_generation_destroy(struct statistics_generation **generation);
/* Fills the scalars of the alternative surfaces, if this realisation is one that has them; own: the
 * report of its own generation. */
int statistics_generation_measure(struct statistics_generation *generation, struct random_key key,
                                  const struct surface_report *own, double scalars[SCALAR_COUNT],
                                  struct error *err);
/* Return the bytes of this object, and the mean CPU seconds a realisation on a 3 GHz core. */
double statistics_generation_bytes(const struct statistics_case *one_case);
double statistics_generation_seconds(const struct statistics_case *one_case);

/* Adds the error to every scalar and curve of a result. */
int statistics_generation_errors(const struct statistics_case *one_case,
                                 const struct realisations *realisations, struct case_result *out,
                                 struct error *err);

#endif
