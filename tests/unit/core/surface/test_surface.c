/* Protects: a generated surface has exactly the spectrum asked for, and is the same surface on
 * every grid, in every process, for one seed, sequence and realisation. */
#include "core/surface/surface.h"
#include "core/surface/transform.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static struct spectrum self_affine(double ratio) {
    return (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                             .hurst = 0.8,
                             .wavelength_long = ratio,
                             .wavelength_rolloff = ratio,
                             .wavelength_short = 1};
}

static double *generate(const struct spectrum *spectrum, const struct grid *grid,
                        struct random_key key, struct generator **generator) {
    double *z = malloc(grid_points(grid) * sizeof *z);
    assert_non_null(z);
    assert_int_equal(generator_create(generator, spectrum, grid, &SURFACE_DEFAULTS, NULL), 0);
    assert_int_equal(generator_run(*generator, key, z, NULL, NULL), 0);
    return z;
}

/* Every mode, those on the Nyquist lines too (2 points a shortest wave), has its power: to
 * rounding. */
static void spectrum_is_exact(void **state) {
    (void)state;
    static const struct {
        struct grid grid;
        double ratio;
    } CASES[] = {{{128, 128, 16, 16}, 2}, {{32, 32, 16, 16}, 2}, {{33, 35, 16, 16}, 2},
                 {{256, 64, 32, 8}, 4},   {{512, 1, 64, 1}, 8},  {{37, 37, 4, 4}, 1}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        const struct grid *grid = &CASES[c].grid;
        struct spectrum spectrum = self_affine(CASES[c].ratio);
        struct generator *generator = NULL;
        struct transform *transform = NULL;
        double *z = generate(&spectrum, grid, (struct random_key){1, c, 5}, &generator);
        const struct modes *modes = generator_modes(generator);
        assert_int_equal(transform_create(&transform, grid, modes->mode_x, modes->mode_y, NULL), 0);
        transform_forward(transform, z);
        for (size_t mx = 0; mx <= modes->mode_x; mx++)
            for (long my = -(long)modes->mode_y; my <= (long)modes->mode_y; my++) {
                size_t row = my >= 0 ? (size_t)my : grid->ny - (size_t)-my;
                if (my < 0 && 2 * (size_t)-my == grid->ny)
                    continue; /* the same mode as +ny/2 */
                double complex mode = transform_spectrum(transform)[mx * grid->ny + row];
                double power = creal(mode) * creal(mode) + cimag(mode) * cimag(mode);
                check_close(power, modes_power(modes, mx, my),
                            1e-15 + 1e-12 * modes_power(modes, mx, my));
            }
        transform_destroy(&transform);
        generator_destroy(&generator);
        free(z);
    }
}

static void finer_grid_is_the_same_surface(void **state) {
    (void)state;
    const struct grid coarse = {64, 64, 16, 16}, fine = {150, 97, 16, 16};
    struct spectrum spectrum = self_affine(2);
    struct random_key key = {20211, 3, 17};
    struct generator *a = NULL, *b = NULL;
    double *z = generate(&spectrum, &coarse, key, &a), *dense = generate(&spectrum, &fine, key, &b);
    double *sampled = malloc(grid_points(&fine) * sizeof *sampled);
    assert_non_null(sampled);
    assert_int_equal(surface_resample(&coarse, z, &fine, sampled, 16, 16, NULL), 0);
    for (size_t p = 0; p < grid_points(&fine); p++)
        check_close(sampled[p], dense[p], 1e-12);
    generator_destroy(&a);
    generator_destroy(&b);
    free(z);
    free(dense);
    free(sampled);
}

/* The surface's mode (mx, my) by its phase alone. */
static double complex phase_of(struct transform *transform, const struct grid *grid, size_t mx,
                               long my) {
    size_t row = my >= 0 ? (size_t)my : grid->ny - (size_t)-my;
    double complex mode = transform_spectrum(transform)[mx * grid->ny + row];
    return mode / cabs(mode);
}

