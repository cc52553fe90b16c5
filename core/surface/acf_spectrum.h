/* The spectrum of an autocorrelation that is given by a table of lags. */
#ifndef RUGO_CORE_SURFACE_ACF_SPECTRUM_H
#define RUGO_CORE_SURFACE_ACF_SPECTRUM_H

#include "core/error.h"
#include <stddef.h>

struct acf_table {
    size_t n;
    const double *lag;         /* rising, the first is 0 */
    const double *correlation; /* in [-1, 1], the first is 1 */
};
/* A spectrum may be negative for this share of the variance, in waves that are then left out. */
#define ACF_NEGATIVE_MOST 0.01

/* Checks the table alone: ERROR_INPUT. */
int acf_table_check(const struct acf_table *table, struct error *err);
/* Fills the spectral densities at m rising wave numbers, up to a common factor: of a profile
 * (dimension 1), or of an isotropic surface (FORMULAS.md, F2.8). Beyond the last lag the
 * correlation is 0. Negative densities become 0; where they hold more than ACF_NEGATIVE_MOST of the
 * variance ERROR_INPUT, as no surface has such an autocorrelation; ERROR_MEMORY. */
int acf_spectrum(int dimension, const struct acf_table *table, size_t m, const double *wave_number,
                 double *density, struct error *err);

#endif
