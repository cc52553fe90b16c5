/* Protects: what an instrument leaves in a map is found, each by its own test and nothing else,
 * with about the slope that the map has without it; and of random surfaces (H from 0.3 to 0.9,
 * Gaussian and Weibull heights, with noise, lay and roll-off, cut from larger ones) none has any.
 * The counts of many more are in FORMULAS.md, F18.43. */
#include "core/map/artefacts/map_artefacts.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <gsl/gsl_cdf.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 128, CELL = 2 * SIDE, POINTS = SIDE * SIDE, LINE = 2048, KINDS = 4, LAYS = 4 };
static const struct grid GRID = {SIDE, SIDE, SIDE, SIDE};
static const struct grid PROFILE = {LINE, 1, LINE, LINE};

/* What differs between surfaces. */
struct recipe {
    double hurst, rolloff, short_wave, ratio, angle; /* lengths in points, angle in degrees */
    int kind; /* 0: Gaussian, 1: Weibull, 2: the same upside down, 3: with noise of 5 % */
};

static void make(const struct recipe *recipe, const struct grid *cell, uint64_t seed, double *z) {
    const struct spectrum law = {.type = SPECTRUM_SELF_AFFINE,
                                 .hurst = recipe->hurst,
                                 .wavelength_long = cell->lx,
                                 .wavelength_rolloff = recipe->rolloff,
                                 .wavelength_short = recipe->short_wave,
                                 .anisotropy = recipe->ratio,
                                 .lay_angle = recipe->angle * M_PI / 180,
                                 .scale = SCALE_RMS_HEIGHT,
                                 .scale_value = 1};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&generator, &law, cell, &options, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){seed, 0, 0}, z, NULL, NULL), 0);
    generator_destroy(&generator);
}

/* Fills a map of SIDE x SIDE points with the corner of a surface of twice the sides. */
static void make_map(const struct recipe *recipe, uint64_t seed, double *z) {
    static const double SHAPE = 1.5, NOISE = 0.05;
    static double cell[CELL * CELL], white[POINTS];
    const struct grid grid = {CELL, CELL, CELL, CELL};
    uint64_t noise_seed = seed + 1000;
    make(recipe, &grid, seed, cell);
    noise_fill(&noise_seed, POINTS, white);
    for (size_t n = 0; n < POINTS; n++) {
        double height = cell[n / SIDE * CELL + n % SIDE];
        if (recipe->kind == 1 || recipe->kind == 2)
            height = pow(-log(gsl_cdf_ugaussian_Q(height)), 1 / SHAPE);
        z[n] = recipe->kind == 2 ? -height : recipe->kind == 3 ? height + NOISE * white[n] : height;
    }
}

static struct recipe recipe_of(int n) {
    static const double HURST[] = {0.3, 0.6, 0.9}, SHORT[] = {2.5, 4, 8}, ANGLE[] = {0, 0, 20, 90};
    return (struct recipe){.hurst = HURST[n % 3],
                           .rolloff = n % 2 == 0 ? CELL : SIDE / 8.,
                           .short_wave = SHORT[(n + n / 3) % 3],
                           .ratio = n % LAYS == 0 ? 1 : 3,
                           .angle = ANGLE[n % LAYS],
                           .kind = n / 2 % KINDS};
}

static struct map_artefacts find(const struct grid *grid, const double *z) {
    struct map_artefacts found = {0};
    assert_int_equal(map_artefacts_find_stored(grid, z, &found, NULL), 0);
    assert_int_equal(map_artefacts_find_left(grid, z, &found, NULL), 0);
    return found;
}

static double slope_of(const struct grid *grid, const double *z) {
    struct map_differences differences;
    map_differences_measure(grid, z, &differences);
    const double first[2] = {differences.axis[0].first, differences.axis[1].first};
    return sqrt(differences_square(grid, first));
}

/* What is expected of a map: artefacts that are found, as bits. */
enum { STEPS = 1, SPIKES = 2, LINES = 4, COLUMNS = 8, ROWS = 16 };

static int bits_of(const struct map_artefacts *found) {
    return (map_steps_found(found) ? STEPS : 0) | (map_spikes_found(found) ? SPIKES : 0) |
           (found->lines.found ? LINES : 0) | (map_columns_found(found, 0) ? COLUMNS : 0) |
           (map_columns_found(found, 1) ? ROWS : 0);
}

