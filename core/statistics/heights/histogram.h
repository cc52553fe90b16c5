/* Histograms with under- and overflow over equal bins; counts are exact integers. */
#ifndef RUGO_CORE_STATISTICS_HEIGHTS_HISTOGRAM_H
#define RUGO_CORE_STATISTICS_HEIGHTS_HISTOGRAM_H

#include "core/error.h"
#include <math.h>
#include <stddef.h>
#include <stdint.h>

struct bins {
    double low, high; /* low < high, finite */
    size_t count;     /* at least 1 */
};
static inline double bins_width(const struct bins *bins) {
    return (bins->high - bins->low) / (double)bins->count;
}
static inline double bins_centre(const struct bins *bins, size_t b) {
    return bins->low + ((double)b + 0.5) * bins_width(bins);
}
/* 0 underflow, 1..count inside, count + 1 overflow (also NaN). A value on an inner edge belongs to
 * the bin above, the value high to the last bin. */
static inline size_t bins_find(const struct bins *bins, double x) {
    if (x < bins->low)
        return 0;
    if (!(x <= bins->high))
        return bins->count + 1;
    double t = (x - bins->low) * ((double)bins->count / (bins->high - bins->low));
    size_t b = (size_t)t;
    return (b < bins->count ? b : bins->count - 1) + 1;
}

/* Adds n values, each times scale, to counts[count + 2]. */
void histogram_add(const struct bins *bins, size_t n, const double *values, double scale,
                   uint64_t *counts);

/* A reproducible sum: 128-bit fixed point in units of 2^-60, so that any order of adding and
 * merging gives the same bits. A value of 2^60 or more, or one that is not finite, is counted in
 * `lost` and left out, as is one that takes the total beyond 2^67. */
__extension__ typedef __int128 fixed_point;
struct exact_sum {
    fixed_point total;
    uint64_t lost;
};
void exact_sum_add(struct exact_sum *sum, double value);
void exact_sum_merge(struct exact_sum *sum, const struct exact_sum *other);
double exact_sum_value(const struct exact_sum *sum);

#endif
