/* The lay of a map by its spectrum: FORMULAS.md, F18.29. */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_LAY_FIT_H
#define RUGO_CORE_STATISTICS_SPECTRA_LAY_FIT_H

#include "core/statistics/spectra/spectrum_range.h"

/* Refines a lay, such as that of the slopes, until the waves are most likely of ellipses of one
 * ratio and angle, whatever the density from ellipse to ellipse; fills the standard errors. Waves
 * count as those of Gaussian heights with random amplitudes. circles: of a surface. Where the waves
 * determine no lay *out is LAY_NONE. ERROR_INPUT as spectrum_range_find(), ERROR_MEMORY. */
int lay_fit_measure(struct lay *out, const struct lay *start, const struct map_spectrum *circles,
                    const struct spectrum_fit_request *request, struct error *err);

/* Returns the probability with which an isotropic surface has a lay as sure (Wald 1943). */
double lay_p_value(const struct lay *lay);

#endif
