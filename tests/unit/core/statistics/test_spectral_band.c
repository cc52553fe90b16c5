/* Protects: what is measured of the spectra of a band, one after the other, is what the functions
 * for a single spectrum find, whatever the sides of the grid and however full it is. */
#include "core/statistics/spectra/spectral_band.h"
#include "core/theory/sampled_field.h"
#include "tests/support/check.h"
#include "tests/support/seed.h"
#include <stdlib.h>
#include <string.h>

enum { POINTS_MOST = 96 * 96 };

static const struct band_case {
    struct grid grid;
    size_t mode_x, mode_y;
} CASES[] = {
    {{64, 64, 16, 16}, 16, 16}, {{64, 64, 16, 16}, 32, 32}, /* a square, full */
    {{45, 45, 9, 9}, 9, 9},     {{96, 40, 24, 10}, 23, 9},  /* odd sides; rectangles */
    {{33, 58, 8, 14}, 8, 14},   {{64, 64, 16, 8}, 16, 12},  /* spacings that differ */
    {{32, 4, 8, 1}, 7, 2},      {{4, 32, 1, 8}, 2, 15},     /* strips */
    {{2, 2, 1, 1}, 1, 1},       {{256, 1, 32, 1}, 32, 0},   /* profiles */
    {{257, 1, 32, 1}, 128, 0},  {{256, 1, 32, 1}, 128, 0},
};

static double next_power(uint64_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return *seed >> 62 == 0 ? 0 : (double)(*seed >> 11) * 0x1p-53;
}

/* Random powers, unlike at (mx, my) and (mx, -my) but where these are one wave. A quarter is 0. */
static struct modes spectrum_of(const struct band_case *one, uint64_t *seed) {
    size_t rows = 2 * one->mode_y + 1;
    struct modes modes = {.grid = one->grid, .mode_x = one->mode_x, .mode_y = one->mode_y};
    modes.power = calloc((one->mode_x + 1) * rows, sizeof *modes.power);
    assert_non_null(modes.power);
    for (size_t mx = 0; mx <= one->mode_x; mx++)
        for (size_t my = 0; my <= one->mode_y; my++) {
            double *at = modes.power + mx * rows + one->mode_y;
            at[my] = mx == 0 && my == 0 ? 0 : next_power(seed);
            if (my > 0 && 2 * my != one->grid.ny)
                at[-(ptrdiff_t)my] = modes_weight(&one->grid, mx) == 1 ? at[my] : next_power(seed);
        }
    modes.power[(one->mode_x + 1) * rows - 1] = 1; /* some power in any case */
    return modes;
}

/* 14 digits: sums of some thousands of terms, in another order. Moments of odd powers cancel, and
 * are compared with the even ones. */
static void check_moments(const struct spectral_band *band, const struct modes *modes) {
    struct moments moments, expected;
    struct roughness found;
    struct sampled_moments sampled;
    modes_moments(modes, &expected);
    sampled_moments(modes, &sampled);
    spectral_band_moments(band, modes, &moments, &found);
    double sixth = 1e-14 * (expected.m40 + expected.m04);
    check_relative(moments.m0, expected.m0, 1e-14);
    check_relative(moments.m2, expected.m2, 1e-14);
    check_relative(moments.m4, expected.m4, 1e-14);
    check_relative(moments.nayak_alpha, expected.nayak_alpha, 1e-13);
    check_relative(moments.rms_slope, expected.rms_slope, 1e-14);
    check_relative(moments.rms_curvature, expected.rms_curvature, 1e-14);
    check_close(moments.m11, expected.m11, 1e-14 * (expected.m20 + expected.m02));
    check_close(moments.m22, expected.m22, sixth);
    check_close(moments.m31, expected.m31, sixth);
    check_close(moments.m13, expected.m13, sixth);
    check_relative(found.rms_height, expected.rms_height, 1e-14);
    check_relative(found.rms_slope, sampled.rms_slope, 1e-14);
    check_relative(found.rms_curvature, sampled.rms_curvature, 1e-14);
    check_relative(found.m2, sampled.m2, 1e-14);
    check_relative(found.m4, sampled.m4, 1e-14);
    check_relative(found.nayak_alpha, sampled.nayak_alpha, 1e-13);
    assert_true(found.mean == 0 && isnan(found.skewness) && isnan(found.lowest));
}

/* The correlation is at most 1, and a transform loses some 1e-16 of that. */
static void check_rings(struct spectral_band *band, const struct modes *modes) {
    const struct grid *grid = &modes->grid;
    static double abscissa[POINTS_MOST], expected[POINTS_MOST], found[POINTS_MOST];
    psd_of_modes(modes, abscissa, expected);
    spectral_band_density(band, modes, found);
    assert_memory_equal(found, expected, radial_bins(grid) * sizeof *found);
    assert_int_equal(acf_of_modes(modes, abscissa, expected, NULL), 0);
    spectral_band_correlation(band, modes, found);
    for (size_t r = 0; r < acf_lags(grid); r++)
        check_close(found[r], expected[r], 1e-14);
    assert_true(found[0] == 1);
}

static void a_band_measures_each_of_its_spectra(void **state) {
    (void)state;
    uint64_t seed = seed_or(11);
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        const struct band_case *one = &CASES[c];
        struct spectral_band *band = NULL;
        assert_int_equal(spectral_band_create(&band, &one->grid, one->mode_x, one->mode_y, NULL),
                         0);
        assert_true(spectral_band_bytes(&one->grid, one->mode_x, one->mode_y) > 0);
        for (int again = 0; again < 3; again++) { /* no trace of those before */
            struct modes modes = spectrum_of(one, &seed);
            check_moments(band, &modes);
            check_rings(band, &modes);
            free(modes.power);
        }
        spectral_band_destroy(&band);
        assert_null(band);
    }
}

/* Bins share out all waves of the full plane, of even and of odd sides. */
static void bins_count_all_waves(void **state) {
    (void)state;
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        const struct grid *grid = &CASES[c].grid;
        static double count[POINTS_MOST];
        double all = 0;
        radial_counts(grid, count);
        for (size_t r = 0; r < radial_bins(grid); r++)
            all += count[r];
        assert_true(all == (double)grid_points(grid));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_band_measures_each_of_its_spectra),
        cmocka_unit_test(bins_count_all_waves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
