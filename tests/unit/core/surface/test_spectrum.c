/* Protects: discrete spectra and their moments, the Nayak parameter and its inverses, and the words
 * for input that is out of range. */
#include "core/surface/spectrum.h"
#include "tests/support/check.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct spectrum self_affine(double hurst, double ratio) {
    return (struct spectrum){.type = SPECTRUM_SELF_AFFINE,
                             .hurst = hurst,
                             .wavelength_long = ratio,
                             .wavelength_rolloff = ratio,
                             .wavelength_short = 1};
}

/* Returns alpha of a cell of 8 longest waves, whose isotropy differs from 1 by at most this. */
static double alpha_within(double hurst, double ratio, double anisotropy) {
    size_t n = 2 * (size_t)(32 * ratio + 1);
    struct grid grid = {n, n, 8 * ratio, 8 * ratio};
    struct spectrum spectrum = self_affine(hurst, ratio);
    struct modes *modes = NULL;
    struct moments moments;
    assert_int_equal(modes_create(&modes, &spectrum, &grid, NULL), 0);
    modes_moments(modes, &moments);
    check_relative(moments.m00, 1, 1e-14);
    check_relative(3 * moments.m22, moments.m4, anisotropy);
    modes_destroy(&modes);
    return moments.nayak_alpha;
}

static double alpha_of(double hurst, double ratio) {
    return alpha_within(hurst, ratio, 0.02);
}

/* Table 3.1 of the reference and its H = 0.2 cases, in the four digits of F2.6. */
static void discrete_alpha(void **state) {
    (void)state;
    static const double RATIOS[] = {8, 16, 32, 64}, ALPHAS[] = {5.3368, 11.8862, 29.1068, 75.8794};
    for (size_t r = 0; r < 4; r++)
        check_close(alpha_of(0.8, RATIOS[r]), ALPHAS[r], 5e-5);
    check_close(alpha_of(0.2, 8), 3.7617, 5e-5);
    check_close(alpha_of(0.2, 16), 5.6087, 5e-5);
}

static void continuous_alpha(void **state) {
    (void)state;
    static const double RATIOS[] = {8, 16, 32, 64, 128};
    static const double ALPHAS[] = {5.2277, 11.5992, 28.3264, 73.7299, 200.3832};
    for (size_t r = 0; r < 5; r++)
        check_close(spectrum_alpha_continuous(2, 0.8, RATIOS[r], 1), ALPHAS[r], 5e-5);
    check_close(spectrum_alpha_continuous(2, 0.8, 16, 2), 7.396412562, 5e-10);
    check_close(spectrum_alpha_continuous(1, 0.8, 16, 2), 5.385274454, 5e-10);
    /* continuous in H through the exponents that vanish */
    for (double hurst = 0; hurst <= 1; hurst++) {
        double inside = hurst == 0 ? 1e-9 : 1 - 1e-9;
        check_relative(spectrum_alpha_continuous(2, hurst, 16, 1),
                       spectrum_alpha_continuous(2, inside, 16, 1), 1e-7);
    }
    assert_true(isnan(spectrum_alpha_continuous(2, 0.8, 0.5, 1)));
    assert_true(isnan(spectrum_alpha_continuous(3, 0.8, 8, 1)));
    check_relative(spectrum_alpha_continuous(2, 0.8, 1, 1), 1.5, 1e-12);
}

/* Table 3.5 of the reference, four digits. */
static void ratios_of_given_alpha(void **state) {
    (void)state;
    static const double HURST[] = {0.4, 0.6, 0.8};
    static const double RATIOS[3][3] = {
        {9.7515, 23.0577, 37.9214}, {8.3084, 16.5381, 24.1261}, {7.6687, 14.1626, 19.6607}};
    for (size_t h = 0; h < 3; h++)
        for (size_t a = 0; a < 3; a++) {
            double ratio, reached, alpha = 5 * (double)(a + 1);
            assert_int_equal(spectrum_ratio_continuous(2, HURST[h], 1, alpha, &ratio, NULL), 0);
            check_close(ratio, RATIOS[h][a], 5.1e-5);
            assert_int_equal(
                spectrum_ratio_discrete(2, HURST[h], 1, 8, alpha, &ratio, &reached, NULL), 0);
            check_close(reached, alpha, 0.005); /* half a step of the staircase */
            check_close(alpha_of(HURST[h], ratio), reached, 1e-6);
        }
}

