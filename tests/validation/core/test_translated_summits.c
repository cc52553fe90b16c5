/* Protects: the theory of summits of translated surfaces on a grid. Nine-point summits and pits,
 * and peaks and valleys of profiles, have the density, the heights and the mean curvatures that the
 * theory expects of the grid, in both tails, and the surfaces the moments by differences. */
#include "core/statistics/heights/roughness.h"
#include "core/statistics/summits/summits.h"
#include "core/surface/surface.h"
#include "core/surface/translation/translation.h"
#include "core/theory/sampled_field.h"
#include "core/theory/sampled_summits.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/seed.h"
#include <stdlib.h>
#include <string.h>

/* Bins of heights over the whole range, to either bound. */
enum { BINS = 24, DENSITY = 2 * BINS, MEAN, SQUARE, CURVATURE, M2, M4, MEASURES };
static const struct bins HEIGHT = {-6, 6, BINS};

struct scene {
    struct spectrum spectrum;
    struct grid grid;
    struct translation *law;
    struct generator *generator;
    struct summit_finder *finder;
    double *z;
    size_t surfaces;
    double *values; /* surfaces x MEASURES */
};

static void scene_open(struct scene *s, int dimension, const struct heights *heights) {
    double side = dimension == 1 ? 512 : 64;
    size_t points = (size_t)(8 * side);
    struct surface_options options = SURFACE_DEFAULTS;
    *s = (struct scene){.spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                     .hurst = 0.8,
                                     .wavelength_long = 8,
                                     .wavelength_rolloff = 8,
                                     .wavelength_short = 1},
                        .grid = {points, dimension == 1 ? 1 : points, side, side},
                        .surfaces = (dimension == 1 ? 400 : 60) * effort()};
    assert_int_equal(translation_create(&s->law, &s->spectrum, dimension, heights, NULL), 0);
    s->spectrum.translation = s->law;
    options.heights = *heights;
    options.law = LAW_TRANSLATION;
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&s->generator, &s->spectrum, &s->grid, &options, NULL), 0);
    assert_int_equal(summit_finder_create(&s->finder, &s->grid, SUMMITS_NINE_POINT,
                                          CURVATURE_FINITE_DIFFERENCE, s->grid.nx / 2,
                                          s->grid.ny / 2, NULL),
                     0);
    s->z = malloc(grid_points(&s->grid) * sizeof *s->z);
    s->values = calloc(s->surfaces * MEASURES, sizeof *s->values);
    assert_true(s->z != NULL && s->values != NULL);
}

static void scene_close(struct scene *s) {
    summit_finder_destroy(&s->finder);
    generator_destroy(&s->generator);
    translation_destroy(&s->law);
    free(s->z);
    free(s->values);
}

/* Measures the summits of a surface, or of its mirror image: their numbers by height, sums of their
 * curvatures by height, their number, sums of heights, of their squares and of curvatures; and its
 * moments by differences. */
static void measure(struct scene *s, struct random_key key, bool mirrored,
                    const struct moments *moments, double *out) {
    struct summit_list list = {0};
    struct roughness roughness;
    assert_int_equal(generator_run(s->generator, key, s->z, NULL, NULL), 0);
    for (size_t i = 0; i < grid_points(&s->grid) && mirrored; i++)
        s->z[i] = -s->z[i];
    assert_int_equal(summits_find(s->finder, s->z, &list, NULL), 0);
    for (size_t a = 0; a < list.count; a++) {
        double z = list.summits[a].height / moments->rms_height;
        double curvature = list.summits[a].curvature / sqrt(moments->m4);
        size_t bin = bins_find(&HEIGHT, z);
        if (bin >= 1 && bin <= BINS) {
            out[bin - 1]++;
            out[BINS + bin - 1] += curvature;
        }
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

/* Checks the sum of a measure over that of another one, or its mean over surfaces (NONE), within
 * four of its standard errors, by linearisation. */
enum { NONE = -1 };
static double check_mean(const struct scene *s, int measure, int over, double expected) {
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
    check_close(mean, expected, 4 * error);
    return fabs(mean - expected) / error;
}

/* Bins of less than a thousandth of the summits are left out, their errors being poorly known. */
static const double SHARE_LEAST = 1e-3;

static void check_law(int dimension, enum heights_type type, double shape, bool mirrored,
                      uint64_t seed) {
    struct scene s;
    const struct heights heights = {.type = type, .shape = shape};
    double pdf[BINS], cdf[BINS], curvature[BINS], worst = 0, bent = 0, covered = 0;
    struct sampled_summits expected;
    struct sampled_moments differences;
    scene_open(&s, dimension, &heights);
    const struct modes *modes = generator_modes(s.generator);
    struct translated_surface translated = {.dimension = dimension,
                                            .heights = {translation_function(s.law), mirrored}};
    modes_gaussian_moments(modes, &translated.gaussian);
    modes_moments(modes, &translated.reached);
    const struct sampled_surface surface = {modes, &translated.gaussian, SUMMITS_NINE_POINT,
                                            CURVATURE_FINITE_DIFFERENCE, &translated};
    const struct sampled_bins bins = {
        .height = &HEIGHT, .t1 = &HEIGHT, .pdf = pdf, .cdf = cdf, .curvature = curvature};
    assert_int_equal(sampled_summits(&surface, &expected, &bins, NULL), 0);
    sampled_moments(modes, &differences);
    for (size_t r = 0; r < s.surfaces; r++)
        measure(&s, (struct random_key){seed, 0, r}, mirrored, &translated.reached,
                s.values + r * MEASURES);
    double cell = s.grid.lx * (dimension == 1 ? 1 : s.grid.ly);
    double density = check_mean(&s, DENSITY, NONE, expected.density * cell);
    double mean = check_mean(&s, MEAN, DENSITY, expected.height_mean);
    check_mean(&s, SQUARE, DENSITY,
               expected.height_variance + expected.height_mean * expected.height_mean);
    check_mean(&s, CURVATURE, DENSITY, expected.curvature);
    check_mean(&s, M2, NONE, differences.m2);
    check_mean(&s, M4, NONE, differences.m4);
    for (int b = 0; b < BINS; b++) {
        double share = pdf[b] * bins_width(&HEIGHT);
        if (share < SHARE_LEAST)
            continue;
        worst = fmax(worst, check_mean(&s, b, DENSITY, share));
        bent = fmax(bent, check_mean(&s, BINS + b, b, curvature[b]));
        covered += share;
    }
    print_message("%zu surfaces: density %.1f, mean height %.1f, worst bins %.1f and, of "
                  "curvature, %.1f standard errors\n",
                  s.surfaces, density, mean, worst, bent);
    assert_true(covered > 0.98);
    scene_close(&s);
}

static void surfaces_have_the_summits_of_theory(void **state) {
    (void)state;
    uint64_t seed = seed_or(9116);
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        check_law(2, HEIGHTS_WEIBULL_MAX, 1, mirrored == 1, seed);
        check_law(2, HEIGHTS_WEIBULL_MAX, 2, mirrored == 1, seed + 1);
    }
}

static void profiles_have_the_peaks_of_theory(void **state) {
    (void)state;
    uint64_t seed = seed_or(9116);
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        check_law(1, HEIGHTS_WEIBULL_MAX, 1, mirrored == 1, seed + 2);
        check_law(1, HEIGHTS_WEIBULL_MIN, 2, mirrored == 1, seed + 3);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces_have_the_summits_of_theory),
        cmocka_unit_test(profiles_have_the_peaks_of_theory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
