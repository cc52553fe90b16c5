/* Protects: theory of summits on a grid against closed forms, its own marginals and symmetries, and
 * moments by finite differences against those of a surface. */
#include "core/statistics/heights/roughness.h"
#include "core/surface/surface.h"
#include "core/theory/nayak.h"
#include "core/theory/sampled_field.h"
#include "core/theory/sampled_summits.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

/* A self-affine spectrum of H = 0.8, in cells of 4 longest waves. */
struct sample {
    struct modes *modes;
    struct moments moments;
};

static struct sample sample_make(int dimension, double ratio, size_t points) {
    struct sample sample = {0};
    size_t n = (size_t)(4 * ratio) * points;
    const struct grid grid = {n, dimension == 2 ? n : 1, 4 * ratio, 4 * ratio};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.8,
                                      .wavelength_long = ratio,
                                      .wavelength_rolloff = ratio,
                                      .wavelength_short = 1};
    assert_int_equal(modes_create(&sample.modes, &spectrum, &grid, NULL), 0);
    modes_moments(sample.modes, &sample.moments);
    return sample;
}

static struct sampled_summits law(const struct sample *sample, enum summit_stencil stencil,
                                  enum summit_curvature curvature,
                                  const struct sampled_bins *bins) {
    const struct sampled_surface surface = {sample->modes, &sample->moments, stencil, curvature,
                                            NULL};
    struct sampled_summits out;
    assert_int_equal(sampled_summits(&surface, &out, bins, NULL), 0);
    return out;
}

/* A point is a peak where two normal differences of correlation r are positive: the probability is
 * 1/4 + asin(r)/(2 pi). */
static void peaks_of_profiles(void **state) {
    (void)state;
    for (size_t points = 2; points <= 32; points *= 4) {
        struct sample sample = sample_make(1, 8, points);
        double square = 0, product = 0, step = sample.modes->grid.lx / (double)(32 * points);
        for (size_t m = 1; m <= sample.modes->mode_x; m++) {
            double phase = 2 * M_PI * (double)m / (double)(32 * points);
            double power = modes_power(sample.modes, m, 0) * modes_weight(&sample.modes->grid, m);
            square += power * (2 - 2 * cos(phase));
            product += power * (1 - 2 * cos(phase) + cos(2 * phase));
        }
        double expected = (0.25 + asin(product / square) / (2 * M_PI)) / step;
        struct sampled_summits found =
            law(&sample, SUMMITS_NINE_POINT, CURVATURE_FINITE_DIFFERENCE, NULL);
        check_relative(found.density, expected, 3e-6);
        assert_true(found.density_error < 3e-6);
        modes_destroy(&sample.modes);
    }
}

/* With 64 points a wave: the limits of F8.1, heights and curvatures. */
static void fine_grids_tend_to_their_limits(void **state) {
    (void)state;
    struct sample sample = sample_make(2, 4, 64);
    double nayak = nayak_summit_density(sample.moments.m2, sample.moments.m4);
    struct sampled_summits five = law(&sample, SUMMITS_FIVE_POINT, CURVATURE_SPECTRAL, NULL);
    struct sampled_summits nine = law(&sample, SUMMITS_NINE_POINT, CURVATURE_SPECTRAL, NULL);
    check_close(five.density / nayak, 1.30639, 5e-3); /* m22 of few waves is not that of theory */
    check_close(nine.density / nayak, 1.0103, 5e-3);
    check_relative(nine.curvature, nayak_overall_curvature(), 0.01);
    assert_true(five.density_error < 1e-5 && nine.density_error < 6e-4);
    modes_destroy(&sample.modes);
    sample = sample_make(1, 8, 256);
    struct sampled_summits peaks = law(&sample, SUMMITS_NINE_POINT, CURVATURE_SPECTRAL, NULL);
    struct summit_expectation expected =
        summit_expectation(1, sample.moments.m2, sample.moments.m4, sample.moments.nayak_alpha);
    check_relative(peaks.density, expected.density, 1e-4);
    check_relative(peaks.height_mean, expected.height_mean, 1e-4);
    check_relative(peaks.height_variance, expected.height_variance, 1e-4);
    check_close(peaks.height_skewness, expected.height_skewness, 1e-4);
    check_close(peaks.height_kurtosis, expected.height_kurtosis, 1e-4);
    check_relative(peaks.curvature, expected.curvature, 1e-4);
    modes_destroy(&sample.modes);
}

