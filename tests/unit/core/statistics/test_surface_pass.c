/* One pass over a surface finds and counts what its parts find and count one after the other:
 * counts and summits to the bit, sums to rounding. */
#include "core/statistics/heights/roughness.h"
#include "core/statistics/surface_pass.h"
#include "core/surface/surface.h"
#include "core/theory/sampled_field.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdlib.h>

/* 96 rows of 640 points are two strips; heights in steps, so that there are plateaus and ties, or a
 * surface. */
static const struct grid GRIDS[] = {{640, 96, 20, 3}, {64, 64, 8, 8}, {4096, 1, 64, 0}};
enum { GRID_COUNT = 3, POINTS_MOST = 640 * 96 };

static double *heights(uint64_t seed, uint64_t steps) {
    double *z = malloc(POINTS_MOST * sizeof *z);
    assert_non_null(z);
    for (size_t a = 0; a < POINTS_MOST; a++)
        z[a] = (double)(next_word(&seed) % steps) / (double)steps - 0.4;
    return z;
}

static void assert_same(const struct summit_list *a, const struct summit_list *b) {
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->summits, b->summits, a->count * sizeof *a->summits);
}

static void check_pass(const struct grid *grid, const double *z, enum summit_stencil stencil,
                       enum summit_curvature curvature) {
    const struct bins bins = {-0.3, 0.5, 37};
    uint64_t counts[39] = {0}, expected[39] = {0};
    struct summit_finder *finder = NULL;
    struct summit_list summits = {0}, pits = {0}, list = {0};
    struct height_sums sums;
    struct roughness roughness;
    assert_int_equal(
        summit_finder_create(&finder, grid, stencil, curvature, grid->nx / 2, grid->ny / 2, NULL),
        0);
    const struct surface_pass pass = {.finder = finder,
                                      .bins = &bins,
                                      .scale = 1.1,
                                      .counts = counts,
                                      .sums = &sums,
                                      .summits = &summits,
                                      .pits = &pits};
    assert_int_equal(surface_pass_run(&pass, grid, z, NULL), 0);
    assert_int_equal(summits_find(finder, z, &list, NULL), 0);
    assert_true(list.count > 0);
    assert_same(&summits, &list);
    assert_int_equal(pits_find(finder, z, &list, NULL), 0);
    assert_same(&pits, &list);
    for (size_t a = 0; a < grid_points(grid); a++)
        expected[bins_find(&bins, 1.1 * z[a])]++;
    assert_memory_equal(counts, expected, sizeof counts);
    roughness_measure(grid, z, &roughness);
    assert_true(sums.lowest == roughness.lowest && sums.highest == roughness.highest);
    summit_list_clear(&summits);
    summit_list_clear(&pits);
    summit_list_clear(&list);
    summit_finder_destroy(&finder);
}

static void parts_are_found_together(void **state) {
    (void)state;
    const uint64_t steps[] = {7, 1000000};
    for (size_t s = 0; s < 2; s++) {
        double *z = heights(seed_or(5), steps[s]);
        for (size_t g = 0; g < GRID_COUNT; g++)
            for (int stencil = SUMMITS_NINE_POINT; stencil <= SUMMITS_FIVE_POINT; stencil++)
                for (int curvature = 0; curvature < 2; curvature++)
                    check_pass(&GRIDS[g], z, (enum summit_stencil)stencil,
                               (enum summit_curvature)curvature);
        check_pass(&GRIDS[1], z, SUMMITS_REFINED, CURVATURE_SPECTRAL);
        free(z);
    }
}

