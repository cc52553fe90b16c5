/* Protects: the lay of a surface is found by its spectrum, at any angle, over one and over a
 * sub-map; over its ellipses the density is that of waves across; isotropic surfaces have none that
 * is sure; what cannot be followed has no lay. How often its intervals hold the truth is counted in
 * tests/validation/core/test_spectrum_recovery.c. */
#include "tests/support/check.h"

#include "core/statistics/spectra/lay_fit.h"
#include "core/surface/surface.h"
#include "tests/support/effort.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 256 };
static const struct grid GRID = {SIDE, SIDE, SIDE, SIDE};
static const struct spectrum_fit_request BY_THE_MAP = {0};
static const double DEGREE = M_PI / 180;

/* Ratio 0: isotropic. */
static double *surface(double ratio, double degrees, bool fixed, uint64_t realisation) {
    const struct spectrum law = {.type = SPECTRUM_SELF_AFFINE,
                                 .hurst = 0.7,
                                 .wavelength_long = SIDE,
                                 .wavelength_rolloff = 24,
                                 .wavelength_short = 4,
                                 .anisotropy = ratio,
                                 .lay_angle = degrees * DEGREE};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    double *z = malloc(grid_points(&GRID) * sizeof *z);
    assert_non_null(z);
    options.amplitudes = fixed ? AMPLITUDES_FIXED : AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&generator, &law, &GRID, &options, NULL), 0);
    assert_int_equal(
        generator_run(generator, (struct random_key){11, 0, realisation}, z, NULL, NULL), 0);
    generator_destroy(&generator);
    return z;
}

static struct lay lay_of(const double *z, const struct grid *grid, enum boundary boundary,
                         const struct lay *start) {
    const struct measured_map map = {grid, z, boundary};
    struct map_spectrum *spectrum = NULL;
    struct lay lay;
    assert_int_equal(map_spectrum_create(&spectrum, &map, NULL), 0);
    assert_int_equal(lay_fit_measure(&lay, start, spectrum, &BY_THE_MAP, NULL), 0);
    map_spectrum_destroy(&spectrum);
    return lay;
}

/* Amplitudes that are not random leave no scatter but that of the grid. */
static void exact_spectra_give_their_lay(void **state) {
    (void)state;
    static const double LAYS[][2] = {{1.5, 0}, {2, 20}, {3, -45}, {4, 90}, {8, 65}};
    for (size_t n = 0; n < sizeof LAYS / sizeof *LAYS; n++) {
        double *z = surface(LAYS[n][0], LAYS[n][1], true, n);
        const struct lay start = {.ratio = LAYS[n][0] * 1.2, .angle = (LAYS[n][1] + 4) * DEGREE};
        struct lay found = lay_of(z, &GRID, BOUNDARY_PERIODIC, &start);
        check_relative(found.ratio, LAYS[n][0], 0.01);
        check_close(cos(2 * (found.angle - LAYS[n][1] * DEGREE)), 1, 1e-3);
        assert_true(found.angle > -M_PI / 2 && found.angle <= M_PI / 2);
        assert_true(found.ratio_error > 0 && found.ratio_error < 0.1);
        assert_true(lay_p_value(&found) < 1e-4);
        free(z);
    }
}

/* The density over ellipses falls as that of the waves across: of fixed amplitudes exactly, where
 * rings are wide. */
