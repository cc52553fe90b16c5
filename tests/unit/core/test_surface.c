/* Protects: a generated surface has exactly the spectrum asked for, and is the same surface on
 * every grid, in every process, for one seed, case and realisation. */
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spectrum_is_exact),
        cmocka_unit_test(finer_grid_is_the_same_surface),
        cmocka_unit_test(realisation_depends_on_its_key_alone),
        cmocka_unit_test(one_mode_is_one_wave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
