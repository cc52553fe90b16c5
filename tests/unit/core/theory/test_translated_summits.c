/* Protects: theory of the summits of translated surfaces. A field that is its own translation has
 * the summits of Nayak and of Longuet-Higgins; densities are normalised and agree with each other
 * and with their means; both tails and the bound of the heights are stable; and the theory of a
 * grid maps heights as that of a fine grid does. */
#include "core/surface/spectrum.h"
#include "core/surface/translation/translation.h"
#include "core/theory/bin_averages.h"
#include "core/theory/sampled_field.h"
#include "core/theory/sampled_summits.h"
#include "core/theory/translated_summits.h"
#include "tests/support/check.h"
#include <stdlib.h>

/* The law of a self-affine spectrum of H = 0.8 and ratio 8 in a cell of 8 longest waves. */
struct sample {
    struct translation *translation;
    struct modes *modes;
    struct translated_surface surface;
};

static struct spectrum spectrum_make(void) {
    return (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                             .hurst = 0.8,
                             .wavelength_long = 8,
                             .wavelength_rolloff = 8,
                             .wavelength_short = 1};
}

static struct sample sample_make(int dimension, const struct heights *heights, size_t points,
                                 bool mirrored) {
    struct sample sample = {0};
    struct spectrum spectrum = spectrum_make();
    size_t n = 64 * points;
    const struct grid grid = {n, dimension == 2 ? n : 1, 64, 64};
    assert_int_equal(translation_create(&sample.translation, &spectrum, dimension, heights, NULL),
                     0);
    spectrum.translation = sample.translation;
    assert_int_equal(modes_create(&sample.modes, &spectrum, &grid, NULL), 0);
    sample.surface = (struct translated_surface){
        .dimension = dimension, .heights = {translation_function(sample.translation), mirrored}};
    modes_gaussian_moments(sample.modes, &sample.surface.gaussian);
    modes_moments(sample.modes, &sample.surface.reached);
    return sample;
}

static void sample_clear(struct sample *sample) {
    modes_destroy(&sample->modes);
    translation_destroy(&sample->translation);
}

static const struct heights GAUSSIAN = {.type = HEIGHTS_GAUSSIAN};
static const struct heights EXPONENTIAL = {.type = HEIGHTS_WEIBULL_MAX, .shape = 1};
static const struct heights RAYLEIGH = {.type = HEIGHTS_WEIBULL_MIN, .shape = 2};
static const struct heights LOGNORMAL = {.type = HEIGHTS_LOGNORMAL, .shape = 0.5};
static const struct heights GAMMA = {.type = HEIGHTS_GAMMA, .shape = 3};
static const struct heights BETA = {.type = HEIGHTS_BETA, .shape = 2, .second = 3};

enum { HEIGHTS = 200, T1 = 150 };
struct histograms {
    double pdf[HEIGHTS], cdf[HEIGHTS], curvature[HEIGHTS], t1[T1], joint[HEIGHTS * T1];
};

/* f = g but for the 1e-10 of its table: the same nodes give the same numbers to 1e-9. */
static void the_identity_is_gaussian(void **state) {
    (void)state;
    static const struct bins height = {-5, 7, HEIGHTS}, t1 = {-10, 0, T1};
    static struct histograms found, expected;
    for (int dimension = 1; dimension <= 2; dimension++) {
        struct sample sample = sample_make(dimension, &GAUSSIAN, 4, dimension == 1);
        const struct moments *m = &sample.surface.gaussian;
        check_relative(sample.surface.reached.m4, m->m4, 1e-9);
        translated_summits_heights(&sample.surface, &height, found.pdf, found.cdf, found.curvature);
        translated_summits_curvatures(&sample.surface, &t1, found.t1);
        translated_summits_joint(&sample.surface, &height, &t1, found.joint);
        bin_averages_summits(dimension, m->nayak_alpha, &height, expected.pdf, expected.cdf,
                             expected.curvature);
        bin_averages_curvatures(dimension, &t1, expected.t1);
        bin_averages_joint(dimension, m->nayak_alpha, &height, &t1, expected.joint);
        for (size_t b = 0; b < HEIGHTS; b++) {
            check_relative(found.pdf[b], expected.pdf[b], 1e-8);
            check_close(found.cdf[b], expected.cdf[b], 1e-9);
            check_relative(found.curvature[b], expected.curvature[b], 1e-8);
        }
        for (size_t b = 0; b < T1; b++)
            check_close(found.t1[b], expected.t1[b], 1e-9);
        for (size_t cell = 0; cell < HEIGHTS * T1; cell++)
            check_close(found.joint[cell], expected.joint[cell], 1e-9);
        struct summit_expectation mean = translated_summits_expectation(&sample.surface);
        struct summit_expectation of = summit_expectation(dimension, m->m2, m->m4, m->nayak_alpha);
        check_relative(mean.density, of.density, 1e-12);
        check_close(mean.height_mean, of.height_mean, 1e-9);
        check_close(mean.height_variance, of.height_variance, 1e-9);
        check_close(mean.height_skewness, of.height_skewness, 1e-8);
        check_close(mean.height_kurtosis, of.height_kurtosis, 1e-8);
        check_close(mean.curvature, of.curvature, 1e-9);
        sample_clear(&sample);
    }
}

