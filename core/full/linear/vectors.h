/* Sums over vectors of n values, of solvers whose vectors are short. Private to core/full/linear;
 * gmres.c, whose vectors are long, has sums of its own in wide lanes. */
#ifndef RUGO_CORE_FULL_LINEAR_VECTORS_H
#define RUGO_CORE_FULL_LINEAR_VECTORS_H

#include <stddef.h>

static inline double dot(size_t n, const double *a, const double *b) {
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

#endif
