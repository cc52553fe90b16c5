/* Protects: of a face that is the lower of two random surfaces, the slopes and longest waves of
 * both come back, and so does the shortest wave; a map without one of both is refused. */
#include "core/statistics/spectra/strata_fit.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 256, POINTS = SIDE * SIDE };
static const struct grid GRID = {SIDE, SIDE, SIDE, SIDE};

struct truth {
    double hurst, shortest, longest[STRATA], rms, offset;
};

/* Fills a surface of RMS height 1. */
static void make(const struct truth *truth, int stratum, uint64_t number, double *z) {
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = truth->hurst,
                                      .wavelength_long = truth->longest[stratum],
                                      .wavelength_rolloff = truth->longest[stratum],
                                      .wavelength_short = truth->shortest,
                                      .scale = SCALE_RMS_HEIGHT,
                                      .scale_value = 1};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&generator, &spectrum, &GRID, &options, NULL), 0);
    const struct random_key key = {3, (uint64_t)stratum, number};
    assert_int_equal(generator_run(generator, key, z, NULL, NULL), 0);
    generator_destroy(&generator);
}

/* Returns the mean square of forward differences along both axes. */
static double slope_of(const double *z) {
    double total = 0;
    for (size_t j = 0; j + 1 < SIDE; j++)
        for (size_t i = 0; i + 1 < SIDE; i++) {
            const double x = z[j * SIDE + i + 1] - z[j * SIDE + i];
            const double y = z[(j + 1) * SIDE + i] - z[j * SIDE + i];
            total += x * x + y * y;
        }
    return sqrt(total / ((SIDE - 1.) * (SIDE - 1.)));
}

static struct plateau_law law_of(const double *z) {
    const struct measured_map map = {&GRID, z, BOUNDARY_OPEN};
    struct material_curve curve;
    struct plateau_law law;
    assert_int_equal(material_curve_create(&curve, &map, NULL), 0);
    plateau_fit(&curve, &law);
    material_curve_clear(&curve);
    return law;
}

static void both_spectra_come_back(void **state) {
    (void)state;
    static const struct truth TRUTHS[] = {{0.8, 4, {32, 32}, 0.2, -0.8},
                                          {0.8, 4, {32, 8}, 0.25, -0.5}};
    double *valleys = malloc(POINTS * sizeof *valleys), *plateau = malloc(POINTS * sizeof *plateau);
    assert_non_null(valleys);
    assert_non_null(plateau);
    for (size_t t = 0; t < sizeof TRUTHS / sizeof *TRUTHS; t++) {
        const struct truth *truth = &TRUTHS[t];
        struct strata_law found;
        struct error err = {0};
        make(truth, STRATUM_VALLEYS, 0, valleys);
        make(truth, STRATUM_PLATEAU, 0, plateau);
        for (size_t p = 0; p < POINTS; p++)
            plateau[p] = truth->rms * plateau[p] + truth->offset;
        const double slope[STRATA] = {slope_of(valleys), slope_of(plateau)};
        for (size_t p = 0; p < POINTS; p++)
            valleys[p] = fmin(valleys[p], plateau[p]) + 7; /* about no height in particular */
        const struct plateau_law law = law_of(valleys);
        for (size_t p = 1000; p < 1100; p++)
            valleys[p] = (double)NAN; /* a hole */
        const struct measured_map map = {&GRID, valleys, BOUNDARY_OPEN};
        if (strata_fit(&found, &map, &law, &err) != 0)
            fail_msg("%s", err.text);
        print_message("slopes %.3f and %.3f of the truth, longest %.3g and %.3g for %g and %g, "
                      "H %.3f and %.3f for %g, shortest %.3g for %g\n",
                      found.rms_slope[0] / slope[0], found.rms_slope[1] / slope[1],
                      found.wavelength_long[0], found.wavelength_long[1], truth->longest[0],
                      truth->longest[1], found.hurst[0], found.hurst[1], truth->hurst,
                      found.wavelength_short, truth->shortest);
        for (int s = 0; s < STRATA; s++) {
            check_relative(found.rms_slope[s], slope[s], 0.06);
            check_relative(found.wavelength_long[s], truth->longest[s], 0.2);
            if (truth->longest[s] > 4 * truth->shortest) /* a narrow band has no exponent */
                check_close(found.hurst[s], truth->hurst, 0.15);
        }
        assert_true(found.wavelength_short == truth->shortest);
        check_relative(found.rms_ratio, truth->rms, 0.15);
        check_close(found.offset, truth->offset, 0.1);
    }
    free(valleys);
    free(plateau);
}

static void small_maps_are_refused(void **state) {
    (void)state;
    static const struct grid SMALL = {31, 31, 31, 31};
    static double z[31 * 31];
    const struct measured_map map = {&SMALL, z, BOUNDARY_OPEN};
    const struct plateau_law law = {0, 1, 0, 4, 0.5, 0, 1};
    struct strata_law found;
    struct error err = {0};
    assert_int_equal(strata_fit(&found, &map, &law, &err), ERROR_INPUT);
    assert_string_equal(err.text, "a stratified map of 31 columns; allowed: at least 32");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_spectra_come_back),
        cmocka_unit_test(small_maps_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
