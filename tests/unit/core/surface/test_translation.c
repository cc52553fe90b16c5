/* Protects: the spectrum of the Gaussian field of a law of heights, moments of what is translated
 * from it, and that
 * spectra which have no such field are recognised. */
#include "core/surface/spectrum.h"
#include "core/surface/surface.h"
#include "core/surface/transform.h"
#include "core/surface/translation/radial.h"
#include "core/surface/translation/translation.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static struct spectrum self_affine(double hurst, double ratio) {
    return (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                             .hurst = hurst,
                             .wavelength_long = ratio,
                             .wavelength_rolloff = ratio,
                             .wavelength_short = 1};
}

static struct translation *law_of(const struct spectrum *spectrum, int dimension,
                                  enum heights_type type, double shape) {
    const struct heights heights = {.type = type, .shape = shape};
    struct translation *translation = NULL;
    assert_int_equal(translation_create(&translation, spectrum, dimension, &heights, NULL), 0);
    return translation;
}

/* A constant density of a disc has the autocorrelation 2 J1(kr)/(kr), one of a line sin(kr)/(kr).
 * The lattice is as coarse as the first node, here 1/50 of the last. */
static void transforms_of_constant_densities(void **state) {
    (void)state;
    enum { NODES = 101 };
    double k[NODES], density[NODES];
    for (int dimension = 1; dimension <= 2; dimension++) {
        struct radial *radial = NULL;
        double area = dimension == 1 ? 2 * 0.98 : M_PI * (1 - 0.02 * 0.02);
        for (int a = 0; a < NODES; a++) {
            k[a] = 0.02 * pow(50, a / 100.0);
            density[a] = 1 / area;
        }
        assert_int_equal(radial_create(&radial, dimension, NODES, k, NULL), 0);
        check_close(radial_integral(radial, density), 1, 1e-3);
        size_t lags = radial_lags(radial);
        double *correlation = malloc(lags * sizeof *correlation);
        assert_non_null(correlation);
        radial_correlate(radial, density, correlation);
        double spacing = 2 * M_PI / 8; /* an eighth of the shortest wave */
        for (size_t i = 1; i < 40; i++) {
            double r = (double)i * spacing;
            double expected = dimension == 1 ? (sin(r) - sin(0.02 * r)) / (0.98 * r)
                                             : 2 * (j1(r) - 0.02 * j1(0.02 * r)) / r;
            check_close(correlation[i], expected, 4e-3);
        }
        free(correlation);
        radial_destroy(&radial);
    }
}

/* Twice the transform is the same density, where lags are weighted down least: within a percent of
 * its largest value. */
static void densities_come_back(void **state) {
    (void)state;
    enum { NODES = 65 };
    double k[NODES], density[NODES], again[NODES];
    for (int dimension = 1; dimension <= 2; dimension++) {
        struct radial *radial = NULL;
        for (int a = 0; a < NODES; a++) {
            k[a] = 1 + 3.0 * a / (NODES - 1);
            density[a] = exp(-8 * (k[a] - 2.5) * (k[a] - 2.5));
        }
        assert_int_equal(radial_create(&radial, dimension, NODES, k, NULL), 0);
        double *correlation = malloc(radial_lags(radial) * sizeof *correlation);
        assert_non_null(correlation);
        radial_correlate(radial, density, correlation);
        radial_density(radial, correlation, again);
        for (int a = 0; a < NODES; a++)
            check_close(again[a], density[a], 1e-2);
        free(correlation);
        radial_destroy(&radial);
    }
}

/* The values of F5.11, found by fixed points on lattices of 256 x 256 to 1024 x 1024, which agree
 * within 0.002 in m2 and 0.006 in m4: those are of one cell, these of the endless field. */
static void moments_of_the_table(void **state) {
    (void)state;
    static const struct {
        double shape, hurst, ratio, outside, m2, m4;
    } ROWS[] = {{1, 0.8, 8, 0.0288, 1.0024, 1.105},
                {2, 0.8, 8, 0.0038, 1.0022, 1.0234},
                {3.602, 0.8, 8, 0.00012, 1.0006, 1.0039},
                {1, 0.2, 8, 0.025, 1.075, 1.311},
                {1, 0.8, 32, 0.0256, 0.980, 1.002}};
    for (size_t a = 0; a < sizeof ROWS / sizeof *ROWS; a++)
        for (int tail = HEIGHTS_WEIBULL_MIN; tail <= HEIGHTS_WEIBULL_MAX; tail++) {
            double ratio = ROWS[a].ratio;
            const struct grid grid = {(size_t)(32 * ratio), (size_t)(32 * ratio), 8 * ratio,
                                      8 * ratio};
            struct spectrum spectrum = self_affine(ROWS[a].hurst, ratio);
            struct moments asked, reached;
            assert_int_equal(spectrum_moments(&spectrum, &grid, &asked, NULL), 0);
            struct translation *law = law_of(&spectrum, 2, (enum heights_type)tail, ROWS[a].shape);
            const struct translation_fit *fit = translation_fit(law);
            check_close(fit->outside, ROWS[a].outside, 5e-4);
            check_close(fit->misfit, 0, 1e-8);
            spectrum.translation = law;
            assert_int_equal(spectrum_moments(&spectrum, &grid, &reached, NULL), 0);
            check_close(reached.m0, 1, 1e-12);
            check_close(reached.m2 / asked.m2, ROWS[a].m2, 4e-3);
            check_close(reached.m4 / asked.m4, ROWS[a].m4, 7e-3);
            translation_destroy(&law);
        }
}