/* Edges, infinities and NaN fall where bins_find puts them, with few bins and with many. */
static void histograms_count_as_bins_find(void **state) {
    (void)state;
    const size_t bin_counts[] = {1, 3, 240, 1022, 1023, 5000};
    uint64_t seed = seed_or(8), counts[5002], expected[5002];
    double values[1000];
    for (size_t c = 0; c < sizeof bin_counts / sizeof *bin_counts; c++) {
        const struct bins bins = {-4, 8, bin_counts[c]};
        for (size_t a = 0; a < 1000; a++)
            values[a] = a % 3 == 0 ? bins.low + (double)(next_word(&seed) % (bins.count + 1)) *
                                                    bins_width(&bins)
                                   : (double)(next_word(&seed) % 1600) / 100 - 6;
        values[0] = -INFINITY;
        values[1] = INFINITY;
        values[2] = NAN;
        values[3] = bins.high;
        values[4] = nextafter(bins.high, 9);
        values[5] = nextafter(bins.low, -9);
        values[6] = 1e300;
        for (size_t n = 993; n <= 1000; n++) {
            for (size_t b = 0; b < bins.count + 2; b++)
                counts[b] = expected[b] = b;
            histogram_add(&bins, n, values, 1, counts);
            for (size_t a = 0; a < n; a++)
                expected[bins_find(&bins, values[a])]++;
            assert_memory_equal(counts, expected, (bins.count + 2) * sizeof *counts);
        }
    }
}

/* Moments by finite differences from the spectrum are those found on a surface, and powers about 0
 * are those about the mean; spectra with and without waves at the end of the grid's band. */
static void the_spectrum_tells_the_roughness(void **state) {
    (void)state;
    const struct spectrum spectra[] = {
        {.type = SPECTRUM_SELF_AFFINE,
         .hurst = 0.4,
         .wavelength_long = 8,
         .wavelength_rolloff = 8,
         .wavelength_short = 1},
        {.type = SPECTRUM_EXPONENTIAL_ACF, .correlation_x = 0.5, .correlation_y = 0.5}};
    const struct grid grids[] = {{128, 128, 16, 16}, {256, 1, 32, 0}};
    double *z = heights(1, 2);
    for (size_t g = 0; g < 2; g++)
        for (size_t s = 0; s < 2; s++) {
            struct generator *generator = NULL;
            struct roughness found;
            struct sampled_moments told;
            struct moments moments;
            assert_int_equal(
                generator_create(&generator, &spectra[s], &grids[g], &SURFACE_DEFAULTS, NULL), 0);
            assert_int_equal(generator_run(generator, (struct random_key){4, 0, 0}, z, NULL, NULL),
                             0);
            modes_moments(generator_modes(generator), &moments);
            sampled_moments(generator_modes(generator), &told);
            roughness_measure(&grids[g], z, &found);
            check_relative(moments.rms_height, found.rms_height, 1e-12);
            check_relative(told.rms_slope, found.rms_slope, 1e-12);
            check_relative(told.rms_curvature, found.rms_curvature, 1e-12);
            check_relative(told.m2, found.m2, 1e-12);
            check_relative(told.m4, found.m4, 1e-12);
            check_relative(told.nayak_alpha, found.nayak_alpha, 1e-12);
            generator_destroy(&generator);
        }
    free(z);
}

/* 1e-11: rounding of the plain sums of 61440 terms. */
static void powers_of_heights(void **state) {
    (void)state;
    double *z = heights(seed_or(6), 1 << 20), third = 0, fourth = 0;
    const struct bins bins = {-1, 1, 2};
    uint64_t counts[4] = {0};
    struct summit_finder *finder = NULL;
    struct summit_list summits = {0}, pits = {0};
    struct height_sums sums;
    assert_int_equal(summit_finder_create(&finder, &GRIDS[0], SUMMITS_FIVE_POINT,
                                          CURVATURE_FINITE_DIFFERENCE, 1, 1, NULL),
                     0);
    const struct surface_pass pass = {finder, &bins, 1, counts, &sums, &summits, &pits};
    assert_int_equal(surface_pass_run(&pass, &GRIDS[0], z, NULL), 0);
    for (size_t a = 0; a < POINTS_MOST; a++) {
        third += z[a] * z[a] * z[a] / POINTS_MOST;
        fourth += z[a] * z[a] * z[a] * z[a] / POINTS_MOST;
    }
    check_relative(sums.third, third, 1e-11);
    check_relative(sums.fourth, fourth, 1e-11);
    summit_list_clear(&summits);
    summit_list_clear(&pits);
    summit_finder_destroy(&finder);
    free(z);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_are_found_together),
        cmocka_unit_test(histograms_count_as_bins_find),
        cmocka_unit_test(the_spectrum_tells_the_roughness),
        cmocka_unit_test(powers_of_heights),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