/* Draws the surface of key {7, 0, 4} and leaves its spectrum in *transform. */
static void draw_spectrum(const struct spectrum *spectrum, const struct grid *grid,
                          struct generator **generator, struct transform **transform) {
    double *z = generate(spectrum, grid, (struct random_key){7, 0, 4}, generator);
    const struct modes *modes = generator_modes(*generator);
    assert_int_equal(transform_create(transform, grid, modes->mode_x, modes->mode_y, NULL), 0);
    transform_forward(*transform, z);
    free(z);
}

/* What lets cases of a study be compared realisation by realisation: a wave that two of them have,
 * counted by its wave number in units of 2 pi/L, has one phase, to rounding. The first spectrum has
 * waves of numbers 4 to 16 on a cell of 4 long waves. */
static void a_wave_keeps_its_phase_in_other_spectra(void **state) {
    (void)state;
    struct spectrum rough = self_affine(4), steep = self_affine(4), fine = self_affine(8);
    struct spectrum rolled = self_affine(4);
    rough.hurst = 0.2;
    steep.scale = SCALE_RMS_SLOPE;
    steep.scale_value = 3;
    rolled.wavelength_rolloff = 2;
    const struct {
        const struct spectrum *spectrum;
        double length;
    } others[] = {{&rough, 16}, {&steep, 16}, {&rolled, 16}, {&fine, 32}};
    const struct spectrum first = self_affine(4);
    for (int dimension = 1; dimension <= 2; dimension++)
        for (size_t n = 0; n < sizeof others / sizeof *others; n++) {
            double length = others[n].length;
            struct grid grid = {64, 48, 16, 16}, other = {128, 150, length, length};
            struct generator *a = NULL, *b = NULL;
            struct transform *one = NULL, *two = NULL;
            size_t common = 0;
            if (dimension == 1)
                grid.ny = other.ny = 1;
            draw_spectrum(&first, &grid, &a, &one);
            draw_spectrum(others[n].spectrum, &other, &b, &two);
            const struct modes *modes = generator_modes(a);
            for (size_t mx = 0; mx <= modes->mode_x; mx++)
                for (long my = -(long)modes->mode_y; my <= (long)modes->mode_y; my++) {
                    if (modes_power(modes, mx, my) == 0)
                        continue;
                    assert_true(modes_power(generator_modes(b), mx, my) > 0);
                    double complex gap =
                        phase_of(one, &grid, mx, my) - phase_of(two, &other, mx, my);
                    check_close(cabs(gap), 0, 1e-9);
                    common++;
                }
            assert_true(common == (dimension == 1 ? 13 : common) && common >= 13);
            transform_destroy(&one);
            transform_destroy(&two);
            generator_destroy(&a);
            generator_destroy(&b);
        }
}

static void realisation_depends_on_its_key_alone(void **state) {
    (void)state;
    const struct grid grid = {48, 40, 8, 8};
    struct spectrum spectrum = self_affine(1.5);
    static const struct random_key KEYS[] = {{1, 2, 3}, {2, 2, 3}, {1, 3, 3}, {1, 2, 4}};
    struct generator *first = NULL, *used = NULL;
    double *z = generate(&spectrum, &grid, KEYS[0], &first);
    double *other = generate(&spectrum, &grid, KEYS[3], &used);
    assert_memory_not_equal(z, other, grid_points(&grid) * sizeof *z);
    for (size_t k = 1; k < 4; k++) {
        assert_int_equal(generator_run(used, KEYS[k], other, NULL, NULL), 0);
        assert_memory_not_equal(z, other, grid_points(&grid) * sizeof *z);
    }
    assert_int_equal(generator_run(used, KEYS[0], other, NULL, NULL),
                     0); /* a generator keeps no trace */
    assert_memory_equal(z, other, grid_points(&grid) * sizeof *z);
    generator_destroy(&first);
    generator_destroy(&used);
    free(z);
    free(other);
}

