/* The percentile of a measured surface among random surfaces like it (FORMULAS.md, F18.28). */
#ifndef RUGO_JOBS_LIKE_LIKE_PERCENTILE_H
#define RUGO_JOBS_LIKE_LIKE_PERCENTILE_H

#include "jobs/like/like_case.h"
#include "jobs/realisations.h"
#include "schema/result/result.h"

/* How many of the values (NaN: none) are below, equal to and above a measured one. */
struct like_place {
    size_t below, equal, above;
};
struct like_place like_place_of(size_t n, const double *values, double measured);
/* Returns the percentile of the measured value as one of all: 100 (below + (equal + 1)/2) over
 * their number plus one. Its standard error is that of a share of so many. NaN without values, or
 * if it was not measured. */
double like_percentile(const struct like_place *place, double *standard_error);

/* Appends four scalars for each quantity of a case with sub-maps: "piece_NAME", its mean over the
 * sub-maps, "measured_NAME", that of the measured map, "percentile_NAME", and "difference_NAME"
 * (like_verdict.h); then "like_p_value", of the largest difference. first: the number of the scalar
 * of a realisation that is the first quantity. */
int like_scalars(const struct like_case *like, const struct realisations *realisations,
                 size_t first, struct case_result *out, struct error *err);

#endif