static struct map_artefacts check_found(const struct grid *grid, const double *z, int expected,
                                        const char *what, int surface) {
    const struct map_artefacts found = find(grid, z);
    if (bits_of(&found) != expected)
        fail_msg("%s, surface %d: found %d, expected %d (steps %g, spikes %zu by %g, lines %g with "
                 "%g, columns %zu and %zu)",
                 what, surface, bits_of(&found), expected, found.steps.step, found.spikes.count,
                 found.spikes.largest, found.lines.p_value, found.lines.curvature,
                 found.columns[0].copies, found.columns[0].between);
    return found;
}

static void round_to(double *z, size_t points, double step) {
    for (size_t n = 0; n < points; n++)
        z[n] = step * round(z[n] / step);
}

/* Fills every second column, from `first` on, with the mean of its neighbours, or a copy. */
static void repeat_columns(double *z, size_t first, bool copies) {
    for (size_t n = 0; n < POINTS; n++) {
        const size_t i = n % SIDE;
        if (i % 2 == first % 2 && i >= first && i + 1 < SIDE)
            z[n] = copies ? z[n - 1] : (z[n - 1] + z[n + 1]) / 2;
    }
}

static void random_surfaces_have_none(void **state) {
    (void)state;
    enum { SURFACES = 24 };
    double *z = malloc(POINTS * sizeof *z);
    assert_non_null(z);
    for (int n = 0; n < SURFACES; n++) {
        const struct recipe recipe = recipe_of(n);
        make_map(&recipe, 100 + (uint64_t)n, z);
        const struct map_artefacts found = check_found(&GRID, z, 0, "clean", n);
        assert_true(found.steps.step == 0);
        assert_false(map_artefacts_count(&found));
        assert_false(map_artefacts_bend(&found, false));
    }
    free(z);
}

/* Steps of half the RMS height and of half of what neighbours differ by, which change the slope by
 * 2 %; also on a plane, whose heights are no multiples of anything. */
static void steps_are_found(void **state) {
    (void)state;
    enum { SURFACES = 4 };
    double *z = malloc(2 * POINTS * sizeof *z), *stepped = z + POINTS;
    assert_non_null(z);
    for (int n = 0; n < SURFACES; n++) {
        const struct recipe recipe = {.hurst = 0.8, .rolloff = 32, .short_wave = 4, .ratio = 1};
        make_map(&recipe, 200 + (uint64_t)n, z);
        const double slope = slope_of(&GRID, z);
        const double steps[] = {0.5, 0.2, 0.52 * slope / M_SQRT2};
        for (size_t s = 0; s < 3; s++) {
            memcpy(stepped, z, POINTS * sizeof *z);
            round_to(stepped, POINTS, steps[s]);
            for (size_t p = 0; p < POINTS; p++)
                stepped[p] = 1e-9 * (stepped[p] + 0.013 * (double)(p % SIDE));
            const struct map_artefacts found = check_found(&GRID, stepped, STEPS, "steps", n);
            check_relative(found.steps.step, 1e-9 * steps[s], 1e-6);
            check_relative(slope_of(&GRID, stepped) * found.steps.slope, 1e-9 * slope, 0.05);
            assert_true(map_artefacts_count(&found));
            assert_true(map_artefacts_bend(&found, false) && !map_artefacts_bend(&found, true));
        }
    }
    free(z);
}

/* Far below a step the differences are steps at each crossing of a level, E|d| q; far above they
 * gain q^2/6 (Bennett 1948). */
static void variance_without_steps_has_its_limits(void **state) {
    (void)state;
    const double step = 3, fine = 0.02, coarse = 20;
    check_relative(height_steps_variance(step * fine * sqrt(2 / M_PI), 0, step), fine * fine, 1e-3);
    check_relative(height_steps_variance(coarse * coarse + step * step / 6, 0, step),
                   coarse * coarse, 1e-9);
}

