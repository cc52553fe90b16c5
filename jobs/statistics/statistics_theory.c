#include "jobs/statistics/statistics_theory.h"
#include "core/theory/bin_averages.h"

const char STATISTICS_TRANSLATION[] = "translation", STATISTICS_REST[] = "random_part";

/* Heights of the random part at each height of the profile, all equally frequent: of two families
 * at each pair of heights, since these are independent; NaN where they are not. */
static int grooved_heights(const struct statistics_case *one_case, double *pdf, double *cdf,
                           struct error *err) {
    enum { POINTS = 128 };
    const struct surface_case *surface = &one_case->surface;
    const struct grooves *grooves = surface->grooves;
    const struct bins *bins = &one_case->height;
    const size_t others = grooves->families > 1 ? POINTS : 1;
    double height[2][POINTS] = {{0}}; /* of each family */
    struct height_moments moments;
    int status = heights_moments(&surface->options.heights, &moments, err);
    if (status != 0)
        return status;
    if (!grooves_independent(grooves)) {
        for (size_t b = 0; b < bins->count; b++)
            pdf[b] = cdf[b] = NAN;
        return 0;
    }
    for (size_t f = 0; f < grooves->families; f++)
        for (size_t a = 0; a < POINTS; a++)
            height[f][a] =
                grooves->family[f].depth *
                groove_profile_height(&grooves->family[f].profile, ((double)a + 0.5) / POINTS);
    double before = 0;
    for (size_t b = 0; b <= bins->count; b++) {
        const double edge = bins->low + (double)b * bins_width(bins);
        double below = 0;
        for (size_t a = 0; a < POINTS; a++)
            for (size_t c = 0; c < others; c++)
                below += heights_cdf(&surface->options.heights, &moments,
                                     edge - height[0][a] - height[1][c]);
        below /= (double)(POINTS * others);
        if (b > 0) {
            cdf[b - 1] = below;
            pdf[b - 1] = (below - before) / bins_width(bins);
        }
        before = below;
    }
    return 0;
}

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
    const struct surface_case *surface = &one_case->surface;
    if (surface->plateau != NULL) {
        stratified_averages(one_case, pdf, cdf);
        return 0;
    }
    return surface->grooves == NULL
               ? bin_averages_heights(&surface->options.heights, &one_case->height, pdf, cdf, err)
               : grooved_heights(one_case, pdf, cdf, err);
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
    if (surface->grooves != NULL && surface->options.heights.type != HEIGHTS_GAUSSIAN)
        return 0;
    if (gaussian)
        add(out, (struct summit_theory){
                     .name = surface->grooves != NULL ? STATISTICS_REST
                             : surfaces               ? "nayak"
                                                      : "longuet_higgins",
                     .surface = {.dimension = surface->dimension, .reached = basis->moments}});
    if (surface->grooves != NULL || (!gaussian && !surface_case_translated(surface)))
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

const struct summit_theory *summit_theories_own(const struct summit_theories *theories,
                                                const struct statistics_case *one_case) {
    for (size_t t = 0; t < theories->count; t++)
        if (theories->of[t].translated || statistics_case_symmetric(one_case))
            return &theories->of[t];
    return NULL;
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
