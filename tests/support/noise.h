/* Maps of independent Gaussian heights, of mean 0 and RMS 1, for tests. */
#ifndef RUGO_TESTS_SUPPORT_NOISE_H
#define RUGO_TESTS_SUPPORT_NOISE_H

#include "tests/support/seed.h"
#include <math.h>
#include <stddef.h>

static inline double noise_uniform(uint64_t *seed) {
    return ((double)(next_word(seed) >> 11) + 0.5) * 0x1p-53;
}

/* n: even (Box and Muller 1958). */
static inline void noise_fill(uint64_t *seed, size_t n, double *z) {
    for (size_t a = 0; a + 1 < n; a += 2) {
        double size = sqrt(-2 * log(noise_uniform(seed)));
        double angle = 2 * M_PI * noise_uniform(seed);
        z[a] = size * cos(angle);
        z[a + 1] = size * sin(angle);
    }
}

#endif