/* Bins reach beyond all heights and curvatures but for 1e-12 of the summits. The means of bins are
 * those of all summits as far as bins are wide. */
static void check_whole(const struct translated_surface *surface) {
    static const struct bins height = {-25, 55, HEIGHTS}, t1 = {-240, 0, T1};
    static struct histograms h;
    double width = bins_width(&height), t1_width = bins_width(&t1);
    double all = 0, mean = 0, curvature = 0, t1_all = 0;
    translated_summits_heights(surface, &height, h.pdf, h.cdf, h.curvature);
    translated_summits_curvatures(surface, &t1, h.t1);
    translated_summits_joint(surface, &height, &t1, h.joint);
    for (size_t b = 0; b < HEIGHTS; b++) {
        double row = 0;
        for (size_t column = 0; column < T1; column++)
            row += h.joint[b * T1 + column] * t1_width;
        check_close(row, h.pdf[b], 1e-9);
        all += h.pdf[b] * width;
        check_close(h.cdf[b], all, 1e-9);
        mean += h.pdf[b] * width * bins_centre(&height, b);
        if (h.pdf[b] > 0)
            curvature += h.pdf[b] * width * h.curvature[b];
    }
    for (size_t column = 0; column < T1; column++) {
        double sum = 0;
        for (size_t b = 0; b < HEIGHTS; b++)
            sum += h.joint[b * T1 + column] * width;
        check_close(sum, h.t1[column], 1e-9);
        t1_all += h.t1[column] * t1_width;
    }
    struct summit_expectation of = translated_summits_expectation(surface);
    check_close(all, 1, 1e-9);
    check_close(t1_all, 1, 1e-9);
    check_close(curvature, of.curvature, 1e-8);
    check_close(mean, of.height_mean, width / 2);
}

static void densities_are_normalised(void **state) {
    (void)state;
    static const struct heights *const HEIGHTS_OF[] = {&EXPONENTIAL, &RAYLEIGH, &LOGNORMAL, &GAMMA,
                                                       &BETA};
    for (size_t a = 0; a < sizeof HEIGHTS_OF / sizeof *HEIGHTS_OF; a++)
        for (int dimension = 1; dimension <= 2; dimension++)
            for (int mirrored = 0; mirrored < 2; mirrored++) {
                struct sample sample = sample_make(dimension, HEIGHTS_OF[a], 4, mirrored == 1);
                check_whole(&sample.surface);
                sample_clear(&sample);
            }
}

/* Values of H = 0.8, ratio 8, C = 1: the density of g over that of the asked spectrum; and heights
 * and depths of summits at two alphas of g, by sums of F6.1 over a lattice of heights and t1 to
 * their digits. A Gaussian surface has 0.922 and 0.904. */
static void exponential_heights_have_known_summits(void **state) {
    (void)state;
    static const double ALPHA[2] = {5.995, 5.34};
    static const double MEAN[2][2] = {{0.637089, 1.053590}, {0.663596, 1.131125}};
    const struct spectrum spectrum = spectrum_make();
    struct moments asked;
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        struct sample sample = sample_make(2, &EXPONENTIAL, 4, mirrored == 1);
        assert_int_equal(spectrum_moments(&spectrum, &sample.modes->grid, &asked, NULL), 0);
        double density = translated_summits_expectation(&sample.surface).density;
        check_close(density / nayak_summit_density(asked.m2, asked.m4), 0.9418, 5e-5);
        for (int a = 0; a < 2; a++) {
            sample.surface.gaussian.nayak_alpha = ALPHA[a];
            check_close(translated_summits_expectation(&sample.surface).height_mean,
                        MEAN[a][mirrored], 1e-6);
        }
        sample_clear(&sample);
    }
}

/* Bins close to the bound have summits up to it, none beyond, and flat ones; the density is the
 * derivative of the cumulative one there too, and far in the other tail. */