/* Moments of a cell are sums over its modes, which tend to those of the endless field as 1/L. */
static void cells_tend_to_one_field(void **state) {
    (void)state;
    struct spectrum spectrum = self_affine(0.8, 8);
    struct translation *law = law_of(&spectrum, 1, HEIGHTS_WEIBULL_MAX, 1);
    double ratio[3];
    check_close(translation_fit(law)->outside, 0.0683, 3e-4);
    for (size_t a = 0; a < 3; a++) {
        double length = 64.0 * (double)(1 << (2 * a)); /* 8, 32 and 128 longest waves */
        const struct grid grid = {(size_t)(4 * length), 1, length, 1};
        struct moments asked, reached;
        spectrum.translation = NULL;
        assert_int_equal(spectrum_moments(&spectrum, &grid, &asked, NULL), 0);
        spectrum.translation = law;
        assert_int_equal(spectrum_moments(&spectrum, &grid, &reached, NULL), 0);
        ratio[a] = reached.m4 / asked.m4;
    }
    check_close(ratio[2], 1.136, 4e-3);
    assert_true(fabs(ratio[1] - ratio[2]) < 0.3 * fabs(ratio[0] - ratio[2]));
    translation_destroy(&law);
}

/* Scales are those of z: RMS slopes by its moments, on a grid by differences within their error. */
static void scale_is_that_of_the_heights(void **state) {
    (void)state;
    struct spectrum spectrum = self_affine(0.8, 4);
    struct translation *law = law_of(&spectrum, 2, HEIGHTS_WEIBULL_MIN, 1);
    const struct grid grid = {256, 256, 16, 16};
    struct moments moments;
    spectrum.translation = law;
    spectrum.scale = SCALE_RMS_SLOPE;
    spectrum.scale_value = 0.1;
    assert_int_equal(spectrum_moments(&spectrum, &grid, &moments, NULL), 0);
    check_relative(moments.rms_slope, 0.1, 1e-12);
    translation_destroy(&law);
}

/* Heights of the same realisation on a finer grid are the same where the grids share a point. */
static void finer_grid_is_the_same_surface(void **state) {
    (void)state;
    struct spectrum spectrum = self_affine(0.8, 4);
    struct translation *law = law_of(&spectrum, 2, HEIGHTS_WEIBULL_MAX, 1);
    struct surface_options options = SURFACE_DEFAULTS;
    spectrum.translation = law;
    options.heights = (struct heights){.type = HEIGHTS_WEIBULL_MAX, .shape = 1};
    options.law = LAW_TRANSLATION;
    options.amplitudes = AMPLITUDES_RANDOM;
    double *z[2];
    for (size_t a = 0; a < 2; a++) {
        const size_t side = (size_t)64 << a;
        const struct grid grid = {side, side, 16, 16};
        struct generator *generator = NULL;
        z[a] = malloc(grid_points(&grid) * sizeof *z[a]);
        assert_non_null(z[a]);
        assert_int_equal(generator_create(&generator, &spectrum, &grid, &options, NULL), 0);
        assert_int_equal(generator_run(generator, (struct random_key){1, 2, 3}, z[a], NULL, NULL),
                         0);
        generator_destroy(&generator);
    }
    for (size_t j = 0; j < 64; j++)
        for (size_t i = 0; i < 64; i++)
            check_close(z[1][2 * j * 128 + 2 * i], z[0][j * 64 + i], 1e-12);
    free(z[0]);
    free(z[1]);
    translation_destroy(&law);
}

/* A Gaussian-shaped density cannot be had with C = 1: its tail falls faster than what products of
 * the field have there. One that falls slowly can. */
static void misfits_are_found(void **state) {
    (void)state;
    enum { ROWS = 40 };
    double k[ROWS], steep[ROWS], slow[ROWS];
    struct spectrum spectrum = {
        .type = SPECTRUM_TABLE, .table_count = ROWS, .table_wave_number = k};
    for (int a = 0; a < ROWS; a++) {
        k[a] = 0.1 * (a + 1);
        steep[a] = exp(-2 * k[a] * k[a]);
        slow[a] = 1 / (1 + k[a] * k[a]);
    }
    spectrum.table_density = steep;
    struct translation *law = law_of(&spectrum, 2, HEIGHTS_WEIBULL_MAX, 1);
    const struct translation_fit *fit = translation_fit(law);
    assert_true(fit->misfit > 1e-3 && fit->misfit < 1);
    assert_true(fit->misfit_wave_number >= k[0] && fit->misfit_wave_number <= k[ROWS - 1]);
    translation_destroy(&law);
    spectrum.table_density = slow;
    law = law_of(&spectrum, 2, HEIGHTS_WEIBULL_MAX, 1);
    check_close(translation_fit(law)->misfit, 0, 1e-4);
    translation_destroy(&law);
}