static void spikes_are_found(void **state) {
    (void)state;
    enum { PUT = 6 };
    double *z = malloc(POINTS * sizeof *z);
    assert_non_null(z);
    for (int n = 0; n < 4; n++) {
        const struct recipe recipe = {
            .hurst = 0.8, .rolloff = 32, .short_wave = 4, .ratio = 1, .kind = n};
        make_map(&recipe, 300 + (uint64_t)n, z);
        const double slope = slope_of(&GRID, z);
        for (size_t s = 0; s < PUT; s++)
            z[(s * 2711 + 305) % POINTS] += s % 2 == 0 ? 8 : -8;
        const struct map_artefacts found = check_found(&GRID, z, SPIKES, "spikes", n);
        assert_int_equal(found.spikes.count, PUT);
        assert_true(map_spikes_count(&found));
        check_relative(slope_of(&GRID, z) * found.spikes.slope, slope, 0.02);
    }
    free(z);
}

static void line_offsets_are_found(void **state) {
    (void)state;
    enum { SURFACES = 8 };
    double *z = malloc(2 * POINTS * sizeof *z), *other = z + POINTS, offsets[SIDE];
    assert_non_null(z);
    for (int n = 0; n < SURFACES; n++) {
        static const double ANGLE[] = {0, 45, 90, 135};
        const struct recipe recipe = {.hurst = 0.8,
                                      .rolloff = 32,
                                      .short_wave = 4,
                                      .ratio = n % 2 == 0 ? 1 : 3,
                                      .angle = ANGLE[n / 2],
                                      .kind = n % KINDS};
        uint64_t seed = 17 + (uint64_t)n;
        make_map(&recipe, 400 + (uint64_t)n, z);
        noise_fill(&seed, SIDE, offsets);
        const double slope = slope_of(&GRID, z);
        for (int along = SCAN_ALONG_X; along <= SCAN_ALONG_Y; along++) {
            for (size_t p = 0; p < POINTS; p++)
                other[p] = z[p] + 0.1 * offsets[along == SCAN_ALONG_X ? p / SIDE : p % SIDE];
            const struct map_artefacts found = check_found(&GRID, other, LINES, "lines", n);
            assert_int_equal(found.lines_along, along);
            check_relative(found.lines.rms, 0.1, 0.3); /* of 128 offsets, beside waves */
            check_relative(slope_of(&GRID, other) * found.lines.slope, slope, 0.1);
            assert_true(map_artefacts_bend(&found, true));
        }
    }
    free(z);
}

static void columns_are_found(void **state) {
    (void)state;
    double *z = malloc(2 * POINTS * sizeof *z), *other = z + POINTS;
    assert_non_null(z);
    for (int n = 0; n < 4; n++) {
        const struct recipe recipe = {.hurst = 0.8, .rolloff = 32, .short_wave = 4, .ratio = 1};
        struct map_artefacts found;
        make_map(&recipe, 500 + (uint64_t)n, z);
        for (size_t first = 1; first <= 2; first++) {
            memcpy(other, z, POINTS * sizeof *z);
            repeat_columns(other, first, n % 2 == 1);
            found = check_found(&GRID, other, COLUMNS, "columns", n);
            assert_true(found.columns[0].every_second && map_columns_count(&found, 0));
            assert_int_equal(found.columns[0].measured, n % 2 == 1 ? 1 - first % 2 : first - 1);
        }
        memcpy(other, z, POINTS * sizeof *z);
        repeat_columns(other, 1,
                       false); /* a fine step, as of 16 bits, to which means are rounded */
        round_to(other, POINTS, 2e-4);
        check_found(&GRID, other, COLUMNS, "rounded columns", n);
        memcpy(other, z, POINTS * sizeof *z);
        for (size_t i = 0; i < SIDE; i++) /* one row alone does not count */
            other[40 * SIDE + i] = (float)((z[39 * SIDE + i] + z[41 * SIDE + i]) / 2);
        found = check_found(&GRID, other, ROWS, "a row", n);
        assert_int_equal(found.columns[1].between, 1);
        assert_false(map_artefacts_count(&found));
    }
    free(z);
}

