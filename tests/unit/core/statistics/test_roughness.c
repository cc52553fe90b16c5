/* Protects: parameters of height maps, by finite differences with the reference's bias, from the
 * spectrum exactly; spectra and correlations against sums written out. */
#include "core/statistics/heights/roughness.h"
#include "core/surface/surface.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdlib.h>

static double *surface(const struct grid *grid, double ratio, struct generator **generator) {
    struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                .hurst = 0.8,
                                .wavelength_long = ratio,
                                .wavelength_rolloff = ratio,
                                .wavelength_short = 1};
    double *z = malloc(grid_points(grid) * sizeof *z);
    assert_non_null(z);
    assert_int_equal(generator_create(generator, &spectrum, grid, &SURFACE_DEFAULTS, NULL), 0);
    assert_int_equal(generator_run(*generator, (struct random_key){7, 0, 0}, z, NULL, NULL), 0);
    return z;
}

/* F1.3: m2 and m4 by differences over their spectral values at 4, 8, 16 points a wave; three
 * digits. */
static void differences_have_their_bias(void **state) {
    (void)state;
    static const double M2[] = {0.957, 0.989, 0.997}, M4[] = {0.832, 0.954, 0.988};
    for (size_t p = 0; p < 3; p++) {
        size_t n = (size_t)256 << p;
        struct grid grid = {n, n, 64, 64};
        struct generator *generator = NULL;
        struct roughness measured;
        struct moments exact;
        double *z = surface(&grid, 8, &generator);
        modes_moments(generator_modes(generator), &exact);
        roughness_measure(&grid, z, &measured);
        check_close(measured.m2 / exact.m2, M2[p], 5e-4);
        check_close(measured.m4 / exact.m4, M4[p], 5e-4);
        check_relative(measured.rms_height, 1, 1e-12);
        generator_destroy(&generator);
        free(z);
    }
}

static void spectral_moments_are_exact(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {
        {64, 64, 16, 16}, {65, 63, 16, 16}, {128, 32, 32, 8}, {256, 1, 32, 1}};
    for (size_t g = 0; g < 4; g++) {
        struct generator *generator = NULL;
        struct moments measured, exact;
        double *z = surface(&GRIDS[g], 2, &generator);
        modes_moments(generator_modes(generator), &exact);
        assert_int_equal(roughness_spectral(&GRIDS[g], z, &measured, NULL), 0);
        check_relative(measured.m00, exact.m00, 1e-12);
        check_relative(measured.m20, exact.m20, 1e-12);
        check_relative(measured.m40, exact.m40, 1e-12);
        check_relative(measured.nayak_alpha, exact.nayak_alpha, 1e-12);
        generator_destroy(&generator);
        free(z);
    }
}

static void hand_made_profile(void **state) {
    (void)state;
    const struct grid grid = {4, 1, 8, 1}; /* dx = 2 */
    const double z[] = {1, 3, 1, -1};
    struct roughness r;
    roughness_measure(&grid, z, &r);
    check_close(r.mean, 1, 1e-15);
    check_close(r.rms_height, sqrt(2), 1e-15);
    check_close(r.rms_slope, 1, 1e-15);             /* four steps of 2 over 2 */
    check_close(r.rms_curvature, sqrt(0.5), 1e-15); /* second differences 0, -4, 0, 4 over 4 */
    check_close(r.skewness, 0, 1e-15);
    check_close(r.kurtosis, 2, 1e-15);
    assert_true(r.lowest == -1 && r.highest == 3);
}

static void flat_map_has_no_shape(void **state) {
    (void)state;
    const struct grid grid = {8, 8, 1, 1};
    double z[64];
    struct roughness r;
    for (size_t p = 0; p < 64; p++)
        z[p] = 5;
    roughness_measure(&grid, z, &r);
    assert_true(r.rms_height == 0 && r.rms_slope == 0 && isnan(r.skewness) && isnan(r.kurtosis));
}

