/* The other law of heights that are not Gaussian: of iterated surfaces the translation of a
 * Gaussian field, of translated surfaces the iteration (FORMULAS.md, F5). Both have the asked
 * spectrum and heights, and still are different random surfaces; how different, a case reports as
 * law_difference (result.h). Surfaces of both laws start from the same random numbers and have the
 * amplitudes of the case, fixed or random. */
#ifndef RUGO_JOBS_SURFACE_OTHER_LAW_H
#define RUGO_JOBS_SURFACE_OTHER_LAW_H

#include "jobs/surface/surface_case.h"

/* Returns whether there are two laws: heights are not Gaussian. */
static inline bool other_law_applies(const struct surface_case *surface) {
    return surface->options.heights.type != HEIGHTS_GAUSSIAN && surface->grooves == NULL;
}

/* Makes the translation with the spectrum and the heights of an iterated surface. *out, NULL
 * before, stays so where none comes within OTHER_LAW_MISFIT. ERROR_MEMORY alone. */
int other_law_translate(struct translation **out, const struct surface_case *surface,
                        struct error *err);

struct other_law;
/* Borrows the surface, to which other_law_applies. */
int other_law_create(struct other_law **out, const struct surface_case *surface, struct error *err);
void other_law_destroy(struct other_law **law);
/* Returns the surface under the other law; NULL where that has none with this spectrum and these
 * heights: no translation comes within OTHER_LAW_MISFIT. Borrowed, as below. */
const struct surface_case *other_law_surface(const struct other_law *law);
/* Return the prescribed spectrum of surfaces of the other law and their moments; of one that has
 * surfaces, as below. */
const struct modes *other_law_modes(const struct other_law *law);
const struct moments *other_law_moments(const struct other_law *law);
/* From now on keeps the Gaussian field of which translated surfaces are a function. gaussian: where
 * it will be, on the grid of the case; valid as long as the law. */
int other_law_keep_gaussian(struct other_law *law, const double **gaussian, struct error *err);
/* Changes what the next calls ask while a surface is made, as generator_set_stop. */
void other_law_set_stop(struct other_law *law, int (*stop)(void *context), void *context);
/* Makes the surface of this key. *z are its heights on the grid of the case, valid until the next
 * call. */
int other_law_make(struct other_law *law, struct random_key key, const double **z,
                   struct surface_report *report, struct error *err);
/* Return the bytes of this object, and the CPU seconds of a surface on a 3 GHz core. */
double other_law_bytes(const struct surface_case *surface);
double other_law_seconds(const struct surface_case *surface);

/* Share of the variance in the band that a translation may have at other wave numbers than asked
 * for (translation_fit): the default of /surface/heights/misfit. */
#define OTHER_LAW_MISFIT 0.01

#endif
