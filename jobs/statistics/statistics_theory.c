#include "jobs/statistics/statistics_theory.h"
#include "core/theory/bin_averages.h"

const char STATISTICS_TRANSLATION[] = "translation";

static void stratified_averages(const struct statistics_case *one_case, double *pdf, double *cdf) {
    const struct stratified_heights heights = surface_case_stratified(&one_case->surface);
    const struct bins *bins = &one_case->height;
    double before = stratified_cdf(&heights, bins->low);
    for (size_t b = 0; b < bins->count; b++) {
        cdf[b] = stratified_cdf(&heights, bins->low + (double)(b + 1) * bins_width(bins));
        pdf[b] = (cdf[b] - before) / bins_width(bins);
        before = cdf[b];
    }
}

int statistics_theory_heights(const struct statistics_case *one_case, double *pdf, double *cdf,
                              struct error *err) {
    if (one_case->surface.plateau != NULL) {
        stratified_averages(one_case, pdf, cdf);
        return 0;
    }
    return bin_averages_heights(&one_case->surface.options.heights, &one_case->height, pdf, cdf,
                                err);
}

/* --- the theories of a case --- */

static void add(struct summit_theories *out, struct summit_theory theory) {
    out->of[out->count++] = theory;
}

int summit_theories_create(struct summit_theories *out, const struct statistics_case *one_case,
                           const struct surface_basis *basis, struct error *err) {
    const struct surface_case *surface = &one_case->surface;
    bool surfaces = surface->dimension == 2;
    bool gaussian =
        !surface_case_translated(surface) && translated_case_applies(surface, &basis->moments);
    *out = (struct summit_theories){0};
    if (surface->plateau != NULL)
        return 0; /* a stratified face has kinks, where curvature is not defined */
    if (gaussian)
        add(out, (struct summit_theory){
                     .name = surfaces ? "nayak" : "longuet_higgins",
                     .surface = {.dimension = surface->dimension, .reached = basis->moments}});
    if (!gaussian && !surface_case_translated(surface))
        return 0;
    int status = translated_case_create(&out->translated, surface, basis->modes, err);
    if (status == 0 && out->translated.exists)
        add(out, (struct summit_theory){.name = STATISTICS_TRANSLATION,
                                        .translated = true,
                                        .surface = out->translated.surface});
    return status;
}

void summit_theories_clear(struct summit_theories *theories) {
    translated_case_clear(&theories->translated);
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