enum { HEIGHTS = 48, T1 = 40 };
static const struct bins HEIGHT_BINS = {-5, 7, HEIGHTS}, T1_BINS = {-12, 0, T1};
struct histograms {
    double pdf[HEIGHTS], cdf[HEIGHTS], curvature[HEIGHTS], t1[T1], joint[HEIGHTS * T1];
};

/* Of densities over the bins of heights, as they come out, and over those of t1. */
static void check_marginals(const struct histograms *h, const struct sampled_summits *all,
                            double curvature_unit) {
    double width = bins_width(&HEIGHT_BINS), t1_width = bins_width(&T1_BINS);
    double mean = 0, curvature = 0, t1_mean = 0, sum = 0;
    for (size_t b = 0; b < HEIGHTS; b++) {
        double row = 0;
        for (size_t column = 0; column < T1; column++)
            row += h->joint[b * T1 + column] * t1_width;
        check_close(row, h->pdf[b], 2e-3);
        sum += h->pdf[b] * width;
        check_close(h->cdf[b], sum, 1e-6);
        mean += h->pdf[b] * width * bins_centre(&HEIGHT_BINS, b);
        curvature += h->pdf[b] > 1e-9 ? h->pdf[b] * width * h->curvature[b] : 0;
    }
    for (size_t column = 0; column < T1; column++) {
        double sum_of_column = 0;
        for (size_t b = 0; b < HEIGHTS; b++)
            sum_of_column += h->joint[b * T1 + column] * width;
        check_close(sum_of_column, h->t1[column], 1e-6);
        t1_mean += h->t1[column] * t1_width * bins_centre(&T1_BINS, column);
    }
    check_close(sum, 1, 1e-6);
    check_close(mean, all->height_mean, 2e-3); /* bins are wide */
    check_close(curvature, all->curvature, 1e-6);
    check_close(-t1_mean / curvature_unit, all->curvature, 1e-2);
}

static void densities_have_their_marginals(void **state) {
    (void)state;
    struct histograms *h = malloc(sizeof *h);
    assert_non_null(h);
    const struct sampled_bins bins = {&HEIGHT_BINS, &T1_BINS, h->pdf,  h->cdf,
                                      h->curvature, h->t1,    h->joint};
    for (int dimension = 1; dimension <= 2; dimension++) {
        struct sample sample = sample_make(dimension, 6, 4);
        for (int stencil = SUMMITS_NINE_POINT; stencil <= SUMMITS_FIVE_POINT; stencil++)
            for (int curvature = 0; curvature <= CURVATURE_SPECTRAL; curvature++) {
                struct sampled_summits all = law(&sample, (enum summit_stencil)stencil,
                                                 (enum summit_curvature)curvature, &bins);
                check_marginals(h, &all, dimension == 1 ? 1 : sqrt(3));
            }
        modes_destroy(&sample.modes);
    }
    free(h);
}

/* One wave along x and one along y: one summit a cell, whatever is compared. */
static void four_modes_have_one_summit(void **state) {
    (void)state;
    const struct grid grid = {12, 12, 3, 3};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.5,
                                      .wavelength_long = 3,
                                      .wavelength_rolloff = 3,
                                      .wavelength_short = 3};
    struct sample sample = {0};
    assert_int_equal(modes_create(&sample.modes, &spectrum, &grid, NULL), 0);
    modes_moments(sample.modes, &sample.moments);
    for (int stencil = SUMMITS_NINE_POINT; stencil <= SUMMITS_FIVE_POINT; stencil++) {
        struct sampled_summits found =
            law(&sample, (enum summit_stencil)stencil, CURVATURE_FINITE_DIFFERENCE, NULL);
        check_close(found.density * 9, 1, 1e-5);
        /* its height is the sum of two Rayleigh amplitudes, seen at the nearest point */
        assert_true(found.height_mean > 0.9 * sqrt(M_PI) && found.height_mean < sqrt(M_PI));
    }
    modes_destroy(&sample.modes);
}