/* Near 3/2 the first rings, of four and twelve modes, have larger values of alpha than many rings
 * together, and were taken for surfaces. */
static void small_alpha_is_that_of_isotropic_surfaces(void **state) {
    (void)state;
    double ratio, reached, last = 1;
    for (double alpha = 1.52; alpha < 2.5; alpha += 0.02) {
        assert_int_equal(spectrum_ratio_discrete(2, 0.8, 1, 8, alpha, &ratio, &reached, NULL), 0);
        check_relative(reached, alpha, 0.01);
        check_relative(alpha_within(0.8, ratio, 0.1), reached, 1e-6);
        assert_true(ratio >= last);
        last = ratio;
    }
    /* in short cells not the first ring beyond alpha is near, but a later one */
    static const double SHORT[][3] = {
        {3, 0.2, 1.72}, {4, 0.2, 1.715}, {2, 0.8, 2.26}, {1, 0.2, 3.72}};
    for (size_t c = 0; c < sizeof SHORT / sizeof *SHORT; c++) {
        assert_int_equal(spectrum_ratio_discrete(2, SHORT[c][1], 1, SHORT[c][0], SHORT[c][2],
                                                 &ratio, &reached, NULL),
                         0);
        check_relative(reached, SHORT[c][2], 0.01);
    }
}

/* Back from alpha to the exponent that gave it: profiles, squares, rectangles, a plateau, and more
 * rings than are visited singly. */
static void hurst_of_given_alpha(void **state) {
    (void)state;
    static const struct {
        int dimension;
        double hurst, ratio, rolloff, length_x, length_y;
    } CASES[] = {{2, 0.8, 8, 1, 8, 8},  {2, 0.2, 16, 2, 8, 8},    {1, 0.5, 32, 1, 4, 4},
                 {2, 0.6, 8, 1, 3, 12}, {2, 0.99, 40, 1.5, 8, 8}, {2, 0.05, 8, 1, 4, 4}};
    struct error err = {0};
    double hurst;
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        double x = CASES[c].length_x * CASES[c].ratio, y = CASES[c].length_y * CASES[c].ratio;
        struct spectrum spectrum = self_affine(CASES[c].hurst, CASES[c].ratio);
        struct moments moments;
        size_t nx = 4 * (size_t)x, ny = CASES[c].dimension == 2 ? 4 * (size_t)y : 1;
        spectrum.wavelength_rolloff = CASES[c].ratio / CASES[c].rolloff;
        const struct grid grid = {nx, ny, x, CASES[c].dimension == 2 ? y : x};
        assert_int_equal(spectrum_moments(&spectrum, &grid, &moments, NULL), 0);
        assert_int_equal(spectrum_hurst_discrete(CASES[c].dimension, CASES[c].ratio,
                                                 CASES[c].rolloff, CASES[c].length_x,
                                                 CASES[c].length_y, moments.nayak_alpha, &hurst,
                                                 &err),
                         0);
        check_close(hurst, CASES[c].hurst, 1e-8);
        double alpha = spectrum_alpha_continuous(CASES[c].dimension, CASES[c].hurst, CASES[c].ratio,
                                                 CASES[c].rolloff);
        assert_int_equal(spectrum_hurst_continuous(CASES[c].dimension, CASES[c].ratio,
                                                   CASES[c].rolloff, alpha, &hurst, NULL),
                         0);
        check_close(hurst, CASES[c].hurst, 1e-8);
    }
    assert_int_equal(spectrum_hurst_discrete(2, 8, 1, 8, 8, 20, &hurst, &err), ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "allowed: "));
    /* in short cells alpha falls towards H = 1, or throughout: the least exponent of the two */
    assert_int_equal(spectrum_hurst_discrete(1, 16, 1, 1, 1, 14.4, &hurst, &err), 0);
    assert_true(hurst > 0.8 && hurst < 0.95);
    assert_int_equal(spectrum_hurst_discrete(1, 2, 1, 1, 1, 1.51, &hurst, &err), 0);
    assert_true(hurst < 0.1);
    assert_int_equal(spectrum_hurst_discrete(2, 1, 1, 8, 8, 2, &hurst, &err), ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "no waves shorter than the roll-off"));
    assert_int_equal(spectrum_hurst_discrete(2, 2, 1, 1, 1, 2.25, &hurst, &err), ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "no isotropic surface"));
    assert_int_equal(spectrum_hurst_discrete(2, 1e5, 1, 8, 8, 20, &hurst, &err), ERROR_INPUT);
}

