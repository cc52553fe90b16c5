#include "jobs/statistics/statistics_theory.h"
#include "core/surface/translation/translation.h"
#include "core/theory/bin_averages.h"

const char STATISTICS_TRANSLATION[] = "translation";

int statistics_theory_heights(const struct statistics_case *one_case, double *pdf, double *cdf,
                              struct error *err) {
    return bin_averages_heights(&one_case->surface.options.heights, &one_case->height, pdf, cdf,
                                err);
}

/* --- the theories of a case --- */

/* Returns whether theory of summits applies to a Gaussian field of these moments. */
static bool applies(const struct surface_case *surface, const struct moments *moments) {
    if (surface->spectrum.type == SPECTRUM_EXPONENTIAL_ACF)
        return false; /* m2 and m4 grow without limit on finer grids */
    if (surface->dimension == 1)
        return moments->nayak_alpha > 1;
    return moments->nayak_alpha > 1.5 && moments_isotropic(moments);
}

static void add_gaussian(struct summit_theories *out, const struct surface_case *surface,
                         const struct moments *moments) {
    if (applies(surface, moments))
        out->of[out->count++] = (struct summit_theory){
            .name = surface->dimension == 2 ? "nayak" : "longuet_higgins",
            .surface = {.dimension = surface->dimension, .reached = *moments}};
}

/* Adds that of translated surfaces, whose field has these modes. */
static void add_translated(struct summit_theories *out, const struct surface_case *surface,
                           const struct modes *modes) {
    struct translated_surface translated = {
        .dimension = surface->dimension,
        .heights = {.function = translation_function(modes->translation)}};
    modes_gaussian_moments(modes, &translated.gaussian);
    modes_moments(modes, &translated.reached);
    if (applies(surface, &translated.gaussian))
        out->of[out->count++] = (struct summit_theory){
            .name = STATISTICS_TRANSLATION, .translated = true, .surface = translated};
}

/* A translated surface is that of an iterated one where its spectrum is within this share of the
 * variance, as studies of the law ask for. */
static const double MISFIT_MOST = 0.01;

/* Adds the translated surface beside an iterated one. Heights and spectra without one are no
 * error. */
static int add_beside(struct summit_theories *out, const struct surface_case *surface,
                      const struct grid *grid, struct error *err) {
    struct spectrum spectrum = surface->spectrum;
    struct modes *modes = NULL;
    int status = translation_create(&out->translation, &spectrum, surface->dimension,
                                    &surface->options.heights, err);
    if (status != 0)
        return status == ERROR_INPUT ? 0 : status;
    if (!(translation_fit(out->translation)->misfit <= MISFIT_MOST))
        return 0;
    spectrum.translation = out->translation;
    status = modes_create(&modes, &spectrum, grid, err);
    if (status == 0)
        add_translated(out, surface, modes);
    modes_destroy(&modes);
    return status == ERROR_INPUT ? 0 : status;
}

int summit_theories_create(struct summit_theories *out, const struct statistics_case *one_case,
                           const struct surface_basis *basis, struct error *err) {
    const struct surface_case *surface = &one_case->surface;
    struct error reason = {0};
    *out = (struct summit_theories){0};
    if (surface_case_translated(surface)) {
        add_translated(out, surface, basis->modes);
        return 0;
    }
    add_gaussian(out, surface, &basis->moments);
    if (out->count == 0 || !surface_is_iterated(&surface->options))
        return 0;
    int status = add_beside(out, surface, &surface->grid, &reason);
    if (status == 0)
        return 0;
    summit_theories_clear(out);
    return error_set(err, status, "%s", reason.text);
}

void summit_theories_clear(struct summit_theories *theories) {
    translation_destroy(&theories->translation);
    *theories = (struct summit_theories){0};
}

/* --- values --- */

static struct translated_surface side_of(const struct summit_theory *theory, bool pits) {
    struct translated_surface surface = theory->surface;
    surface.heights.mirrored = pits;
    return surface;
}

struct summit_expectation summit_theory_expectation(const struct summit_theory *theory, bool pits) {
    const struct translated_surface surface = side_of(theory, pits);
    const struct moments *m = &surface.reached;
    return theory->translated ? translated_summits_expectation(&surface)
                              : summit_expectation(surface.dimension, m->m2, m->m4, m->nayak_alpha);
}

void summit_theory_heights(const struct summit_theory *theory,
                           const struct statistics_case *one_case, bool pits, double *pdf,
                           double *cdf, double *curvature) {
    const struct translated_surface surface = side_of(theory, pits);
    const struct bins *bins = &one_case->height;
    if (theory->translated)
        translated_summits_heights(&surface, bins, pdf, cdf, curvature);
    else
        bin_averages_summits(surface.dimension, surface.reached.nayak_alpha, bins, pdf, cdf,
                             curvature);
}

void summit_theory_equivalent(const struct summit_theory *theory,
                              const struct statistics_case *one_case, bool pits, double *pdf) {
    const struct translated_surface surface = side_of(theory, pits);
    const struct bins *bins = &one_case->equivalent;
    if (theory->translated)
        translated_summits_curvatures(&surface, bins, pdf);
    else
        bin_averages_curvatures(surface.dimension, bins, pdf);
}

void summit_theory_joint(const struct summit_theory *theory, const struct statistics_case *one_case,
                         bool pits, double *pdf) {
    const struct translated_surface surface = side_of(theory, pits);
    const struct bins *height = &one_case->height, *t1 = &one_case->equivalent;
    if (theory->translated)
        translated_summits_joint(&surface, height, t1, pdf);
    else
        bin_averages_joint(surface.dimension, surface.reached.nayak_alpha, height, t1, pdf);
}