static void one_mode_is_one_wave(void **state) {
    (void)state;
    const struct grid grid = {32, 1, 1, 1};
    struct spectrum spectrum = self_affine(1);
    struct generator *generator = NULL;
    double *z = generate(&spectrum, &grid, (struct random_key){1, 0, 0}, &generator), square = 0;
    for (size_t i = 0; i < 32; i++) {
        square += z[i] * z[i] / 32;
        check_close(z[(i + 16) % 32], -z[i], 1e-14);
    }
    check_close(square, 1, 1e-14);
    generator_destroy(&generator);
    free(z);
}

/* --- random amplitudes --- */

static void draw_random(const struct spectrum *spectrum, const struct grid *grid,
                        struct generator **generator) {
    struct surface_options options = SURFACE_DEFAULTS;
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(generator, spectrum, grid, &options, NULL), 0);
}

/* Of every wave the power is exponential about the prescribed one (complex modes: mean square 2),
 * and of one that is its own conjugate that of a normal number (mean square 3); over all waves of
 * 400 surfaces, within four standard errors: of the mean 1/sqrt(n), of the square sqrt(20/n), and
 * of real ones sqrt(2/n) and sqrt(96/n). A grid of two points a shortest wave has real modes. */
static void random_powers_are_those_of_normal_modes(void **state) {
    (void)state;
    enum { SURFACES = 400 };
    const struct grid grid = {16, 16, 8, 8};
    struct spectrum spectrum = self_affine(8);
    struct generator *generator = NULL;
    struct transform *transform = NULL;
    double sum[2] = {0}, square[2] = {0}, count[2] = {0}, z[256];
    draw_random(&spectrum, &grid, &generator);
    const struct modes *modes = generator_modes(generator);
    assert_int_equal(transform_create(&transform, &grid, modes->mode_x, modes->mode_y, NULL), 0);
    for (uint64_t r = 0; r < SURFACES; r++) {
        assert_int_equal(generator_run(generator, (struct random_key){5, 0, r}, z, NULL, NULL), 0);
        transform_forward(transform, z);
        for (size_t mx = 0; mx <= modes->mode_x; mx++)
            for (size_t my = 0; my <= modes->mode_y; my++) {
                double power = modes_power(modes, mx, (long)my);
                if (!(power > 0))
                    continue;
                double complex mode = transform_spectrum(transform)[mx * grid.ny + my];
                double share = (creal(mode) * creal(mode) + cimag(mode) * cimag(mode)) / power;
                bool real = (mx == 0 || mx == 8) && (my == 0 || my == 8);
                sum[real] += share;
                square[real] += share * share;
                count[real]++;
            }
    }
    assert_true(count[0] > 10 * SURFACES && count[1] >= 2 * SURFACES);
    for (int real = 0; real < 2; real++) {
        double n = count[real];
        check_close(sum[real] / n, 1, 4 * sqrt((real ? 2 : 1) / n));
        check_close(square[real] / n, real ? 3 : 2, 4 * sqrt((real ? 96 : 20) / n));
    }
    transform_destroy(&transform);
    generator_destroy(&generator);
}

