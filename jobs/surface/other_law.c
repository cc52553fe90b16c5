#include "jobs/surface/other_law.h"
#include "core/cost.h"
#include "core/surface/spectrum.h"
#include <stdlib.h>

struct other_law {
    struct surface_case surface;     /* borrows from that of the case, but for the translation */
    struct translation *translation; /* owned, as all below; NULL: surfaces are iterated */
    struct generator *generator;     /* NULL: there are no such surfaces */
    struct moments moments;
    double *z, *gaussian;
};

/* Returns the options of the other law, with the amplitudes of the case. */
static struct surface_options options_of(const struct surface_case *surface) {
    struct surface_options options = surface->options;
    options.law = surface_case_translated(surface) ? LAW_ITERATED : LAW_TRANSLATION;
    return options;
}

int other_law_translate(struct translation **out, const struct surface_case *surface,
                        struct error *err) {
    struct error reason = {0};
    int status = translation_create(out, &surface->spectrum, surface->dimension,
                                    &surface->options.heights, &reason);
    if (status != 0)
        return status == ERROR_INPUT ? 0 : error_set(err, status, "%s", reason.text);
    if (!(translation_fit(*out)->misfit <= OTHER_LAW_MISFIT))
        translation_destroy(out);
    return 0;
}

static int make_generator(struct other_law *law, struct error *err) {
    struct surface_case *surface = &law->surface;
    size_t points = grid_points(&surface->grid);
    surface->translation = law->translation;
    surface->spectrum.translation = law->translation;
    int status = generator_create(&law->generator, &surface->spectrum, &surface->grid,
                                  &surface->options, err);
    if (status != 0)
        return status;
    modes_moments(generator_modes(law->generator), &law->moments);
    law->z = array_create(points, sizeof *law->z);
    return law->z != NULL ? 0 : error_memory(err, points * sizeof *law->z, "a surface");
}

int other_law_create(struct other_law **out, const struct surface_case *surface,
                     struct error *err) {
    struct other_law *law = array_create(1, sizeof *law);
    if (law == NULL)
        return error_memory(err, sizeof *law, "the other law of heights");
    law->surface = *surface;
    law->surface.options = options_of(surface);
    law->surface.translation = NULL;
    law->surface.spectrum.translation = NULL;
    bool translated = law->surface.options.law == LAW_TRANSLATION;
    int status = translated ? other_law_translate(&law->translation, &law->surface, err) : 0;
    if (status == 0 && (!translated || law->translation != NULL))
        status = make_generator(law, err);
    if (status != 0)
        other_law_destroy(&law);
    *out = law;
    return status;
}

void other_law_destroy(struct other_law **law) {
    struct other_law *gone = *law;
    if (gone == NULL)
        return;
    generator_destroy(&gone->generator);
    translation_destroy(&gone->translation);
    free(gone->z);
    free(gone->gaussian);
    free(gone);
    *law = NULL;
}

const struct surface_case *other_law_surface(const struct other_law *law) {
    return law->generator != NULL ? &law->surface : NULL;
}

const struct modes *other_law_modes(const struct other_law *law) {
    return generator_modes(law->generator);
}

int other_law_keep_gaussian(struct other_law *law, const double **gaussian, struct error *err) {
    size_t points = grid_points(&law->surface.grid);
    if (law->gaussian == NULL)
        law->gaussian = array_create(points, sizeof *law->gaussian);
    if (law->gaussian == NULL)
        return error_memory(err, points * sizeof *law->gaussian, "a Gaussian field");
    generator_keep_gaussian(law->generator, law->gaussian);
    *gaussian = law->gaussian;
    return 0;
}

const struct moments *other_law_moments(const struct other_law *law) {
    return &law->moments;
}

void other_law_set_stop(struct other_law *law, int (*stop)(void *context), void *context) {
    generator_set_stop(law->generator, stop, context);
}

int other_law_make(struct other_law *law, struct random_key key, const double **z,
                   struct surface_report *report, struct error *err) {
    *z = law->z;
    return generator_run(law->generator, key, law->z, report, err);
}

double other_law_bytes(const struct surface_case *surface) {
    struct surface_case other = *surface;
    other.options = options_of(surface);
    return surface_case_bytes(&other);
}

double other_law_seconds(const struct surface_case *surface) {
    const struct surface_options options = options_of(surface);
    double points = (double)grid_points(&surface->grid);
    return 1e-9 * cost_generation(&options, &surface->grid) * points * cost_caches(points);
}
