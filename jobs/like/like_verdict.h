/* Whether a measured surface may be one of the random surfaces like it (FORMULAS.md, F18.45). */
#ifndef RUGO_JOBS_LIKE_LIKE_VERDICT_H
#define RUGO_JOBS_LIKE_LIKE_VERDICT_H

#include "core/error.h"
#include "core/statistics/patch.h"

struct like_verdict {
    /* of the measured surface from the mean over all patches, itself among them, in their standard
     * deviations; NaN: not measured, or alike in all */
    double difference[PATCH_QUANTITY_COUNT];
    double p_value; /* of the largest of them; NaN: there is none */
    double standard_error;
};
/* values: PATCH_QUANTITY_COUNT rows of the n sub-maps, NaN where one has none; measured: likewise
 * of the measured surface. ERROR_MEMORY alone. */
int like_verdict_measure(size_t n, const double *values, const double *measured,
                         struct like_verdict *out, struct error *err);

#endif