static void tails_are_stable(void **state) {
    (void)state;
    struct sample sample = sample_make(2, &EXPONENTIAL, 4, false);
    static const struct bins near = {0.99, 1.01, 20}, far = {-30, -20, 20};
    double pdf[20], cdf[20], curvature[20];
    translated_summits_heights(&sample.surface, &near, pdf, cdf, curvature);
    for (size_t b = 0; b < 20; b++) {
        if (b < 10) {
            assert_true(pdf[b] > 0 && curvature[b] > 0 && curvature[b] < 0.1);
            assert_true(b == 0 || (pdf[b] > pdf[b - 1] && curvature[b] < curvature[b - 1]));
            assert_true(b == 0 || fabs(cdf[b] - cdf[b - 1] - pdf[b] * 0.001) < 1e-12);
        } else {
            check_close(pdf[b], 0, 1e-12);
            check_close(cdf[b], 1, 1e-12);
        }
    }
    assert_true(isnan(curvature[15]));
    translated_summits_heights(&sample.surface, &far, pdf, cdf, curvature);
    for (size_t b = 1; b < 20; b++) {
        assert_true(pdf[b] > pdf[b - 1] && curvature[b] > 0 && isfinite(curvature[b]));
        check_relative(cdf[b] - cdf[b - 1], pdf[b] * 0.5, 1e-9);
    }
    sample_clear(&sample);
}

static struct sampled_summits of_grid(const struct sample *sample, enum summit_curvature curvature,
                                      const struct sampled_bins *bins) {
    const struct sampled_surface surface = {
        .modes = sample->modes,
        .moments = &sample->surface.gaussian,
        .stencil = SUMMITS_NINE_POINT,
        .curvature = curvature,
        .translated = &sample->surface,
    };
    struct sampled_summits out;
    assert_int_equal(sampled_summits(&surface, &out, bins, NULL), 0);
    return out;
}

/* Points of a fine grid of a profile are above their neighbours where the profile has its maxima:
 * heights are below those by the square of the spacing, 2e-4 with 128 points a wave. */
static void fine_grids_have_the_same_heights(void **state) {
    (void)state;
    static const struct bins height = {-5, 2, 70};
    double pdf[70], cdf[70], of_bins[70], expected[70], below[70], curvature[70];
    const struct sampled_bins bins = {
        .height = &height, .t1 = &height, .pdf = pdf, .cdf = cdf, .curvature = of_bins};
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        struct sample sample = sample_make(1, &EXPONENTIAL, 128, mirrored == 1);
        struct summit_expectation limit = translated_summits_expectation(&sample.surface);
        struct sampled_summits found = of_grid(&sample, CURVATURE_FINITE_DIFFERENCE, &bins);
        translated_summits_heights(&sample.surface, &height, expected, below, curvature);
        check_relative(found.density, limit.density, 5e-4);
        check_close(found.height_mean, limit.height_mean, 5e-4);
        check_relative(found.height_variance, limit.height_variance, 1e-3);
        check_close(found.height_skewness, limit.height_skewness, 5e-3);
        check_relative(found.height_kurtosis, limit.height_kurtosis, 2e-3);
        check_relative(found.curvature, limit.curvature, 1e-3);
        for (size_t b = 0; b < 70; b++) {
            check_close(pdf[b], expected[b], 5e-3);
            check_close(cdf[b], below[b], 2e-3);
            if (expected[b] > 1e-3)
                check_relative(of_bins[b], curvature[b], 5e-3);
        }
        sample_clear(&sample);
    }
}

/* The identity leaves the theory of a grid as it is. Mean curvatures are interpolated between
 * levels of height, 1e-4, and are sums over a part of the lattice. Of profiles that part is one of
 * two shifts, on which sums agree to 1e-6. Of surfaces it is two of eight, and bins of a hundredth
 * of the mode's summits have some 3e-3 of error. */
static void the_identity_leaves_the_grid(void **state) {
    (void)state;
    static const struct bins height = {-4, 6, 100};
    double pdf[2][100], cdf[2][100], curvature[2][100];
    for (int dimension = 1; dimension <= 2; dimension++) {
        struct sample sample = sample_make(dimension, &GAUSSIAN, 4, false);
        const struct sampled_bins mapped = {.height = &height,
                                            .t1 = &height,
                                            .pdf = pdf[0],
                                            .cdf = cdf[0],
                                            .curvature = curvature[0]};
        const struct sampled_bins plain = {.height = &height,
                                           .t1 = &height,
                                           .pdf = pdf[1],
                                           .cdf = cdf[1],
                                           .curvature = curvature[1]};
        const struct sampled_surface surface = {sample.modes, &sample.surface.gaussian,
                                                SUMMITS_NINE_POINT, CURVATURE_FINITE_DIFFERENCE,
                                                NULL};
        struct sampled_summits expected,
            found = of_grid(&sample, CURVATURE_FINITE_DIFFERENCE, &mapped);
        assert_int_equal(sampled_summits(&surface, &expected, &plain, NULL), 0);
        check_relative(found.density, expected.density, 1e-12);
        check_close(found.height_mean, expected.height_mean, 1e-8);
        check_close(found.height_variance, expected.height_variance, 1e-6);
        check_close(found.height_skewness, expected.height_skewness, 1e-5);
        check_close(found.height_kurtosis, expected.height_kurtosis, 1e-5);
        check_relative(found.curvature, expected.curvature, 4e-4);
        double worst = 0;
        for (size_t b = 0; b < 100; b++) {
            check_close(pdf[0][b], pdf[1][b], 1e-8);
            check_close(cdf[0][b], cdf[1][b], 1e-9);
            if (pdf[1][b] > 1e-3)
                worst = fmax(worst, fabs(curvature[0][b] / curvature[1][b] - 1));
        }
        print_message("mean curvatures within %.1e\n", worst);
        assert_true(worst < (dimension == 1 ? 5e-4 : 1e-2));
        sample_clear(&sample);
    }
}

