/* Protects: the theories of summits of translated surfaces, in both tails. Nine-point summits and
 * pits, and peaks and valleys of profiles, have the density, the heights and the mean curvatures
 * that the theory expects of the grid, and the surfaces the moments by differences. Refined ones
 * have those of the theory without a grid, and its curvatures, from few points a wave. */
#include "core/statistics/heights/roughness.h"
#include "core/statistics/summits/summits.h"
#include "core/surface/surface.h"
#include "core/surface/translation/translation.h"
#include "core/theory/sampled_field.h"
#include "core/theory/sampled_summits.h"
#include "core/theory/translated_summits.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/seed.h"
#include <stdlib.h>
#include <string.h>

/* Bins of heights over the whole range, to either bound, and of t1. */
enum {
    BINS = 24,
    EQUIVALENT = 2 * BINS,
    DENSITY = 3 * BINS,
    MEAN,
    SQUARE,
    CURVATURE,
    M2,
    M4,
    MEASURES
};
static const struct bins HEIGHT = {-6, 6, BINS}, T1 = {-18, 0, BINS};

struct law {
    int dimension;
    struct heights heights;
    enum summit_stencil stencil;
    bool pits;
};

struct scene {
    struct law law;
    struct spectrum spectrum;
    struct grid grid;
    struct translation *translation;
    struct generator *generator;
    struct summit_finder *finder;
    double *z, *gaussian;
    size_t surfaces;
    double *values; /* surfaces x MEASURES */
};

static void finder_open(struct scene *s, const struct modes *modes) {
    assert_int_equal(summit_finder_create(&s->finder, &s->grid, s->law.stencil,
                                          CURVATURE_FINITE_DIFFERENCE, modes->mode_x, modes->mode_y,
                                          NULL),
                     0);
    assert_int_equal(summit_finder_translate(s->finder, translation_function(s->translation),
                                             modes->height, NULL),
                     0);
    summit_finder_gaussian(s->finder, s->gaussian);
    generator_keep_gaussian(s->generator, s->gaussian);
}

/* Surfaces for refined summits have 4 points a shortest wave: z has waves that these do not
 * show. */
static void scene_open(struct scene *s, const struct law *law) {
    int dimension = law->dimension;
    double side = dimension == 1 ? 512 : 64;
    size_t points = (size_t)side * (law->stencil == SUMMITS_REFINED ? 4 : 8);
    struct surface_options options = SURFACE_DEFAULTS;
    *s = (struct scene){.law = *law,
                        .spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                     .hurst = 0.8,
                                     .wavelength_long = 8,
                                     .wavelength_rolloff = 8,
                                     .wavelength_short = 1},
                        .grid = {points, dimension == 1 ? 1 : points, side, side},
                        .surfaces = (dimension == 1 ? 400 : 60) * effort()};
    assert_int_equal(
        translation_create(&s->translation, &s->spectrum, dimension, &law->heights, NULL), 0);
    s->spectrum.translation = s->translation;
    options.heights = law->heights;
    options.law = LAW_TRANSLATION;
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&s->generator, &s->spectrum, &s->grid, &options, NULL), 0);
    s->z = malloc(grid_points(&s->grid) * sizeof *s->z);
    s->gaussian = malloc(grid_points(&s->grid) * sizeof *s->gaussian);
    s->values = calloc(s->surfaces * MEASURES, sizeof *s->values);
    assert_true(s->z != NULL && s->gaussian != NULL && s->values != NULL);
    finder_open(s, generator_modes(s->generator));
}

static void scene_close(struct scene *s) {
    summit_finder_destroy(&s->finder);
    generator_destroy(&s->generator);
    translation_destroy(&s->translation);
    free(s->z);
    free(s->gaussian);
    free(s->values);
}

/* Measures the summits or the pits of a surface: their numbers by height, sums of their curvatures
 * by height, numbers by t1, their number, sums of heights, of their squares and of curvatures; and
 * moments of the surface by differences. */
