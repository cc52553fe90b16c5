#include "jobs/surface/translated_case.h"
#include "core/surface/translation/translation.h"
#include "jobs/surface/other_law.h"

bool translated_case_applies(const struct surface_case *surface, const struct moments *gaussian) {
    const struct surface_case *counter = surface->counter;
    if (surface->spectrum.type == SPECTRUM_EXPONENTIAL_ACF ||
        (counter != NULL && counter->spectrum.type == SPECTRUM_EXPONENTIAL_ACF))
        return false; /* m2 and m4 grow without limit on finer grids */
    if (surface->dimension == 1)
        return gaussian->nayak_alpha > 1;
    return gaussian->nayak_alpha > 1.5 && moments_isotropic(gaussian);
}

/* modes: of a translated spectrum. */
static void describe(struct translated_case *out, const struct surface_case *surface,
                     const struct modes *modes) {
    out->surface = (struct translated_surface){
        .dimension = surface->dimension,
        .heights = {.function = translation_function(modes->translation)}};
    modes_gaussian_moments(modes, &out->surface.gaussian);
    modes_moments(modes, &out->surface.reached);
    out->exists = translated_case_applies(surface, &out->surface.gaussian);
}

static int create_beside(struct translated_case *out, const struct surface_case *surface,
                         struct error *err) {
    struct spectrum spectrum = surface->spectrum;
    struct modes *modes = NULL;
    int status = other_law_translate(&out->beside, surface, err);
    if (status != 0 || out->beside == NULL)
        return status;
    spectrum.translation = out->beside;
    status = modes_create(&modes, &spectrum, &surface->grid, err);
    if (status == 0)
        describe(out, surface, modes);
    modes_destroy(&modes);
    return status;
}

int translated_case_create(struct translated_case *out, const struct surface_case *surface,
                           const struct modes *modes, struct error *err) {
    struct error reason = {0};
    *out = (struct translated_case){0};
    if (surface_case_translated(surface))
        describe(out, surface, modes);
    if (surface_case_translated(surface) || !surface_is_iterated(&surface->options))
        return 0;
    int status = create_beside(out, surface, &reason);
    if (status == 0 || status == ERROR_INPUT) /* heights and spectra without one are no error */
        return 0;
    translated_case_clear(out);
    return error_set(err, status, "%s", reason.text);
}

void translated_case_clear(struct translated_case *translated) {
    translation_destroy(&translated->beside);
    *translated = (struct translated_case){0};
}