static void alpha_out_of_reach(void **state) {
    (void)state;
    struct error err = {0};
    double ratio, reached;
    assert_int_equal(spectrum_ratio_discrete(2, 0.8, 1, 1, 1.9, &ratio, &reached, &err),
                     ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "within 1 %; the nearest is "));
    assert_int_equal(spectrum_ratio_continuous(2, 0.8, 1, 1.2, &ratio, &err), ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "alpha = 1.2"));
    assert_non_null(strstr(err.text, "allowed: 1.5 to"));
    assert_int_equal(spectrum_ratio_discrete(1, 0.5, 1, 8, 0.5, &ratio, &reached, &err),
                     ERROR_NUMERIC);
    double least, most; /* the reported range can be had, and a little beyond cannot */
    assert_int_equal(sscanf(strstr(err.text, "allowed: "), "allowed: %lf to %lf", &least, &most),
                     2);
    assert_true(least == 1 && most > 500);
    assert_int_equal(spectrum_ratio_discrete(1, 0.5, 1, 8, least, &ratio, &reached, &err), 0);
    assert_int_equal(spectrum_ratio_discrete(1, 0.5, 1, 8, 0.9999 * most, &ratio, &reached, &err),
                     0);
    assert_int_equal(spectrum_ratio_discrete(1, 0.5, 1, 8, 1.0001 * most, &ratio, &reached, &err),
                     ERROR_NUMERIC);
    assert_int_equal(spectrum_ratio_discrete(2, 0.8, 1, 8, 1.2, &ratio, &reached, &err),
                     ERROR_NUMERIC);
    assert_int_equal(
        sscanf(strstr(err.text, "allowed: "), "allowed: %lf to about %lf", &least, &most), 2);
    assert_true(least > 1.2 && least <= 2 && most > 10000);
    assert_int_equal(spectrum_ratio_discrete(2, 0.2, 1e5, 4, 5, &ratio, &reached, &err),
                     ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "roll-off ratio of 100000"));
    assert_int_equal(sscanf(strstr(err.text, "allowed: "), "allowed: below %lf", &most), 1);
    assert_int_equal(spectrum_ratio_discrete(2, 0.2, 1.001 * most, 4, 2.5, &ratio, &reached, &err),
                     ERROR_NUMERIC);
    assert_null(strstr(err.text, "nan"));
    assert_int_equal(spectrum_ratio_discrete(2, 0.2, 0.999 * most, 4, 2.5, &ratio, &reached, &err),
                     ERROR_NUMERIC);
    assert_null(strstr(err.text, "nan"));
    assert_int_equal(spectrum_ratio_discrete(1, 0.5, 1, 8, 1e30, &ratio, &reached, &err),
                     ERROR_NUMERIC);
}

/* Of all waves with m^2 up to a square, added one by one. */
static double alpha_up_to(double hurst, double lowest, double rolloff, double times,
                          double square) {
    double m0 = 0, m2 = 0, m4 = 0;
    for (double y = 0; y * y <= square * (1 + 1e-10); y += times)
        for (double x = 0; x * x + y * y <= square * (1 + 1e-10); x++) {
            double s = x * x + y * y, copies = (x > 0 ? 2 : 1) * (y > 0 ? 2 : 1);
            if (s < lowest * lowest * (1 - 1e-9) || s == 0)
                continue;
            double weight = copies * fmin(1, pow(s / rolloff / rolloff, -hurst - 1));
            m0 += weight;
            m2 += weight * s / 2;
            m4 += weight * (x * x * x * x + y * y * y * y) / 2;
        }
    return m0 / m2 * (m4 / m2);
}

/* Rings are passed by in whole annuli, each by a series: the one found is that of all waves added
 * singly, and none of the rings before it is nearer. */
