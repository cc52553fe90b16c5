/* Protects: several patches of one surface determine one law together, each in its own band: the
 * law's intervals hold the truth, and are narrower than those of one patch; patches that differ
 * more than their waves explain are found; one patch alone is refused. */
#include "core/map/preparation/detrend.h"
#include "core/statistics/spectra/joint_fit.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include <gsl/gsl_errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELL = 640, FINE = 128, COARSE = 128, STRIDE = 4, PATCHES = 3 };
static const double HURST = 0.7, ROLLOFF = 80, SHORTEST = 4;

static double *surface_of(uint64_t realisation) {
    const struct grid cell = {CELL, CELL, CELL, CELL};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = HURST,
                                      .wavelength_long = CELL,
                                      .wavelength_rolloff = ROLLOFF,
                                      .wavelength_short = SHORTEST,
                                      .anisotropy = 1,
                                      .scale = SCALE_RMS_SLOPE,
                                      .scale_value = 0.2};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    double *z = calloc((size_t)CELL * CELL, sizeof *z);
    assert_non_null(z);
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&generator, &spectrum, &cell, &options, NULL), 0);
    assert_int_equal(
        generator_run(generator, (struct random_key){11, 0, realisation}, z, NULL, NULL), 0);
    generator_destroy(&generator);
    return z;
}

/* A patch of n by n points, so many apart, with its spectrum and what fits that. */
struct cut {
    struct grid grid;
    double *z;
    struct map_spectrum *spectrum;
    struct spectrum_fit fit;
};

static struct cut cut_of(const double *z, size_t from, size_t n, size_t stride, double factor) {
    const double side = (double)(n * stride);
    struct cut cut = {.grid = {n, n, side, side}, .z = calloc(n * n, sizeof(double))};
    struct trend trend;
    assert_non_null(cut.z);
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++)
            cut.z[j * n + i] =
                factor * z[((from + j * stride) % CELL) * CELL + (from + i * stride) % CELL];
    assert_int_equal(detrend(&cut.grid, cut.z, DETREND_PLANE, &trend, NULL), 0);
    const struct measured_map map = {&cut.grid, cut.z, BOUNDARY_OPEN};
    assert_int_equal(map_spectrum_create(&cut.spectrum, &map, NULL), 0);
    assert_int_equal(
        spectrum_fit_measure(cut.spectrum, &(struct spectrum_fit_request){0}, &cut.fit, NULL), 0);
    return cut;
}

static void cut_clear(struct cut *cut) {
    free(cut->z);
    map_spectrum_destroy(&cut->spectrum);
}

/* Two fine patches and a coarse one; the last fine one has its heights times a factor. */
static void fit_three(uint64_t realisation, double factor, struct joint_fit *out,
                      struct joint_patch patches[PATCHES], double *alone) {
    double *z = surface_of(realisation);
    struct cut cuts[PATCHES] = {cut_of(z, 0, FINE, 1, 1), cut_of(z, 300, FINE, 1, factor),
                                cut_of(z, 100, COARSE, STRIDE, 1)};
    struct error err = {0};
    for (size_t n = 0; n < PATCHES; n++)
        patches[n] = (struct joint_patch){.spectrum = cuts[n].spectrum, .fit = &cuts[n].fit};
    if (joint_fit_measure(PATCHES, patches, out, &err) != 0)
        fail_msg("%s", err.text);
    *alone = cuts[0].fit.hurst.high - cuts[0].fit.hurst.low;
    for (size_t n = 0; n < PATCHES; n++)
        cut_clear(&cuts[n]);
    free(z);
}

static bool inside(const struct interval *interval, double truth) {
    return !(truth < interval->low) && !(truth > interval->high);
}