/* x and y may be exchanged. */
static void axes_are_alike(void **state) {
    (void)state;
    const struct grid grid = {64, 64, 16, 16};
    double density[2], curvature[2], error = 0;
    for (int way = 0; way < 2; way++) {
        const struct spectrum spectrum = {.type = SPECTRUM_EXPONENTIAL_ACF,
                                          .correlation_x = way == 0 ? 1 : 3,
                                          .correlation_y = way == 0 ? 3 : 1};
        struct sample sample = {0};
        assert_int_equal(modes_create(&sample.modes, &spectrum, &grid, NULL), 0);
        modes_moments(sample.modes, &sample.moments);
        struct sampled_summits found =
            law(&sample, SUMMITS_NINE_POINT, CURVATURE_FINITE_DIFFERENCE, NULL);
        density[way] = found.density;
        curvature[way] = found.curvature;
        error = hypot(error, found.density_error);
        modes_destroy(&sample.modes);
    }
    assert_true(error < 5e-3); /* rough: neighbours know less of each other */
    check_relative(density[0], density[1], 4 * error);
    check_relative(curvature[0], curvature[1], 4 * error);
}

static void refined_summits_are_refused(void **state) {
    (void)state;
    struct sample sample = sample_make(2, 2, 4);
    const struct sampled_surface surface = {sample.modes, &sample.moments, SUMMITS_REFINED,
                                            CURVATURE_SPECTRAL, NULL};
    struct sampled_summits out = {.density = 42};
    struct error err = {0};
    assert_int_equal(sampled_summits(&surface, &out, NULL, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "refined"));
    assert_true(out.density == 42);
    modes_destroy(&sample.modes);
}

/* Amplitudes are fixed, so that one surface has these moments to rounding; the kurtosis is a mean.
 */
static void moments_are_those_of_surfaces(void **state) {
    (void)state;
    enum { SURFACES = 1000 };
    for (int dimension = 1; dimension <= 2; dimension++) {
        struct sample sample = sample_make(dimension, 2, 4);
        const struct grid *grid = &sample.modes->grid;
        const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                          .hurst = 0.8,
                                          .wavelength_long = 2,
                                          .wavelength_rolloff = 2,
                                          .wavelength_short = 1};
        struct generator *generator = NULL;
        struct sampled_moments expected;
        struct roughness found;
        double *z = malloc(grid_points(grid) * sizeof *z), sum = 0, squares = 0;
        assert_non_null(z);
        assert_int_equal(generator_create(&generator, &spectrum, grid, &SURFACE_DEFAULTS, NULL), 0);
        sampled_moments(sample.modes, &expected);
        for (uint64_t r = 0; r < SURFACES; r++) {
            const struct random_key key = {5, 0, r};
            assert_int_equal(generator_run(generator, key, z, NULL, NULL), 0);
            roughness_measure(grid, z, &found);
            check_relative(found.rms_slope, expected.rms_slope, 1e-12);
            check_relative(found.rms_curvature, expected.rms_curvature, 1e-12);
            check_relative(found.m2, expected.m2, 1e-12);
            check_relative(found.m4, expected.m4, 1e-12);
            check_relative(found.nayak_alpha, expected.nayak_alpha, 1e-12);
            sum += found.kurtosis / SURFACES;
            squares += found.kurtosis * found.kurtosis / SURFACES;
        }
        double error = sqrt((squares - sum * sum) / (SURFACES - 1));
        assert_true(3 - expected.kurtosis > 4 * error); /* far from that of endless surfaces */
        check_close(sum, expected.kurtosis, 4 * error);
        generator_destroy(&generator);
        free(z);
        modes_destroy(&sample.modes);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(peaks_of_profiles),
        cmocka_unit_test(fine_grids_tend_to_their_limits),
        cmocka_unit_test(densities_have_their_marginals),
        cmocka_unit_test(four_modes_have_one_summit),
        cmocka_unit_test(axes_are_alike),
        cmocka_unit_test(refined_summits_are_refused),
        cmocka_unit_test(moments_are_those_of_surfaces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