static void rings_passed_by_are_counted(void **state) {
    (void)state;
    static const struct {
        double hurst, length, across, rolloff, alpha;
    } CASES[] = {{0.8, 8, 8, 1, 100},  {0.3, 4, 4, 1, 12},   {0.5, 3.5, 3.5, 2, 30},
                 {0.9, 1, 1, 1, 2000}, {0.7, 8, 5.5, 1, 50}, {0.6, 2, 6, 3, 60}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        double hurst = CASES[c].hurst, alpha = CASES[c].alpha, ratio, reached;
        double x = CASES[c].length, y = CASES[c].across, longer = fmax(x, y);
        double times = longer / fmin(x, y), rolloff = longer * CASES[c].rolloff;
        int status = x == y ? spectrum_ratio_discrete(2, hurst, CASES[c].rolloff, x, alpha, &ratio,
                                                      &reached, NULL)
                            : spectrum_ratio_rectangle(hurst, CASES[c].rolloff, x, y, alpha, &ratio,
                                                       &reached, NULL);
        assert_int_equal(status, 0);
        double square = ratio * longer * ratio * longer;
        assert_true(square > 100 * 100); /* else nothing was passed by */
        check_relative(reached, alpha_up_to(hurst, longer, rolloff, times, square), 1e-12);
        for (double before = square - 4; before < square - 1e-6; before += 0.25)
            assert_true(fabs(alpha_up_to(hurst, longer, rolloff, times, before) - alpha) >=
                        fabs(reached - alpha) * (1 - 1e-6));
    }
}

/* Rings of a rectangle that is a square are the square's, and those of any rectangle add up to the
 * moments of its modes; a cell that is turned has the same. */
static void ratios_on_rectangles(void **state) {
    (void)state;
    static const double SIDES[][2] = {{8, 4}, {8, 3}, {3, 2}, {5.5, 1.25}, {2, 1}};
    double ratio, reached, square, square_reached;
    for (double hurst = 0.2; hurst < 1; hurst += 0.3) {
        assert_int_equal(spectrum_ratio_discrete(2, hurst, 2, 4, 4, &square, &square_reached, NULL),
                         0);
        assert_int_equal(spectrum_ratio_rectangle(hurst, 2, 4, 4, 4, &ratio, &reached, NULL), 0);
        check_relative(ratio, square, 1e-14);
        check_relative(reached, square_reached, 1e-12);
    }
    for (size_t s = 0; s < sizeof SIDES / sizeof *SIDES; s++) {
        double x = SIDES[s][0], y = SIDES[s][1], turned;
        assert_int_equal(spectrum_ratio_rectangle(0.6, 1, x, y, 5, &ratio, &reached, NULL), 0);
        assert_int_equal(spectrum_ratio_rectangle(0.6, 1, y, x, 5, &turned, &reached, NULL), 0);
        check_relative(turned, ratio, 1e-14);
        struct grid grid = {(size_t)(8 * x * ratio), (size_t)(8 * y * ratio), x * ratio, y * ratio};
        struct spectrum spectrum = self_affine(0.6, ratio);
        struct modes *modes = NULL;
        struct moments moments;
        assert_int_equal(modes_create(&modes, &spectrum, &grid, NULL), 0);
        modes_moments(modes, &moments);
        check_relative(moments.nayak_alpha, reached, 1e-9);
        check_close(reached, 5, 0.1);
        modes_destroy(&modes);
    }
    struct error err = {0};
    assert_int_equal(spectrum_ratio_rectangle(0.8, 1, 8, 4, 1.2, &ratio, &reached, &err),
                     ERROR_NUMERIC);
    assert_non_null(strstr(err.text, "8 by 4 long waves"));
    assert_int_equal(spectrum_ratio_rectangle(0.8, 1, 8, 0.5, 5, &ratio, &reached, &err),
                     ERROR_INPUT);
}

/* Autocorrelation of the modes at the lag (i dx, j dy), over that at 0. */
static double correlation_of(const struct modes *modes, size_t i, size_t j) {
    const struct grid *grid = &modes->grid;
    double sum = 0, all = 0;
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (long my = -(long)modes->mode_y; my <= (long)modes->mode_y; my++) {
            double power = modes_power(modes, mx, my) * modes_weight(grid, mx);
            double phase =
                2 * M_PI *
                ((double)(mx * i) / (double)grid->nx + (double)my * (double)j / (double)grid->ny);
            sum += power * cos(phase);
            all += power;
        }
    return sum / all;
}