/* Moments by differences: those of a field that is its own translation are as they were, and those
 * of exponential heights on a grid of 128 points a wave are of the surface. The share of m4 that
 * differences leave out is (k dx)^2/6 at most, 4e-4. */
static void differences_have_their_moments(void **state) {
    (void)state;
    for (int dimension = 1; dimension <= 2; dimension++) {
        struct sample sample = sample_make(dimension, &GAUSSIAN, 4, false);
        struct sampled_moments found, expected;
        struct modes plain = *sample.modes;
        plain.translation = NULL;
        sampled_moments(sample.modes, &found);
        sampled_moments(&plain, &expected);
        check_relative(found.m2, expected.m2, 1e-10);
        check_relative(found.m4, expected.m4, 1e-8);
        check_relative(found.rms_slope, expected.rms_slope, 1e-10);
        check_relative(found.rms_curvature, expected.rms_curvature, 1e-8);
        if (dimension == 2)
            check_relative(found.isotropy, expected.isotropy, 1e-8);
        sample_clear(&sample);
        sample = sample_make(dimension, &EXPONENTIAL, dimension == 1 ? 128 : 32, false);
        double tolerance = dimension == 1 ? 1e-3 : 1e-2;
        sampled_moments(sample.modes, &found);
        check_relative(found.m2, sample.surface.reached.m2, tolerance);
        check_relative(found.m4, sample.surface.reached.m4, tolerance);
        check_relative(found.rms_curvature, sample.surface.reached.rms_curvature, tolerance);
        check_relative(found.nayak_alpha, sample.surface.reached.nayak_alpha, 2 * tolerance);
        assert_true(isnan(found.kurtosis));
        sample_clear(&sample);
    }
}

/* There is no expectation of exact derivatives of a translated surface, and none is made up. */
static void exact_curvatures_have_no_theory_on_a_grid(void **state) {
    (void)state;
    static const struct bins height = {-4, 2, 12};
    double pdf[12], cdf[12], curvature[12];
    const struct sampled_bins bins = {
        .height = &height, .t1 = &height, .pdf = pdf, .cdf = cdf, .curvature = curvature};
    struct sample sample = sample_make(1, &EXPONENTIAL, 8, false);
    struct sampled_summits exact = of_grid(&sample, CURVATURE_SPECTRAL, &bins);
    struct sampled_summits found = of_grid(&sample, CURVATURE_FINITE_DIFFERENCE, NULL);
    assert_true(isnan(exact.curvature) && isfinite(found.curvature));
    assert_true(exact.height_mean == found.height_mean);
    for (size_t b = 0; b < 12; b++)
        assert_true(isnan(curvature[b]) && isfinite(pdf[b]));
    sample_clear(&sample);
}

static void nothing_outside_of_the_domain(void **state) {
    (void)state;
    struct sample sample = sample_make(2, &EXPONENTIAL, 4, false);
    static const struct bins bins = {-2, 0, 4};
    double pdf[4], cdf[4], curvature[4];
    sample.surface.gaussian.nayak_alpha = 1.4;
    assert_true(isnan(translated_summits_expectation(&sample.surface).height_mean));
    translated_summits_heights(&sample.surface, &bins, pdf, cdf, curvature);
    assert_true(isnan(pdf[1]) && isnan(cdf[1]) && isnan(curvature[1]));
    translated_summits_curvatures(&sample.surface, &bins, pdf);
    assert_true(isnan(pdf[1]));
    sample_clear(&sample);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_identity_is_gaussian),
                                       cmocka_unit_test(densities_are_normalised),
                                       cmocka_unit_test(exponential_heights_have_known_summits),
                                       cmocka_unit_test(tails_are_stable),
                                       cmocka_unit_test(fine_grids_have_the_same_heights),
                                       cmocka_unit_test(the_identity_leaves_the_grid),
                                       cmocka_unit_test(differences_have_their_moments),
                                       cmocka_unit_test(exact_curvatures_have_no_theory_on_a_grid),
                                       cmocka_unit_test(nothing_outside_of_the_domain)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
