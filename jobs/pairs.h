/* The difference of two cases of one study by pairs of their realisations, whatever the kind. */
#ifndef RUGO_JOBS_PAIRS_H
#define RUGO_JOBS_PAIRS_H

#include "jobs/merger.h"

/* Fills an empty result with one case less the other (difference.h), from what both have merged.
 * common: they have the same random numbers, so that realisations of the same number are pairs. The
 * result's number of realisations is then of those in common, else the smaller of the two.
 * ERROR_INPUT where common cases have no realisation in common. On failure the result is cleared.
 * Both results are those of the mergers, with the theories and parameters wanted. */
int pairs_difference(const struct job_merger *minuend, const struct case_result *minuend_result,
                     const struct job_merger *subtrahend,
                     const struct case_result *subtrahend_result, bool common,
                     struct case_result *out, struct error *err);

#endif