/* The modes of an exponential autocorrelation have it at every point of a coarse grid, less its
 * mean over the cell, since heights have the mean 0. */
static void exponential_spectrum(void **state) {
    (void)state;
    struct grid grid = {64, 48, 40, 20};
    struct spectrum spectrum = {.type = SPECTRUM_EXPONENTIAL_ACF,
                                .correlation_x = 2,
                                .correlation_y = 0.5,
                                .scale = SCALE_RMS_HEIGHT,
                                .scale_value = 3};
    struct modes *modes = NULL;
    struct moments moments;
    assert_int_equal(modes_create(&modes, &spectrum, &grid, NULL), 0);
    assert_int_equal(modes->mode_x, 32);
    assert_true(modes->count <= 64 * 48 - 1 && modes->count > 64 * 47);
    assert_true(modes->clipped >= 0 && modes->clipped < 1e-6);
    double mean = 0;
    for (size_t j = 0; j < 48; j++)
        for (size_t i = 0; i < 64; i++)
            mean += exponential_correlation(&spectrum, &grid, i, j) / (64 * 48);
    for (size_t j = 0; j <= 24; j += 3)
        for (size_t i = 0; i <= 32; i += 4) {
            double x = (double)i * 0.625 / 2, y = (double)j * 20 / 48 / 0.5;
            double expected = (exp(-hypot(x, y)) - mean) / (1 - mean);
            check_close(correlation_of(modes, i, j), expected, 4 * modes->clipped + 1e-12);
        }
    modes_moments(modes, &moments);
    check_relative(moments.rms_height, 3, 1e-14);
    assert_true(moments.m02 > moments.m20);
    modes_destroy(&modes);
}

/* Where the cell is short, no surface has the autocorrelation: the share that is left out is
 * reported. */
static void short_cells_are_clipped(void **state) {
    (void)state;
    struct spectrum spectrum = {
        .type = SPECTRUM_EXPONENTIAL_ACF, .correlation_x = 1, .correlation_y = 1};
    double before = 0;
    for (double side = 16; side >= 2; side /= 2) {
        struct grid grid = {32, 32, side, side};
        struct modes *modes = NULL;
        assert_int_equal(modes_create(&modes, &spectrum, &grid, NULL), 0);
        assert_true(modes->clipped >= before && modes->clipped < 0.1);
        before = modes->clipped;
        modes_destroy(&modes);
    }
    assert_true(before > 1e-4);
}

/* Anisotropic modes are those of the isotropic surface at s mx, and its moments go with s. */
static void anisotropic_spectrum(void **state) {
    (void)state;
    struct grid grid = {256, 256, 32, 32};
    struct spectrum spectrum = self_affine(0.7, 4);
    struct modes *isotropic = NULL, *same = NULL, *anisotropic = NULL, *refused = NULL;
    struct moments moments;
    struct error err = {0};
    assert_int_equal(modes_create(&isotropic, &spectrum, &grid, NULL), 0);
    spectrum.anisotropy = 1;
    assert_int_equal(modes_create(&same, &spectrum, &grid, NULL), 0);
    spectrum.anisotropy = 4;
    assert_int_equal(modes_create(&anisotropic, &spectrum, &grid, NULL), 0);
    assert_true(anisotropic->mode_x == 8 && anisotropic->mode_y == 32);
    assert_true(modes_power(same, 7, 9) == modes_power(isotropic, 7, 9));
    double scale = modes_power(anisotropic, 0, 9) / modes_power(isotropic, 0, 9);
    for (size_t mx = 1; mx <= 8; mx++)
        for (long my = -30; my <= 30; my += 7)
            check_close(modes_power(anisotropic, mx, my),
                        scale * modes_power(isotropic, 4 * mx, my), 1e-15);
    modes_moments(anisotropic, &moments);
    check_relative(moments.m02 / moments.m20, 16, 0.1); /* few waves along x */
    assert_false(moments_isotropic(&moments));
    modes_moments(isotropic, &moments);
    assert_true(moments_isotropic(&moments));
    spectrum.anisotropy = -1;
    assert_int_equal(modes_create(&refused, &spectrum, &grid, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "anisotropy"));
    modes_destroy(&anisotropic);
    modes_destroy(&same);
    modes_destroy(&isotropic);
}