/* Of an exponential autocorrelation each lag is converted: z has it at the points of the grid, but
 * for the share of the mean of a cell, 0.0023 of the field, which cells do not have. */
static void exponential_correlation_is_reached(void **state) {
    (void)state;
    struct spectrum spectrum = {
        .type = SPECTRUM_EXPONENTIAL_ACF, .correlation_x = 2, .correlation_y = 3};
    const struct grid grid = {256, 256, 128, 128};
    struct translation *law = law_of(&spectrum, 2, HEIGHTS_WEIBULL_MIN, 1);
    struct modes *modes = NULL;
    struct transform *transform = NULL;
    spectrum.translation = law;
    assert_int_equal(modes_create(&modes, &spectrum, &grid, NULL), 0);
    assert_int_equal(transform_create(&transform, &grid, 128, 128, NULL), 0);
    double complex *values = transform_spectrum(transform);
    double *correlation = malloc(grid_points(&grid) * sizeof *correlation);
    assert_non_null(correlation);
    memset(values, 0, 129 * 256 * sizeof *values);
    for (size_t mx = 0; mx <= 128; mx++)
        for (long my = -127; my <= 128; my++)
            values[mx * 256 + (size_t)((my + 256) % 256)] = modes_power(modes, mx, my);
    transform_inverse(transform, correlation);
    const struct hermite_powers *powers = height_function_powers(translation_function(law));
    for (size_t j = 0; j < 16; j++)
        for (size_t i = 0; i < 16; i++)
            check_close(hermite_correlation(powers, correlation[j * 256 + i]),
                        exponential_correlation(&spectrum, &grid, i, j), 0.005);
    free(correlation);
    transform_destroy(&transform);
    modes_destroy(&modes);
    translation_destroy(&law);
}

static void waves_too_far_apart_are_refused(void **state) {
    (void)state;
    const struct heights heights = {.type = HEIGHTS_WEIBULL_MAX, .shape = 1};
    struct translation *law = NULL;
    struct error err = {0};
    struct spectrum spectrum = self_affine(0.8, 2000);
    assert_int_equal(translation_create(&law, &spectrum, 2, &heights, &err), ERROR_INPUT);
    assert_null(law);
    assert_non_null(strstr(err.text, "2000 times"));
}

/* A plateau from waves of 16 to those of 4096 has 0.0072 of the variance of profiles, 1.0e-4 of
 * that of surfaces, at waves above 1024. The law is that of the shorter plateau. */
static void long_plateaus_hold_nothing(void **state) {
    (void)state;
    for (int dimension = 1; dimension <= 2; dimension++) {
        struct spectrum spectrum = self_affine(0.8, 16);
        spectrum.wavelength_long = RADIAL_RATIO_MOST;
        struct translation *shorter = law_of(&spectrum, dimension, HEIGHTS_WEIBULL_MIN, 1.5);
        spectrum.wavelength_long = 4 * RADIAL_RATIO_MOST;
        struct translation *law = law_of(&spectrum, dimension, HEIGHTS_WEIBULL_MIN, 1.5);
        double least = translation_factor(law, 2 * M_PI / RADIAL_RATIO_MOST);
        for (double wave = 1; wave <= RADIAL_RATIO_MOST; wave *= 1.5)
            check_close(translation_factor(law, 2 * M_PI / wave),
                        translation_factor(shorter, 2 * M_PI / wave), 1e-3 * least);
        check_close(translation_factor(law, M_PI / RADIAL_RATIO_MOST), least, 1e-12 * least);
        check_close(translation_fit(law)->outside, translation_fit(shorter)->outside, 1e-5);
        double first = pow(16.0 / RADIAL_RATIO_MOST, dimension), twice = 2 * spectrum.hurst;
        double tail = dimension * (1 - pow(16, -twice)) / twice; /* over that of a whole plateau */
        double share = first * (1 - pow(4, -dimension)) / (1 + tail);
        check_close(translation_fit(law)->misfit - translation_fit(shorter)->misfit, share,
                    0.01 * share);
        translation_destroy(&law);
        translation_destroy(&shorter);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transforms_of_constant_densities),
        cmocka_unit_test(densities_come_back),
        cmocka_unit_test(moments_of_the_table),
        cmocka_unit_test(cells_tend_to_one_field),
        cmocka_unit_test(scale_is_that_of_the_heights),
        cmocka_unit_test(finer_grid_is_the_same_surface),
        cmocka_unit_test(misfits_are_found),
        cmocka_unit_test(waves_too_far_apart_are_refused),
        cmocka_unit_test(long_plateaus_hold_nothing),
        cmocka_unit_test(exponential_correlation_is_reached),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