static void ellipses_have_the_density_across(void **state) {
    (void)state;
    const struct lay lay = {.ratio = 3, .angle = 30 * DEGREE};
    double *z = surface(lay.ratio, 30, true, 1);
    const struct measured_map map = {&GRID, z, BOUNDARY_PERIODIC};
    struct map_spectrum *circles = NULL, *ellipses = NULL;
    assert_int_equal(map_spectrum_create(&circles, &map, NULL), 0);
    assert_int_equal(map_spectrum_create_along(&ellipses, circles, &lay, NULL), 0);
    double first = ellipses->density[40] * pow(40, 3.4);
    for (size_t r = 30; r < 62; r++)
        check_relative(ellipses->density[r] * pow((double)r, 3.4), first, 0.03);
    assert_true(ellipses->density[70] < 1e-6 * ellipses->density[60]); /* beyond the sharp end */
    assert_true(circles->density[50] > 1.5 * ellipses->density[50] ||
                circles->density[50] < ellipses->density[50] / 1.5);
    double modes = 0; /* of random amplitudes, a mode each has two degrees of freedom */
    for (size_t r = 40; r < 50; r++)
        modes += ellipses->freedom[r];
    check_relative(modes, M_PI * (49.5 * 49.5 - 39.5 * 39.5) / 3, 0.05);
    map_spectrum_destroy(&ellipses);
    map_spectrum_destroy(&circles);
    free(z);
}

static void cut(double *z, size_t n) {
    for (size_t j = 0; j < n; j++)
        memmove(z + j * n, z + j * SIDE, n * sizeof *z);
}

/* Of sub-maps, the errors hold what is found: as often as a 99 % interval, of 12. */
static void pieces_hold_the_lay(void **state) {
    (void)state;
    enum { PIECES = 12, PART = 128 };
    static const double ERRORS = 2.58;
    const struct grid piece = {PART, PART, PART, PART};
    size_t ratios = 0, angles = 0;
    for (uint64_t n = 0; n < PIECES; n++) {
        double *z = surface(2, 25, false, n);
        cut(z, PART);
        const struct lay start = {.ratio = 1.7, .angle = 15 * DEGREE};
        struct lay found = lay_of(z, &piece, BOUNDARY_OPEN, &start);
        assert_false(lay_is_plain(&found));
        ratios += fabs(log(found.ratio / 2)) < ERRORS * found.ratio_error ? 1 : 0;
        angles += fabs(found.angle - 25 * DEGREE) < ERRORS * found.angle_error ? 1 : 0;
        free(z);
    }
    assert_true(ratios + 1 >= PIECES);
    assert_true(angles + 1 >= PIECES);
}

/* At a level of 0.05 few isotropic surfaces have a lay: of 40 more than 6 once in 300 times. */
static void isotropic_surfaces_have_none(void **state) {
    (void)state;
    enum { SURFACES = 40 };
    size_t sure = 0;
    for (uint64_t n = 0; n < SURFACES; n++) {
        double *z = surface(0, 0, false, 100 + n);
        const struct lay start = {.ratio = 1.05, .angle = 0.1 * (double)n};
        struct lay found = lay_of(z, &GRID, BOUNDARY_PERIODIC, &start);
        sure += lay_p_value(&found) < 0.05 ? 1 : 0;
        free(z);
    }
    print_message("%zu of %d isotropic surfaces at 0.05\n", sure, SURFACES);
    assert_true(sure <= 6);
}

static void what_has_no_lay(void **state) {
    (void)state;
    const struct grid small = {8, 8, 8, 8};
    const struct lay start = {.ratio = 2}, far = {.ratio = 1e6}, none = {.ratio = NAN};
    double *z = surface(2, 0, false, 3);
    cut(z, 8);
    struct lay found = lay_of(z, &small, BOUNDARY_OPEN, &start);
    assert_true(lay_is_plain(&found));
    assert_true(lay_p_value(&found) == 1);
    free(z);
    z = surface(2, 0, false, 3);
    found = lay_of(z, &GRID, BOUNDARY_PERIODIC, &far);
    assert_true(lay_is_plain(&found));
    found = lay_of(z, &GRID, BOUNDARY_PERIODIC, &none);
    assert_true(lay_is_plain(&found));
    memset(z, 0, grid_points(&GRID) * sizeof *z);
    found = lay_of(z, &GRID, BOUNDARY_PERIODIC, &start);
    assert_true(lay_is_plain(&found));
    free(z);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_spectra_give_their_lay),
        cmocka_unit_test(ellipses_have_the_density_across),
        cmocka_unit_test(pieces_hold_the_lay),
        cmocka_unit_test(isotropic_surfaces_have_none),
        cmocka_unit_test(what_has_no_lay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