static void correlation_is_the_sum(void **state) {
    (void)state;
    static const struct grid GRIDS[] = {{32, 1, 4, 1}, {33, 1, 4, 1}};
    for (size_t g = 0; g < 2; g++) {
        size_t n = GRIDS[g].nx;
        struct generator *generator = NULL;
        double *z = surface(&GRIDS[g], 1, &generator), lag[17], correlation[17], again[17],
               variance = 0;
        assert_int_equal(acf_measure(&GRIDS[g], z, lag, correlation, NULL), 0);
        assert_int_equal(acf_of_modes(generator_modes(generator), lag, again, NULL), 0);
        for (size_t i = 0; i < n; i++)
            variance += z[i] * z[i];
        for (size_t r = 0; r < n / 2 + 1; r++) {
            double sum = 0;
            for (size_t i = 0; i < n; i++)
                sum += z[i] * z[(i + r) % n];
            check_close(correlation[r], sum / variance, 1e-13);
            check_close(again[r], correlation[r], 1e-13);
            check_close(lag[r], 4.0 * (double)r / (double)n, 1e-15);
        }
        generator_destroy(&generator);
        free(z);
    }
}

/* On a rectangular cell, odd and even sides, the correlation is the mean over rings one dx wide, as
 * far as these lie within the cell. ratio: dy/dx, with no lag on the edge of a ring. */
static void check_ring_means(double ratio, size_t expected) {
    enum { NX = 15, NY = 12, LAGS = NX / 2 + 1 };
    const struct grid grid = {NX, NY, 3, 0.2 * ratio * NY}; /* dx = 0.2 */
    double z[NX * NY], lag[LAGS], correlation[LAGS], mean = 0;
    double sums[LAGS] = {0}, counts[LAGS] = {0};
    uint64_t seed = seed_or(5);
    for (size_t p = 0; p < (size_t)NX * NY; p++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        z[p] = (double)(seed >> 40);
        mean += z[p] / (NX * NY);
    }
    for (long b = -5; b <= NY / 2; b++) /* each lag of the torus once */
        for (long a = -7; a <= NX / 2; a++) {
            size_t ring = (size_t)(hypot((double)a, ratio * (double)b) + 0.5);
            if (ring >= LAGS)
                continue;
            counts[ring]++;
            for (long j = 0; j < NY; j++)
                for (long i = 0; i < NX; i++)
                    sums[ring] += (z[j * NX + i] - mean) *
                                  (z[(j + b + NY) % NY * NX + (i + a + NX) % NX] - mean);
        }
    assert_int_equal(acf_lags(&grid), expected);
    assert_int_equal(acf_measure(&grid, z, lag, correlation, NULL), 0);
    for (size_t r = 0; r < expected; r++) {
        check_close(lag[r], 0.2 * (double)r, 1e-15);
        check_close(correlation[r], sums[r] / counts[r] / sums[0], 1e-12);
    }
}

static void correlation_of_a_surface_is_the_ring_mean(void **state) {
    (void)state;
    check_ring_means(1.37, 8);
    check_ring_means(0.63, 4);
}

/* The density over its rings adds up to the mean square height. */
static void density_integrates_to_m00(void **state) {
    (void)state;
    const struct grid grid = {64, 64, 16, 16};
    struct generator *generator = NULL;
    double *z = surface(&grid, 2, &generator), sum = 0;
    size_t bins = radial_bins(&grid);
    double *k = malloc(bins * sizeof *k), *density = malloc(bins * sizeof *density);
    double *again = malloc(bins * sizeof *again);
    assert_true(k && density && again);
    assert_int_equal(psd_measure(&grid, z, k, density, NULL), 0);
    psd_of_modes(generator_modes(generator), k, again);
    for (size_t r = 0; r < bins; r++) {
        size_t modes = 0; /* of ring r on this grid */
        for (long my = -31; my <= 32; my++)
            for (long mx = -31; mx <= 32; mx++)
                modes += (size_t)(hypot((double)mx, (double)my) + 0.5) == r;
        sum += density[r] * (double)modes * pow(2 * M_PI / 16, 2);
        check_close(again[r], density[r], 1e-12);
    }
    check_relative(sum, 1, 1e-12);
    generator_destroy(&generator);
    free(z);
    free(k);
    free(density);
    free(again);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(differences_have_their_bias),
        cmocka_unit_test(spectral_moments_are_exact),
        cmocka_unit_test(hand_made_profile),
        cmocka_unit_test(flat_map_has_no_shape),
        cmocka_unit_test(correlation_is_the_sum),
        cmocka_unit_test(correlation_of_a_surface_is_the_ring_mean),
        cmocka_unit_test(density_integrates_to_m00),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