/* Waves of two points along y are their own mirror images: odd moments of isotropic surfaces are 0
 * with them, too. */
static void odd_moments_of_the_shortest_waves(void **state) {
    (void)state;
    const struct grid grid = {64, 32, 32, 16};
    const struct spectrum spectrum = self_affine(0.7, 8);
    struct moments moments;
    assert_int_equal(spectrum_moments(&spectrum, &grid, &moments, NULL), 0);
    assert_true(fabs(moments.m11) < 1e-13 * moments.m20);
    assert_true(fabs(moments.m31) + fabs(moments.m13) < 1e-13 * moments.m40);
}

/* Turned by a right angle the powers are those of swapped waves, turned back those of a mirror;
 * slopes are steepest across the lay, as a cell of eight of the longest waves along it has it.
 * Waves as short as two points are their own mirror images, of one power. */
static void oblique_spectrum(void **state) {
    (void)state;
    struct grid grid = {256, 256, 32, 32}, coarse = {64, 64, 32, 32};
    struct spectrum spectrum = self_affine(0.7, 4);
    struct modes *along = NULL, *turned = NULL, *back = NULL;
    struct moments moments;
    struct error err = {0};
    spectrum.anisotropy = 2;
    assert_int_equal(modes_create(&along, &spectrum, &grid, NULL), 0);
    spectrum.lay_angle = M_PI / 2;
    assert_int_equal(modes_create(&turned, &spectrum, &grid, NULL), 0);
    assert_true(turned->mode_x == along->mode_y && turned->mode_y == along->mode_x);
    for (size_t mx = 0; mx <= 16; mx++)
        for (long my = -16; my <= 16; my++)
            check_close(modes_power(turned, mx, my),
                        modes_power(along, (size_t)labs(my), my < 0 ? -(long)mx : (long)mx), 1e-15);
    modes_destroy(&turned);
    for (int degrees = 10; degrees < 90; degrees += 20) {
        spectrum.lay_angle = degrees * M_PI / 180;
        assert_int_equal(modes_create(&turned, &spectrum, &grid, NULL), 0);
        modes_moments(turned, &moments);
        check_close(atan2(-2 * moments.m11, moments.m02 - moments.m20) * 90 / M_PI, degrees, 1);
        spectrum.lay_angle *= -1;
        assert_int_equal(modes_create(&back, &spectrum, &grid, NULL), 0);
        for (long my = -18; my <= 18; my++)
            check_close(modes_power(back, 7, my), modes_power(turned, 7, -my), 1e-15);
        modes_destroy(&back);
        modes_destroy(&turned);
    }
    spectrum.lay_angle = 0.5;
    assert_int_equal(modes_create(&turned, &spectrum, &coarse, NULL), 0);
    assert_true(turned->mode_y < 32 && turned->mode_x < 32);
    spectrum.wavelength_short = 0.9;
    assert_int_equal(modes_create(&back, &spectrum, &coarse, NULL), 0);
    assert_int_equal(back->mode_y, 32);
    assert_true(modes_power(back, 12, 32) > 0);
    spectrum.lay_angle = NAN;
    modes_destroy(&turned);
    assert_int_equal(modes_create(&turned, &spectrum, &grid, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "angle of the lay = nan"));
    modes_destroy(&back);
    modes_destroy(&along);
}

static void table_spectrum(void **state) {
    (void)state;
    const double k[] = {0.5, 1, 4}, density[] = {4, 2, 2.0 / 64};
    struct grid grid = {64, 1, 20 * M_PI, 1}; /* wave numbers 0.1 m */
    struct spectrum spectrum = {
        .type = SPECTRUM_TABLE, .table_count = 3, .table_wave_number = k, .table_density = density};
    struct modes *modes = NULL;
    struct grid fine = {128, 1, 20 * M_PI, 1};
    assert_int_equal(modes_create(&modes, &spectrum, &grid, NULL),
                     ERROR_INPUT); /* 40 waves on 64 points */
    assert_int_equal(modes_create(&modes, &spectrum, &fine, NULL), 0);
    assert_true(modes_power(modes, 4, 0) == 0 && modes_power(modes, 5, 0) > 0);
    check_relative(modes_power(modes, 20, 0) / modes_power(modes, 10, 0), 1.0 / 8,
                   1e-12); /* k^-3 */
    modes_destroy(&modes);
}

