/* Means over many points in vectors: squares and the like are added up in interleaved lanes, and
 * the lanes of a row to a compensated sum. NaN is not there: a value that is none does not count.
 */
#ifndef RUGO_CORE_STATISTICS_LANES_H
#define RUGO_CORE_STATISTICS_LANES_H

#include "core/sum.h"
#include <stdbool.h>
#include <stddef.h>

enum { LANES = 64 };

/* Of one row, or part of it. Initialise with {0}. */
struct lanes {
    double sum[LANES], count[LANES];
};
static inline void lane_add(struct lanes *lanes, size_t l, double value) {
    bool there = value == value;
    lanes->sum[l] += there ? value : 0;
    lanes->count[l] += there ? 1 : 0;
}

/* Over all rows. Initialise with {0}. */
struct lane_mean {
    struct sum sum;
    double count;
};
/* Adds a row, whose lanes become zero. */
static inline void lane_mean_add(struct lane_mean *mean, struct lanes *lanes) {
    for (size_t n = LANES / 2; n > 0; n /= 2)
        for (size_t l = 0; l < n; l++) {
            lanes->sum[l] += lanes->sum[l + n];
            lanes->count[l] += lanes->count[l + n];
        }
    sum_add(&mean->sum, lanes->sum[0]);
    mean->count += lanes->count[0];
    for (size_t l = 0; l < LANES; l++)
        lanes->sum[l] = lanes->count[l] = 0;
}
/* Returns NaN where there was no value. */
static inline double lane_mean_value(const struct lane_mean *mean) {
    return mean->count > 0 ? sum_value(&mean->sum) / mean->count : (double)NAN;
}

#endif
