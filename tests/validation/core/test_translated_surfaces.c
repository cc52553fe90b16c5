/* Protects: surfaces of the law "translation" have the heights asked for, the spectrum asked for in
 * its band and the moments that are reported, on cells of few waves as on longer ones. */
#include "core/surface/spectrum.h"
#include "core/surface/surface.h"
#include "core/surface/transform.h"
#include "core/surface/translation/translation.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/seed.h"
#include <stdlib.h>
#include <string.h>

enum { SHARES = 5, RINGS = 4, MEASURES = SHARES + RINGS + 2 };
static const double SHARE[SHARES] = {0.01, 0.1, 0.5, 0.9, 0.99};

struct scene {
    struct spectrum spectrum;
    struct grid grid;
    struct heights heights;
    struct translation *law;
    struct generator *generator;
    struct transform *transform;
    double *z;
    double values[MEASURES], sums[MEASURES], squares[MEASURES];
};

static void scene_open(struct scene *s, int dimension, double ratio, double length,
                       enum heights_type type, double shape) {
    double side = ratio * length;
    size_t points = (size_t)(16 * side);
    struct surface_options options = SURFACE_DEFAULTS;
    *s = (struct scene){.heights = {.type = type, .shape = shape}};
    s->spectrum = (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                                    .hurst = 0.8,
                                    .wavelength_long = ratio,
                                    .wavelength_rolloff = ratio,
                                    .wavelength_short = 1};
    s->grid = (struct grid){points, dimension == 1 ? 1 : points, side, side};
    assert_int_equal(translation_create(&s->law, &s->spectrum, dimension, &s->heights, NULL), 0);
    s->spectrum.translation = s->law;
    options.heights = s->heights;
    options.law = LAW_TRANSLATION;
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&s->generator, &s->spectrum, &s->grid, &options, NULL), 0);
    assert_int_equal(
        transform_create(&s->transform, &s->grid, s->grid.nx / 2, s->grid.ny / 2, NULL), 0);
    s->z = malloc(grid_points(&s->grid) * sizeof *s->z);
    assert_non_null(s->z);
}

static void scene_close(struct scene *s) {
    generator_destroy(&s->generator);
    transform_destroy(&s->transform);
    translation_destroy(&s->law);
    free(s->z);
}

/* The ring of a wave number: quarters of log |k| in the band, and -1 outside. */
static int ring_of(const struct scene *s, double k) {
    double low = 2 * M_PI / s->spectrum.wavelength_long, high = 2 * M_PI;
    if (k < low * (1 - 1e-9) || k > high * (1 + 1e-9))
        return -1;
    int ring = (int)(RINGS * log(k / low) / log(high / low) + 1e-9);
    return ring < RINGS ? ring : RINGS - 1;
}

/* Adds up powers of a half spectrum by ring, and its m2 and m4. */
static void spectrum_add(const struct scene *s, const double complex *spectrum, bool squared,
                         double out[RINGS + 2]) {
    const struct grid *grid = &s->grid;
    memset(out, 0, (RINGS + 2) * sizeof *out);
    for (size_t mx = 0; mx <= grid->nx / 2; mx++)
        for (size_t row = 0; row < grid->ny; row++) {
            double complex mode = spectrum[mx * grid->ny + row];
            double power = squared ? creal(mode * conj(mode)) : creal(mode);
            double my = row <= grid->ny / 2 ? (double)row : (double)row - (double)grid->ny;
            double kx = 2 * M_PI * (double)mx / grid->lx, ky = 2 * M_PI * my / grid->ly;
            double k = hypot(kx, grid_is_profile(grid) ? 0 : ky), weight = modes_weight(grid, mx);
            int ring = ring_of(s, k);
            if (ring >= 0)
                out[ring] += weight * power;
            out[RINGS] += weight * power * kx * kx;
            out[RINGS + 1] += weight * power * pow(kx, 4);
        }
}

/* What is expected on this cell: the spectrum of the series of the autocorrelation of its field. */
static void expect(struct scene *s, double out[RINGS + 2]) {
    const struct modes *modes = generator_modes(s->generator);
    const struct hermite_powers *powers = height_function_powers(translation_function(s->law));
    double complex *spectrum = transform_spectrum(s->transform);
    size_t ny = s->grid.ny;
    memset(spectrum, 0, (s->grid.nx / 2 + 1) * ny * sizeof *spectrum);
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (long my = -(long)modes->mode_y; my <= (long)modes->mode_y; my++)
            spectrum[mx * ny + (my >= 0 ? (size_t)my : ny - (size_t)-my)] =
                modes_power(modes, mx, my);
    transform_inverse(s->transform, s->z);
    for (size_t i = 0; i < grid_points(&s->grid); i++)
        s->z[i] = hermite_correlation(powers, s->z[i]);
    transform_forward(s->transform, s->z);
    spectrum_add(s, transform_spectrum(s->transform), false, out);
}