/* On every grid, and in every spectrum of the cell over its own amplitude. */
static void a_wave_keeps_its_random_amplitude(void **state) {
    (void)state;
    const struct grid coarse = {64, 64, 16, 16}, fine = {150, 97, 16, 16};
    const struct random_key key = {20211, 3, 17};
    struct spectrum spectrum = self_affine(4), rough = self_affine(4);
    struct generator *a = NULL, *b = NULL;
    struct transform *one = NULL, *two = NULL;
    static double z[64 * 64], dense[150 * 97];
    rough.hurst = 0.2;
    draw_random(&spectrum, &coarse, &a);
    draw_random(&rough, &fine, &b);
    assert_int_equal(generator_run(a, key, z, NULL, NULL), 0);
    assert_int_equal(generator_run(b, key, dense, NULL, NULL), 0);
    assert_int_equal(transform_create(&one, &coarse, 16, 16, NULL), 0);
    assert_int_equal(transform_create(&two, &fine, 16, 16, NULL), 0);
    transform_forward(one, z);
    transform_forward(two, dense);
    size_t common = 0;
    for (size_t mx = 0; mx <= 16; mx++)
        for (size_t my = 0; my <= 16; my++) {
            double power = modes_power(generator_modes(a), mx, (long)my);
            double other = modes_power(generator_modes(b), mx, (long)my);
            if (!(power > 0))
                continue;
            double complex first = transform_spectrum(one)[mx * coarse.ny + my] / sqrt(power);
            double complex second = transform_spectrum(two)[mx * fine.ny + my] / sqrt(other);
            check_close(cabs(first - second), 0, 1e-9);
            common++;
        }
    assert_true(common > 100);
    transform_destroy(&one);
    transform_destroy(&two);
    generator_destroy(&a);
    generator_destroy(&b);
}

/* Compares the spectrum of z with one that is known, on the half plane of a band below the grid's:
 * to 12 digits. */
static void check_spectrum(const struct modes *modes, const double *z) {
    struct transform *transform = NULL;
    size_t ny = modes->grid.ny, common = 0;
    assert_int_equal(transform_create(&transform, &modes->grid, modes->mode_x, modes->mode_y, NULL),
                     0);
    transform_forward(transform, z);
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (long my = -(long)modes->mode_y; my <= (long)modes->mode_y; my++) {
            size_t row = my >= 0 ? (size_t)my : ny - (size_t)-my;
            double complex mode = transform_spectrum(transform)[mx * ny + row];
            double power = modes_power(modes, mx, my);
            check_close(creal(mode) * creal(mode) + cimag(mode) * cimag(mode), power,
                        1e-15 + 1e-12 * power);
            common += power > 0;
        }
    assert_true(common > 100);
    transform_destroy(&transform);
}

/* What is known of a surface without a transform of it: its own spectrum, which changes with each
 * run where amplitudes are random, and is the prescribed one where they are not. */
static void the_drawn_spectrum_is_that_of_the_surface(void **state) {
    (void)state;
    const struct grid grid = {64, 64, 16, 16};
    static const enum heights_type HEIGHTS[] = {HEIGHTS_GAUSSIAN, HEIGHTS_WEIBULL_MAX};
    struct spectrum spectrum = self_affine(4);
    static double z[64 * 64];
    for (size_t h = 0; h < 2; h++)
        for (int random = 0; random < 2; random++) {
            struct surface_options options = SURFACE_DEFAULTS;
            struct generator *generator = NULL;
            options.heights = (struct heights){.type = HEIGHTS[h], .shape = 2};
            options.amplitudes = random ? AMPLITUDES_RANDOM : AMPLITUDES_FIXED;
            options.max_iterations = 20;
            assert_int_equal(generator_create(&generator, &spectrum, &grid, &options, NULL), 0);
            const struct modes *mean = generator_modes(generator);
            for (uint64_t r = 0; r < 2; r++) {
                assert_int_equal(
                    generator_run(generator, (struct random_key){9, 0, r}, z, NULL, NULL), 0);
                check_spectrum(generator_drawn(generator), z);
            }
            assert_true((generator_drawn(generator) == mean) == !random);
            generator_destroy(&generator);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spectrum_is_exact),
        cmocka_unit_test(finer_grid_is_the_same_surface),
        cmocka_unit_test(a_wave_keeps_its_phase_in_other_spectra),
        cmocka_unit_test(realisation_depends_on_its_key_alone),
        cmocka_unit_test(one_mode_is_one_wave),
        cmocka_unit_test(random_powers_are_those_of_normal_modes),
        cmocka_unit_test(a_wave_keeps_its_random_amplitude),
        cmocka_unit_test(the_drawn_spectrum_is_that_of_the_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
