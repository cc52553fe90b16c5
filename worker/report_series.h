/* The series of a case, told apart by model, mesh level and estimator: what each cost, and what it
 * owes to its mesh and to its model. Private to worker/. */
#ifndef RUGO_WORKER_REPORT_SERIES_H
#define RUGO_WORKER_REPORT_SERIES_H

#include <cjson/cJSON.h>
#include <stdbool.h>

/* |above - minus|/|below|, |.| being the root of the sum of squares over the points where all are
 * numbers; arrays of equal length, or matrices. minus may be NULL: 0. NaN where nothing is known.
 */
double relative_size(const cJSON *above, const cJSON *minus, const cJSON *below);

/* Relative, of the size of what they are counted from; NaN where they are unknown. */
struct series_errors {
    double discretisation; /* from the limit: the finest level less its own discretisation error */
    double model; /* of the model's limit from that of the most complete one; the same for all its
                     levels. Of a quantity without limits: from its curve on the same level */
};
/* curve: one of the curves of the case. Every realisation is solved on all levels by all models, so
 * that the differences are those of pairs. False when out of memory. */
bool series_errors(const cJSON *curves, const cJSON *curve, struct series_errors *out);

/* Share of the case's time that went into the solves behind a curve: its points x transforms x log2
 * of the points (the curves "work"), over that of all models and levels. All estimators read the
 * same solves. 1 where the case has no such parts. */
double series_share(const cJSON *curves, const cJSON *curve);

#endif