static void measure(struct scene *s, struct random_key key) {
    struct height_moments moments;
    size_t points = grid_points(&s->grid);
    assert_int_equal(heights_moments(&s->heights, &moments, NULL), 0);
    assert_int_equal(generator_run(s->generator, key, s->z, NULL, NULL), 0);
    for (int a = 0; a < SHARES; a++) {
        double quantile = heights_quantile(&s->heights, &moments, SHARE[a]);
        size_t below = 0;
        for (size_t i = 0; i < points; i++)
            below += s->z[i] < quantile;
        s->values[a] = (double)below / (double)points;
    }
    transform_forward(s->transform, s->z);
    spectrum_add(s, transform_spectrum(s->transform), true, s->values + SHARES);
    for (int a = 0; a < MEASURES; a++) {
        s->sums[a] += s->values[a];
        s->squares[a] += s->values[a] * s->values[a];
    }
}

/* Within 4.5 standard errors of the mean over surfaces: eleven measures of each of six laws of
 * surfaces and four of profiles. */
static void check_means(const struct scene *s, size_t n, const double expected[MEASURES]) {
    for (int a = 0; a < MEASURES; a++) {
        double mean = s->sums[a] / (double)n;
        double variance = (s->squares[a] / (double)n - mean * mean) / (double)(n - 1);
        check_close(mean, expected[a], 4.5 * sqrt(fmax(variance, 0)));
    }
}

/* In the band the shape is the asked one, on this cell within what few waves make: 3 %. */
static void check_shape(const struct scene *s, const double *rings) {
    struct spectrum asked = s->spectrum;
    struct modes *modes = NULL;
    double power[RINGS] = {0}, inside = 1 - translation_fit(s->law)->outside;
    asked.translation = NULL;
    assert_int_equal(modes_create(&modes, &asked, &s->grid, NULL), 0);
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (long my = -(long)modes->mode_y; my <= (long)modes->mode_y; my++) {
            double kx = 2 * M_PI * (double)mx / s->grid.lx;
            double ky = 2 * M_PI * (double)my / s->grid.ly;
            double k = hypot(kx, grid_is_profile(&s->grid) ? 0 : ky);
            if (modes_power(modes, mx, my) > 0)
                power[ring_of(s, k)] += modes_weight(&s->grid, mx) * modes_power(modes, mx, my);
        }
    for (int ring = 0; ring < RINGS; ring++)
        check_relative(rings[ring], inside * power[ring], 0.03);
    modes_destroy(&modes);
}

static void check_law(int dimension, double ratio, double length, enum heights_type type,
                      double shape, size_t surfaces, uint64_t seed) {
    struct scene s;
    struct moments moments;
    double expected[MEASURES], *spectrum = expected + SHARES;
    size_t n = surfaces * effort();
    scene_open(&s, dimension, ratio, length, type, shape);
    modes_moments(generator_modes(s.generator), &moments);
    memcpy(expected, SHARE, sizeof SHARE);
    expect(&s, spectrum);
    check_shape(&s, spectrum);
    /* the grid of 16 points a wave holds nearly all of what z has */
    check_relative(spectrum[RINGS], moments.m20, 2e-3);
    check_relative(spectrum[RINGS + 1], moments.m40, 2e-2);
    for (size_t r = 0; r < n; r++)
        measure(&s, (struct random_key){seed, 0, r});
    check_means(&s, n, expected);
    scene_close(&s);
}

static void surfaces_follow_their_law(void **state) {
    (void)state;
    uint64_t seed = seed_or(2027);
    check_law(2, 4, 4, HEIGHTS_WEIBULL_MIN, 1, 60, seed);
    check_law(2, 4, 4, HEIGHTS_WEIBULL_MAX, 1, 60, seed);
    check_law(2, 4, 4, HEIGHTS_WEIBULL_MAX, 2, 60, seed + 1);
    check_law(2, 4, 4, HEIGHTS_LOGNORMAL, 0.7, 60, seed + 2);
    check_law(2, 4, 4, HEIGHTS_GAMMA, 3, 60, seed + 3);
    check_law(2, 4, 4, HEIGHTS_BETA, 2, 60, seed + 4);
}

static void profiles_follow_their_law(void **state) {
    (void)state;
    uint64_t seed = seed_or(2027);
    check_law(1, 8, 16, HEIGHTS_WEIBULL_MIN, 1, 2000, seed);
    check_law(1, 8, 16, HEIGHTS_WEIBULL_MAX, 1.5, 2000, seed + 1);
    check_law(1, 8, 16, HEIGHTS_GAMMA, 3, 2000, seed + 2);
    check_law(1, 8, 16, HEIGHTS_BETA, 2, 2000, seed + 3);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces_follow_their_law),
        cmocka_unit_test(profiles_follow_their_law),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