/* A profile that was drawn out, waves of four points, and flat maps hold none of it but steps. */
static void plain_shapes_have_no_lines(void **state) {
    (void)state;
    double *z = malloc(POINTS * sizeof *z);
    assert_non_null(z);
    for (int shape = 0; shape < 3; shape++) {
        for (size_t p = 0; p < POINTS; p++)
            z[p] = shape == 0 ? 1 : sin((shape == 1 ? 0.3 : M_PI / 2) * (double)(p % SIDE));
        const struct map_artefacts found = find(&GRID, z);
        assert_int_equal(bits_of(&found) & ~STEPS, 0);
    }
    free(z);
}

static void holes_are_left_out(void **state) {
    (void)state;
    const struct recipe recipe = {.hurst = 0.8, .rolloff = 32, .short_wave = 4, .ratio = 1};
    double *z = malloc(2 * POINTS * sizeof *z), *other = z + POINTS, offsets[SIDE];
    uint64_t seed = 3;
    assert_non_null(z);
    make_map(&recipe, 600, z);
    noise_fill(&seed, SIDE, offsets);
    for (size_t p = 0; p < POINTS; p++) { /* single ones, missing lines, a round one */
        const size_t i = p % SIDE, j = p / SIDE;
        const bool round_one = (i - 90) * (i - 90) + (j - 80) * (j - 80) < 25 * 25;
        z[p] = p % 7 == 0 || (j > 30 && j < 36) || round_one ? (double)NAN : z[p];
    }
    check_found(&GRID, z, 0, "holes", 0);
    for (size_t p = 0; p < POINTS; p++)
        other[p] = z[p] + 0.1 * offsets[p / SIDE];
    check_found(&GRID, other, LINES, "lines with holes", 0);
    memcpy(other, z, POINTS * sizeof *z);
    round_to(other, POINTS, 0.3);
    check_found(&GRID, other, STEPS, "steps with holes", 0);
    for (size_t p = 0; p < POINTS; p++)
        other[p] = (double)NAN;
    check_found(&GRID, other, 0, "holes alone", 0);
    free(z);
}

static void profiles_likewise(void **state) {
    (void)state;
    const struct grid cell = {2 * LINE, 1, 2 * LINE, 2 * LINE};
    const struct recipe recipe = {.hurst = 0.7, .rolloff = 128, .short_wave = 4, .ratio = 1};
    double *z = malloc(4 * LINE * sizeof *z), *other = z + 2 * LINE;
    assert_non_null(z);
    for (int n = 0; n < 4; n++) {
        make(&recipe, &cell, 700 + (uint64_t)n, z);
        check_found(&PROFILE, z, 0, "profile", n);
        memcpy(other, z, LINE * sizeof *z);
        round_to(other, LINE, 0.3);
        check_found(&PROFILE, other, STEPS, "profile in steps", n);
        memcpy(other, z, LINE * sizeof *z);
        other[700] += 8;
        check_found(&PROFILE, other, SPIKES, "profile with a spike", n);
        const size_t first = 1 + (size_t)n % 2;
        memcpy(other, z, LINE * sizeof *z);
        for (size_t i = first; i + 1 < LINE; i += 2)
            other[i] = n < 2 ? (z[i - 1] + z[i + 1]) / 2 : z[i - 1];
        const struct map_artefacts found =
            check_found(&PROFILE, other, COLUMNS, "profile with repeated points", n);
        assert_true(found.columns[0].every_second);
        assert_int_equal(found.columns[0].measured, first - 1);
    }
    free(z);
}

static void small_maps_are_no_fault(void **state) {
    (void)state;
    const double z[6] = {1, 2, 4, 3, 7, (double)NAN};
    static const struct grid GRIDS[] = {{2, 1, 2, 2}, {3, 2, 3, 2}, {2, 3, 2, 3}, {6, 1, 6, 6}};
    for (size_t g = 0; g < 4; g++)
        check_found(&GRIDS[g], z, 0, "small", (int)g);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_surfaces_have_none),
        cmocka_unit_test(steps_are_found),
        cmocka_unit_test(variance_without_steps_has_its_limits),
        cmocka_unit_test(spikes_are_found),
        cmocka_unit_test(line_offsets_are_found),
        cmocka_unit_test(columns_are_found),
        cmocka_unit_test(plain_shapes_have_no_lines),
        cmocka_unit_test(holes_are_left_out),
        cmocka_unit_test(profiles_likewise),
        cmocka_unit_test(small_maps_are_no_fault),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
