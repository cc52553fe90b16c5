/* Neumaier's (1974) compensated sum: rounding does not grow with the number of terms. */
#ifndef RUGO_CORE_SUM_H
#define RUGO_CORE_SUM_H

#include <math.h>

struct sum { /* initialise with {0} */
    double total, rest;
};
static inline void sum_add(struct sum *sum, double x) {
    double total = sum->total + x;
    sum->rest += fabs(sum->total) >= fabs(x) ? (sum->total - total) + x : (x - total) + sum->total;
    sum->total = total;
}
static inline double sum_value(const struct sum *sum) {
    return sum->total + sum->rest;
}

#endif