static void measure(struct scene *s, struct random_key key, const struct moments *moments,
                    double *out) {
    double third = s->law.dimension == 2 ? sqrt(3) : 1;
    struct summit_list list = {0};
    struct roughness roughness;
    assert_int_equal(generator_run(s->generator, key, s->z, NULL, NULL), 0);
    assert_int_equal((s->law.pits ? pits_find : summits_find)(s->finder, s->z, &list, NULL), 0);
    for (size_t a = 0; a < list.count; a++) {
        double z = list.summits[a].height / moments->rms_height;
        double curvature = list.summits[a].curvature / sqrt(moments->m4);
        size_t bin = bins_find(&HEIGHT, z), equivalent = bins_find(&T1, -third * curvature);
        if (bin >= 1 && bin <= BINS) {
            out[bin - 1]++;
            out[BINS + bin - 1] += curvature;
        }
        if (equivalent >= 1 && equivalent <= BINS)
            out[EQUIVALENT + equivalent - 1]++;
        out[CURVATURE] += curvature;
        out[MEAN] += z;
        out[SQUARE] += z * z;
    }
    out[DENSITY] = (double)list.count;
    roughness_measure(&s->grid, s->z, &roughness);
    out[M2] = roughness.m2;
    out[M4] = roughness.m4;
    summit_list_clear(&list);
}

/* Pairs of a maximum and a saddle too near for the search are missing among refined summits of
 * surfaces: 0.2 % of the density, with the mean curvature 0.13 % larger (refined.h). Returns how
 * much a measure may be off by them. Most are flat, and few summits are as flat: half of those
 * missing may belong to one bin of t1. */
static double missing_part(const struct law *law, int measure, double expected) {
    if (law->dimension == 1 || law->stencil != SUMMITS_REFINED)
        return 0;
    if (measure >= EQUIVALENT && measure < DENSITY)
        return 0.001;
    return (measure < EQUIVALENT ? 0.005 : 0.002) * fabs(expected);
}

/* Checks the sum of a measure over that of another one, or its mean over surfaces (NONE), within so
 * many of its standard errors, by linearisation. */
enum { NONE = -1 };
static double check_mean(const struct scene *s, int measure, int over, double expected,
                         double errors) {
    double sum = 0, number = 0, squares = 0, n = (double)s->surfaces;
    for (size_t r = 0; r < s->surfaces; r++) {
        sum += s->values[r * MEASURES + (size_t)measure];
        number += over == NONE ? 1 : s->values[r * MEASURES + (size_t)over];
    }
    double mean = sum / number;
    for (size_t r = 0; r < s->surfaces; r++) {
        const double *values = s->values + r * MEASURES;
        double rest = values[measure] - mean * (over == NONE ? 1 : values[over]);
        squares += rest * rest;
    }
    double error = sqrt(squares * n / (n - 1)) / number;
    check_close(mean, expected, errors * error + missing_part(&s->law, measure, expected));
    return fabs(mean - expected) / error;
}

/* What theory expects, by bins where it does. */
struct expected {
    double density, height_mean, height_variance, curvature;
    double pdf[BINS], cdf[BINS], by_height[BINS], t1_pdf[BINS];
};

static void expected_on_grid(const struct sampled_surface *surface, struct expected *out) {
    struct sampled_summits summits;
    const struct sampled_bins bins = {.height = &HEIGHT,
                                      .t1 = &HEIGHT,
                                      .pdf = out->pdf,
                                      .cdf = out->cdf,
                                      .curvature = out->by_height};
    assert_int_equal(sampled_summits(surface, &summits, &bins, NULL), 0);
    out->density = summits.density;
    out->height_mean = summits.height_mean;
    out->height_variance = summits.height_variance;
    out->curvature = summits.curvature;
}

static void expected_refined(const struct translated_surface *surface, struct expected *out) {
    const struct summit_expectation summits = translated_summits_expectation(surface);
    translated_summits_heights(surface, &HEIGHT, out->pdf, out->cdf, out->by_height);
    translated_summits_curvatures(surface, &T1, out->t1_pdf);
    out->density = summits.density;
    out->height_mean = summits.height_mean;
    out->height_variance = summits.height_variance;
    out->curvature = summits.curvature;
}

static void expected_fill(const struct scene *s, const struct translated_surface *translated,
                          struct expected *out) {
    const struct sampled_surface surface = {generator_modes(s->generator), &translated->gaussian,
                                            s->law.stencil, CURVATURE_FINITE_DIFFERENCE,
                                            translated};
    if (s->law.stencil == SUMMITS_REFINED)
        expected_refined(translated, out);
    else
        expected_on_grid(&surface, out);
}

