/* A law of surfaces with given heights: the translation field z = f(g) (Grigoriu 1984; Yamazaki &
 * Shinozuka 1988; Shields & Deodatis 2013; FORMULAS.md, F5.8 to F5.11).
 *
 * g is Gaussian and has unit variance. Its spectrum is 0 outside the band of the asked one, and
 * such that z has the asked shape inside. It is that of the endless field, by which cells of any
 * length and grid are samples of one law: their powers are those asked for, times a factor of |k|.
 * Immutable once made; many threads may read one. */
#ifndef RUGO_CORE_SURFACE_TRANSLATION_TRANSLATION_H
#define RUGO_CORE_SURFACE_TRANSLATION_TRANSLATION_H

#include "core/surface/modes.h"
#include "core/surface/translation/height_function.h"

struct translation;

/* dimension 1 or 2. Of the spectrum only the shape counts, not the scale. Copies its arguments.
 * ERROR_INPUT as height_function_create, and where over 1 % of the variance is at waves longer than
 * RADIAL_RATIO_MOST of the shortest (radial.h); ERROR_MEMORY. A spectrum that no such field has is
 * no error: the law is then that of least misfit (translation_fit). */
int translation_create(struct translation **out, const struct spectrum *spectrum, int dimension,
                       const struct heights *heights, struct error *err);
void translation_destroy(struct translation **translation);

const struct height_function *translation_function(const struct translation *translation);
/* Returns the factor of the asked power, up to a constant, at the wave number |k| > 0 of waves
 * along y. 1 for an exponential autocorrelation, whose lags are converted one by one. */
double translation_factor(const struct translation *translation, double k);

struct translation_fit {
    double outside; /* share of m0 that z has outside the band; NaN for an exponential
                       autocorrelation, which has none */
    double misfit; /* share of the variance inside the band that is at other wave numbers than asked
                      for; 0 up to rounding where the law exists */
    double misfit_wave_number; /* |k| where the densities differ most, per area in log |k| */
    size_t steps;              /* of the fixed point */
};
const struct translation_fit *translation_fit(const struct translation *translation);

/* Returns moments of z with the deviation `height` from those of g (F5.9). */
struct moments translation_moments(const struct translation *translation,
                                   const struct moments *gaussian, double height);

#endif
