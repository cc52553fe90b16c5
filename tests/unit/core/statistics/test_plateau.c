/* Protects: the two RMS heights of a stratified face, and the share of material at its knee, come
 * back from heights that have them, whatever their scale; heights of one Gaussian law have none. */
#include "core/statistics/heights/plateau.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <gsl/gsl_cdf.h>
#include <stdlib.h>

enum { MANY = 1 << 19, SIDE = 512 };

static void fit(struct plateau_law *out, const double *z, size_t n, double *mean) {
    const struct grid grid = {n, 1, 1, 1};
    const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
    struct material_curve curve;
    assert_int_equal(material_curve_create(&curve, &map, NULL), 0);
    plateau_fit(&curve, out);
    *mean = curve.mean;
    material_curve_clear(&curve);
}

/* A plateau at height 0, of RMS height 1, and valleys of `rms` whose mean is `above` it. */
struct face {
    double rms, above, scale;
};

static void check_face(const struct face *face, const struct plateau_law *found, double mean,
                       double tolerance) {
    const double ratio = gsl_cdf_ugaussian_Q(-face->above / (face->rms - 1));
    print_message("valleys of RMS height %g, %g above: found %.4f, %.4f, ratio %.4f for %.4f; "
                  "residual %.2g, of a line %.2g\n",
                  face->rms, face->above, found->plateau_rms / face->scale,
                  found->valley_rms / face->scale, found->ratio, ratio, found->residual,
                  found->line_residual);
    check_relative(found->plateau_rms, face->scale, tolerance);
    check_relative(found->valley_rms, face->rms * face->scale, tolerance);
    check_relative(found->ratio, ratio, tolerance);
    check_close(found->plateau_mean + mean, 0, tolerance * face->scale);
    check_close(found->valley_mean + mean, face->above * face->scale,
                tolerance * face->rms * face->scale);
    assert_true(found->residual < 0.02 && found->line_residual > 5 * found->residual);
}

/* Independent heights: errors are those of counting. */
static void both_laws_come_back(void **state) {
    (void)state;
    static const struct face FACES[] = {
        {5, 4, 1}, {8, 10, 1e-7}, {3, 1, 1}, {20, 0, 1e3}, {6, -2, 1}};
    uint64_t seed = 61;
    double *z = malloc(2 * MANY * sizeof *z);
    assert_non_null(z);
    for (size_t f = 0; f < sizeof FACES / sizeof *FACES; f++) {
        struct plateau_law found;
        double mean;
        noise_fill(&seed, 2 * MANY, z);
        for (size_t k = 0; k < MANY; k++)
            z[k] = FACES[f].scale * fmin(z[k], FACES[f].above + FACES[f].rms * z[MANY + k]);
        fit(&found, z, MANY, &mean);
        check_face(&FACES[f], &found, mean, 0.04);
        for (size_t k = 0; k < MANY; k += MANY / 16) {
            double below = 0;
            for (size_t other = 0; other < MANY; other++)
                below += z[other] < z[k] ? 1.0 / MANY : 0;
            check_close(1 - plateau_ratio(&found, z[k] - mean), below, 0.005);
        }
    }
    free(z);
}

static void surface_make(double hurst, uint64_t seed, double *z) {
    const struct grid grid = {SIDE, SIDE, SIDE, SIDE};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = hurst,
                                      .wavelength_long = SIDE / 16.0,
                                      .wavelength_rolloff = SIDE / 16.0,
                                      .wavelength_short = 4};
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    options.amplitudes = AMPLITUDES_RANDOM;
    assert_int_equal(generator_create(&generator, &spectrum, &grid, &options, NULL), 0);
    assert_int_equal(generator_run(generator, (struct random_key){seed, 0, 0}, z, NULL, NULL), 0);
    generator_destroy(&generator);
}

/* Of two random surfaces the errors are those of few independent heights. */
static void surfaces_are_told_apart(void **state) {
    (void)state;
    static double plateau[SIDE * SIDE], valleys[SIDE * SIDE], z[SIDE * SIDE];
    const struct face face = {6, 5, 1};
    struct plateau_law found;
    double mean;
    surface_make(0.8, 3, plateau);
    surface_make(0.5, 4, valleys);
    for (size_t k = 0; k < SIDE * SIDE; k++)
        z[k] = fmin(plateau[k], face.above + face.rms * valleys[k]);
    fit(&found, z, SIDE * SIDE, &mean);
    check_face(&face, &found, mean, 0.2);
    fit(&found, plateau, SIDE * SIDE, &mean);
    print_message("one surface: %.3g, %.3g, ratio %.3g, residual %.2g, of a line %.2g\n",
                  found.plateau_rms, found.valley_rms, found.ratio, found.residual,
                  found.line_residual);
    assert_true(isnan(found.residual) || found.line_residual < 0.1);
}

static void other_heights_have_none(void **state) {
    (void)state;
    double z[1000], mean;
    struct plateau_law found;
    for (size_t k = 0; k < 1000; k++)
        z[k] = gsl_cdf_ugaussian_Pinv(((double)k + 0.5) / 1000);
    fit(&found, z, 1000, &mean);
    assert_true(isnan(found.plateau_rms) || found.line_residual < 1e-6);
    for (size_t k = 0; k < 1000; k++) /* concave: hills stand out, not valleys */
        z[k] = exp(z[k]);
    fit(&found, z, 1000, &mean);
    assert_true(isnan(found.plateau_rms) && isnan(found.ratio));
    for (size_t k = 0; k < 1000; k++)
        z[k] = 1;
    fit(&found, z, 1000, &mean);
    assert_true(isnan(found.plateau_rms));
    fit(&found, z, 3, &mean);
    assert_true(isnan(found.plateau_rms));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_laws_come_back),
        cmocka_unit_test(surfaces_are_told_apart),
        cmocka_unit_test(other_heights_have_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
