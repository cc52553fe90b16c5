/* What the rings of a windowed map are expected to hold of a spectral density: the mean, over the
 * modes of a ring, of its convolution with the power of the window (FORMULAS.md, F18.14). Wave
 * numbers are in waves per shorter side here. */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_SPECTRUM_LEAKAGE_H
#define RUGO_CORE_STATISTICS_SPECTRA_SPECTRUM_LEAKAGE_H

#include "core/statistics/spectra/map_spectrum.h"

/* The density is taken at nodes, each for wave numbers within half a width of it. The
 * expectation of ring r, from `first` on, is the sum of weight[a] density[node[r - first] + a],
 * a from begin[r - first] below begin[r - first + 1]. */
struct spectrum_leakage {
    size_t first, count; /* rings */
    size_t nodes;
    double width;
    double *node;   /* owned, as all: rising */
    size_t *offset; /* per ring: its first node */
    size_t *begin;  /* count + 1 */
    double *weight;
};
int spectrum_leakage_create(struct spectrum_leakage **out, const struct map_spectrum *spectrum,
                            size_t first, size_t last, struct error *err);
void spectrum_leakage_destroy(struct spectrum_leakage **leakage);

/* expected[count] of density[nodes]. */
void spectrum_leakage_apply(const struct spectrum_leakage *leakage, const double *density,
                            double *expected);

#endif