static void scale_by_slope(void **state) {
    (void)state;
    struct spectrum spectrum = self_affine(0.5, 4);
    struct grid grid = {256, 256, 32, 32};
    struct modes *modes = NULL;
    struct moments moments;
    spectrum.scale = SCALE_RMS_SLOPE;
    spectrum.scale_value = 0.1;
    assert_int_equal(modes_create(&modes, &spectrum, &grid, NULL), 0);
    modes_moments(modes, &moments);
    check_relative(moments.rms_slope, 0.1, 1e-14);
    modes_destroy(&modes);
}

/* Dimensionless figures do not depend on the unit of length. */
static void units_do_not_matter(void **state) {
    (void)state;
    double expected = alpha_of(0.8, 4);
    for (double unit = 1e-9; unit <= 1e6; unit *= 1e15) {
        struct grid grid = {256, 256, 32 * unit, 32 * unit};
        struct spectrum spectrum = self_affine(0.8, 4);
        spectrum.wavelength_long = spectrum.wavelength_rolloff = 4 * unit;
        spectrum.wavelength_short = unit;
        struct modes *modes = NULL;
        struct moments moments;
        assert_int_equal(modes_create(&modes, &spectrum, &grid, NULL), 0);
        modes_moments(modes, &moments);
        check_relative(moments.nayak_alpha, expected, 1e-12);
        modes_destroy(&modes);
    }
}

static void wrong_input_is_named(void **state) {
    (void)state;
    struct grid grid = {512, 512, 64, 64};
    static const struct {
        double hurst, longest, rolloff, shortest;
        const char *text;
    } WRONG[] = {
        {1.4, 8, 8, 1, "hurst = 1.4; allowed: 0 to 1"}, {NAN, 8, 8, 1, "hurst = nan"},
        {0.8, -8, 8, 1, "longest wavelength = -8"},     {0.8, 8, 8, 9, "shortest wavelength = 9"},
        {0.8, 8, 9, 1, "roll-off wavelength = 9"},      {0.8, 8, 8, 0.1, "do not resolve"},
        {0.8, 1e-3, 1e-3, 1e-3, "do not resolve"},
    };
    for (size_t w = 0; w < sizeof WRONG / sizeof *WRONG; w++) {
        struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                    .hurst = WRONG[w].hurst,
                                    .wavelength_long = WRONG[w].longest,
                                    .wavelength_rolloff = WRONG[w].rolloff,
                                    .wavelength_short = WRONG[w].shortest};
        struct modes *modes = NULL;
        struct error err = {0};
        assert_int_equal(modes_create(&modes, &spectrum, &grid, &err), ERROR_INPUT);
        if (!strstr(err.text, WRONG[w].text))
            print_error("\"%s\" is not in \"%s\"\n", WRONG[w].text, err.text);
        assert_non_null(strstr(err.text, WRONG[w].text));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(discrete_alpha),
        cmocka_unit_test(continuous_alpha),
        cmocka_unit_test(ratios_of_given_alpha),
        cmocka_unit_test(small_alpha_is_that_of_isotropic_surfaces),
        cmocka_unit_test(hurst_of_given_alpha),
        cmocka_unit_test(alpha_out_of_reach),
        cmocka_unit_test(exponential_spectrum),
        cmocka_unit_test(short_cells_are_clipped),
        cmocka_unit_test(anisotropic_spectrum),
        cmocka_unit_test(odd_moments_of_the_shortest_waves),
        cmocka_unit_test(oblique_spectrum),
        cmocka_unit_test(table_spectrum),
        cmocka_unit_test(scale_by_slope),
        cmocka_unit_test(units_do_not_matter),
        cmocka_unit_test(wrong_input_is_named),
        cmocka_unit_test(ratios_on_rectangles),
        cmocka_unit_test(rings_passed_by_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
