#include "jobs/like/like_verdict.h"
#include <math.h>
#include <stdlib.h>

/* Mean and standard deviation over the sub-maps that have a value and the measured surface. */
struct spread {
    double mean, deviation;
};

static struct spread spread_of(size_t n, const double *values, double measured) {
    double mean = measured, square = 0, count = 1;
    for (size_t r = 0; r < n; r++)
        if (!isnan(values[r])) {
            double from = values[r] - mean;
            count++;
            mean += from / count;
            square += from * (values[r] - mean);
        }
    return (struct spread){mean, sqrt(square / count)};
}

/* Takes the differences of all in one quantity; worst: the largest so far of each sub-map. */
static double take_differences(size_t n, const double *values, double measured, double *worst) {
    const struct spread spread = spread_of(n, values, measured);
    if (!(spread.deviation > 0))
        return (double)NAN;
    for (size_t r = 0; r < n; r++)
        worst[r] = fmax(worst[r], fabs(values[r] - spread.mean) / spread.deviation);
    return (measured - spread.mean) / spread.deviation;
}

int like_verdict_measure(size_t n, const double *values, const double *measured,
                         struct like_verdict *out, struct error *err) {
    static const double ROUNDING = 1e-9;
    double largest = (double)NAN, above = 0;
    double *worst = array_create(n + 1, sizeof *worst);
    *out = (struct like_verdict){.p_value = (double)NAN, .standard_error = (double)NAN};
    if (worst == NULL)
        return error_memory(err, n * sizeof *worst, "differences of sub-maps");
    for (size_t q = 0; q < PATCH_QUANTITY_COUNT; q++) {
        out->difference[q] = isfinite(measured[q])
                                 ? take_differences(n, values + q * n, measured[q], worst)
                                 : (double)NAN;
        largest = fmax(largest, fabs(out->difference[q]));
    }
    for (size_t r = 0; r < n; r++)
        above += worst[r] >= largest * (1 - ROUNDING) ? 1 : 0;
    free(worst);
    if (n == 0 || isnan(largest))
        return 0;
    out->p_value = (1 + above) / (double)(n + 1);
    out->standard_error = sqrt(out->p_value * (1 - out->p_value) / (double)n);
    return 0;
}