/* Bins of less than a thousandth of the summits are left out, their errors being poorly known. In
 * a hundred bins some are three standard errors off. */
static const double SHARE_LEAST = 1e-3, ERRORS = 3, ERRORS_OF_BINS = 4;

static void check_bins(const struct scene *s, const struct expected *expected, double *worst,
                       double *bent) {
    double covered = 0;
    *worst = *bent = 0;
    for (int b = 0; b < BINS; b++) {
        double share = expected->pdf[b] * bins_width(&HEIGHT);
        if (share < SHARE_LEAST)
            continue;
        *worst = fmax(*worst, check_mean(s, b, DENSITY, share, ERRORS_OF_BINS));
        *bent = fmax(*bent, check_mean(s, BINS + b, b, expected->by_height[b], ERRORS_OF_BINS));
        covered += share;
    }
    assert_true(covered > 0.98);
    covered = 0;
    for (int b = 0; b < BINS && s->law.stencil == SUMMITS_REFINED; b++) {
        double share = expected->t1_pdf[b] * bins_width(&T1);
        if (share < SHARE_LEAST)
            continue;
        *bent = fmax(*bent, check_mean(s, EQUIVALENT + b, DENSITY, share, ERRORS_OF_BINS));
        covered += share;
    }
    assert_true(s->law.stencil != SUMMITS_REFINED || covered > 0.98);
}

static void check_law(const struct law *law, uint64_t seed) {
    struct scene s;
    struct expected expected;
    struct sampled_moments differences;
    double worst, bent;
    scene_open(&s, law);
    const struct modes *modes = generator_modes(s.generator);
    struct translated_surface translated = {
        .dimension = law->dimension, .heights = {translation_function(s.translation), law->pits}};
    modes_gaussian_moments(modes, &translated.gaussian);
    modes_moments(modes, &translated.reached);
    expected_fill(&s, &translated, &expected);
    sampled_moments(modes, &differences);
    for (size_t r = 0; r < s.surfaces; r++)
        measure(&s, (struct random_key){seed, 0, r}, &translated.reached, s.values + r * MEASURES);
    double cell = s.grid.lx * (law->dimension == 1 ? 1 : s.grid.ly);
    double density = check_mean(&s, DENSITY, NONE, expected.density * cell, ERRORS);
    double mean = check_mean(&s, MEAN, DENSITY, expected.height_mean, ERRORS);
    check_mean(&s, SQUARE, DENSITY,
               expected.height_variance + expected.height_mean * expected.height_mean, ERRORS);
    double curvature = check_mean(&s, CURVATURE, DENSITY, expected.curvature, ERRORS);
    check_mean(&s, M2, NONE, differences.m2, ERRORS);
    check_mean(&s, M4, NONE, differences.m4, ERRORS);
    check_bins(&s, &expected, &worst, &bent);
    print_message("%zu surfaces: density %.1f, mean height %.1f, curvature %.1f, worst bins %.1f "
                  "and, of curvature, %.1f standard errors\n",
                  s.surfaces, density, mean, curvature, worst, bent);
    scene_close(&s);
}

static void check_stencil(enum summit_stencil stencil) {
    static const struct law LAWS[] = {{2, {.type = HEIGHTS_WEIBULL_MAX, .shape = 1}, 0, false},
                                      {2, {.type = HEIGHTS_WEIBULL_MAX, .shape = 2}, 0, false},
                                      {1, {.type = HEIGHTS_WEIBULL_MAX, .shape = 1}, 0, false},
                                      {1, {.type = HEIGHTS_WEIBULL_MIN, .shape = 2}, 0, false}};
    uint64_t seed = seed_or(9116);
    for (size_t a = 0; a < sizeof LAWS / sizeof *LAWS; a++)
        for (int pits = 0; pits < 2; pits++) {
            struct law law = LAWS[a];
            law.stencil = stencil;
            law.pits = pits == 1;
            check_law(&law, seed + a);
        }
}

static void summits_of_the_grid_are_those_of_theory(void **state) {
    (void)state;
    check_stencil(SUMMITS_NINE_POINT);
}

static void refined_summits_are_those_of_theory(void **state) {
    (void)state;
    check_stencil(SUMMITS_REFINED);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(summits_of_the_grid_are_those_of_theory),
        cmocka_unit_test(refined_summits_are_those_of_theory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
