/* Where a measured surface lies among random surfaces like it (FORMULAS.md, F18.28). */
#ifndef RUGO_JOBS_LIKE_PERCENTILE_H
#define RUGO_JOBS_LIKE_PERCENTILE_H

#include "jobs/like_case.h"
#include "jobs/realisations.h"
#include "schema/result/result.h"

/* How many of the values that are there (others are NaN) are below a measured one, and so on. */
struct like_place {
    size_t below, equal, above;
};
struct like_place like_place_of(size_t n, const double *values, double measured);
/* The measured one's place in a hundred, drawn among the others: 100 (below + (equal + 1)/2) over
 * one more than they are. Its standard error is that of a share of so many. NaN without others, or
 * where it was not measured. */
double like_percentile(const struct like_place *place, double *standard_error);

/* Appends, of each quantity of a case whose pieces are cut, three scalars: "piece_NAME", its mean
 * over the pieces, "measured_NAME", that of the measured map, and "percentile_NAME". first: the
 * number of the scalar of a realisation that is the first quantity. */
int like_scalars(const struct like_case *like, const struct realisations *realisations,
                 size_t first, struct case_result *out, struct error *err);

#endif