/* Of 95 % intervals at least 7 of 8 hold the truth in 94 % of all such tests, and 6 in 99.4 %. */
static void holds_the_law(void **state) {
    (void)state;
    const uint64_t surfaces = every_case() ? 100 : 4;
    size_t hurst = 0, rolloff = 0, narrower = 0;
    for (uint64_t r = 0; r < surfaces; r++) {
        struct joint_patch patches[PATCHES];
        struct joint_fit fit;
        double alone;
        fit_three(r, 1, &fit, patches, &alone);
        print_message("H %.3f [%.3f, %.3f], one patch %.3f wide; roll-off %.1f [%.1f, %.1f]; "
                      "between %.2f (p %.2f); deviance %.2f\n",
                      fit.hurst.value, fit.hurst.low, fit.hurst.high, alone,
                      fit.rolloff_wavelength.value, fit.rolloff_wavelength.low,
                      fit.rolloff_wavelength.high, fit.between, fit.p_value, fit.deviance);
        assert_int_equal(fit.patches, PATCHES);
        hurst += inside(&fit.hurst, HURST);
        rolloff += inside(&fit.rolloff_wavelength, ROLLOFF);
        narrower += fit.hurst.high - fit.hurst.low < alone;
    }
    print_message("of %zu: H %zu, roll-off %zu, narrower %zu\n", (size_t)surfaces, hurst, rolloff,
                  narrower);
    assert_true(4 * hurst >= 3 * surfaces && 4 * rolloff >= 3 * surfaces);
    assert_true(4 * narrower >= 3 * surfaces);
}

/* Heights 1.4 times as large have a density that is 0.67 larger in its logarithm. */
static void finds_patches_that_differ(void **state) {
    (void)state;
    struct joint_patch patches[PATCHES];
    struct joint_fit fit;
    double alone;
    fit_three(3, 1.4, &fit, patches, &alone);
    print_message("between %.2f, p %.1e; offsets %.2f %.2f %.2f\n", fit.between, fit.p_value,
                  patches[0].offset, patches[1].offset, patches[2].offset);
    assert_true(fit.p_value < 1e-3 && fit.between > 0.2 && fit.between < 1);
    check_close(patches[1].offset - patches[0].offset, 2 * log(1.4), 0.25);
}

static void refuses_one(void **state) {
    (void)state;
    double *z = surface_of(0);
    struct cut cut = cut_of(z, 0, FINE, 1, 1);
    struct joint_patch patch = {.spectrum = cut.spectrum, .fit = &cut.fit};
    struct joint_fit fit;
    struct error err = {0};
    assert_int_equal(joint_fit_measure(1, &patch, &fit, &err), ERROR_INPUT);
    assert_string_equal(err.text,
                        "1 of 1 maps have waves that can be trusted; a joint fit needs two");
    cut_clear(&cut);
    free(z);
}

/* A lay has two directions, so that 89 and -89 degrees are near each other; what has no lay does
 * not count. */
static void lays_are_one(void **state) {
    (void)state;
    const double degree = M_PI / 180;
    const struct lay lays[] = {
        {2, 89 * degree, 0.1, 0.02}, LAY_NONE, {4, -89 * degree, 0.1, 0.02}, {8, 0, 1e3, 1e3}};
    const struct lay one = joint_fit_lay(3, lays), same = joint_fit_lay(4, lays);
    check_relative(one.ratio, sqrt(8), 1e-12);
    check_close(fabs(one.angle), M_PI / 2, 1e-9);
    check_relative(one.ratio_error, 0.1 / sqrt(2), 1e-12);
    check_relative(one.angle_error, 0.02 / sqrt(2), 1e-12);
    check_relative(same.ratio, one.ratio, 1e-6);
    assert_true(lay_is_plain(&(struct lay){joint_fit_lay(1, lays + 1).ratio, 0, 0, 0}));
}

/* Spectra that no law has: the failure says so, and is not one of memory. */
static void spectra_without_a_law_are_refused(void **state) {
    (void)state;
    double *z = surface_of(1);
    struct cut cuts[2] = {cut_of(z, 0, FINE, 1, 1), cut_of(z, 300, FINE, 1, 1)};
    struct joint_patch patches[2];
    struct joint_fit out;
    struct error err = {0};
    for (size_t n = 0; n < 2; n++) {
        patches[n] = (struct joint_patch){.spectrum = cuts[n].spectrum, .fit = &cuts[n].fit};
        for (size_t r = 0; r < cuts[n].spectrum->bins; r++)
            cuts[n].spectrum->density[r] = NAN;
    }
    assert_int_equal(joint_fit_measure(2, patches, &out, &err), ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "a joint fit of 2 maps: the deviance"));
    cut_clear(&cuts[0]);
    cut_clear(&cuts[1]);
    free(z);
}

int main(void) {
    gsl_set_error_handler_off(); /* as the program does */
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(holds_the_law), cmocka_unit_test(lays_are_one),
        cmocka_unit_test(finds_patches_that_differ), cmocka_unit_test(refuses_one),
        cmocka_unit_test(spectra_without_a_law_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
