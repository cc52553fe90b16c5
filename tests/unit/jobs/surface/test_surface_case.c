/* Reading the surface of a case: effective values, every fault that no single range shows with its
 * pointer and words, and the grid that follows. */
#include "jobs/surface/surface_case.h"
#include "schema/study/fault.h"
#include "tests/support/check.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static cJSON *case_of(const char *surface) {
    char text[1000];
    snprintf(text, sizeof text, "{\"surface\": %s}", surface);
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    return parameters;
}

static struct surface_case read(const char *surface) {
    struct surface_case out;
    struct error err = {0};
    cJSON *parameters = case_of(surface);
    if (surface_case_read(&out, parameters, NULL, &err) != 0)
        fail_msg("%s: %s", surface, err.text);
    cJSON_Delete(parameters);
    return out;
}

static void defaults(void **state) {
    (void)state;
    struct surface_case surface = read("{\"hurst\": 0.8, \"wavelength_ratio\": 16}");
    assert_int_equal(surface.dimension, 2);
    assert_int_equal(surface.grid.nx, 1024);
    assert_int_equal(surface.grid.ny, 1024);
    assert_true(surface.grid.lx == 128 && surface.grid.ly == 128);
    assert_true(surface.spectrum.wavelength_long == 16 && surface.spectrum.wavelength_short == 1 &&
                surface.spectrum.wavelength_rolloff == 16);
    assert_int_equal(surface.spectrum.scale, SCALE_NONE);
    assert_int_equal(surface.options.heights.type, HEIGHTS_GAUSSIAN);
    assert_true(surface.options.tolerance == 1e-3 && surface.options.max_iterations == 1000);
    assert_int_equal(surface_case_band(&surface).x, 128);
    assert_int_equal(surface_case_band(&surface).y, 128);
    assert_true(surface_case_exact(&surface));
    surface_case_clear(&surface);
}

static void everything_given(void **state) {
    (void)state;
    struct surface_case surface =
        read("{\"dimension\": 1, \"hurst\": 1, \"wavelength_ratio\": 10, \"rolloff_ratio\": 2,"
             " \"length_ratio\": 3, \"points_per_wavelength\": 4, \"rms_slope\": 0.1,"
             " \"heights\": {\"distribution\": \"weibull_max\", \"shape\": 1.5, \"tolerance\": 0,"
             " \"keep\": \"heights\", \"iteration\": \"plain\", \"draw\": \"quantiles\","
             " \"stall_gain\": 0.1, \"stall_iterations\": 20, \"max_iterations\": 50,"
             " \"relaxed_iterations\": 7}}");
    const struct surface_options *options = &surface.options;
    assert_int_equal(surface.grid.nx, 120);
    assert_int_equal(surface.grid.ny, 1);
    assert_true(surface.spectrum.wavelength_rolloff == 5);
    assert_true(surface.spectrum.scale == SCALE_RMS_SLOPE && surface.spectrum.scale_value == 0.1);
    assert_true(options->heights.type == HEIGHTS_WEIBULL_MAX && options->heights.shape == 1.5);
    assert_true(options->keep == KEEP_HEIGHTS && options->iteration == ITERATION_PLAIN);
    assert_true(options->draw == DRAW_QUANTILES && options->tolerance == 0);
    assert_true(options->stall_gain == 0.1 && options->stall_iterations == 20);
    assert_true(options->max_iterations == 50 && options->relaxed_iterations == 7);
    assert_false(surface_case_exact(&surface));
    surface_case_clear(&surface);
}

/* Random amplitudes leave the band as it is, and the spectrum of each surface not; heights that are
 * assigned leave neither. */
static void what_is_exact(void **state) {
    (void)state;
    static const struct {
        const char *more;
        bool exact, band_limited;
    } CASES[] = {{"\"amplitudes\": \"fixed\"", true, true},
                 {"\"amplitudes\": \"random\"", false, true},
                 {"\"heights\": {\"distribution\": \"weibull_min\", \"shape\": 2}", true, true},
                 {"\"heights\": {\"distribution\": \"weibull_min\", \"shape\": 2,"
                  " \"keep\": \"heights\"}",
                  false, false}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        char text[200];
        snprintf(text, sizeof text, "{\"hurst\": 0.8, \"wavelength_ratio\": 8, %s}", CASES[c].more);
        struct surface_case surface = read(text);
        assert_true(surface_case_exact(&surface) == CASES[c].exact);
        assert_true(surface_case_band_limited(&surface) == CASES[c].band_limited);
        surface_case_clear(&surface);
    }
}

/* dx is never coarser than asked; an integer behind a rounding is that integer. */
static void grids(void **state) {
    (void)state;
    struct surface_case surface =
        read("{\"hurst\": 0.8, \"wavelength_ratio\": 9.7515, \"length_ratio\": 8}");
    assert_int_equal(surface.grid.nx, 630); /* 624.096: the next even 2, 3, 5, 7 number */
    surface_case_clear(&surface);
    surface = read("{\"hurst\": 0.8, \"wavelength_ratio\": 7, \"length_ratio\": 7,"
                   " \"points_per_wavelength\": 3}");
    assert_int_equal(surface.grid.nx, 147); /* an integer stays as it is, odd or not */
    surface_case_clear(&surface);
    surface = read("{\"hurst\": 0.8, \"wavelength_ratio\": 0.30000000000000004e1,"
                   " \"length_ratio\": 1.1, \"points_per_wavelength\": 10}");
    assert_int_equal(surface.grid.nx, 33);
    surface_case_clear(&surface);
    surface = read("{\"hurst\": 0.8, \"wavelength_ratio\": 1, \"length_ratio\": 1,"
                   " \"points_per_wavelength\": 2}");
    assert_int_equal(surface.grid.nx, 2);
    surface_case_clear(&surface);
}

/* Rectangles have the same distances along both sides, and sides in exactly the ratio asked for:
 * where points have to be rounded up, to that ratio in least whole numbers times a good number. */
static void rectangles(void **state) {
    (void)state;
    static const struct {
        const char *more;
        size_t nx, ny;
    } CASES[] = {
        {"\"wavelength_ratio\": 16, \"length_ratio_y\": 4", 1024, 512},
        {"\"wavelength_ratio\": 16, \"length_ratio\": 4, \"length_ratio_y\": 8", 512, 1024},
        {"\"wavelength_ratio\": 8, \"length_ratio\": 3, \"length_ratio_y\": 1.5", 192, 96},
        {"\"wavelength_ratio\": 7, \"length_ratio\": 7, \"length_ratio_y\": 5,"
         " \"points_per_wavelength\": 3",
         147, 105},
        /* 624.096 by 312.048: the next even 2, 3, 5, 7 number above 312.048 */
        {"\"wavelength_ratio\": 9.7515, \"length_ratio_y\": 4", 640, 320},
        /* 624.096 by 234.036 is 8 by 3: 80 above 78.012 */
        {"\"wavelength_ratio\": 9.7515, \"length_ratio_y\": 3", 640, 240},
        {"\"wavelength_ratio\": 4, \"length_ratio\": 100, \"length_ratio_y\": 7.25", 3200, 232},
        {"\"wavelength_ratio\": 16, \"length_ratio\": 8, \"length_ratio_y\": 8", 1024, 1024},
    };
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        char text[200];
        snprintf(text, sizeof text, "{\"hurst\": 0.8, %s}", CASES[c].more);
        struct surface_case surface = read(text);
        const struct grid *grid = &surface.grid;
        struct surface_band band = surface_case_band(&surface);
        assert_int_equal(grid->nx, CASES[c].nx);
        assert_int_equal(grid->ny, CASES[c].ny);
        assert_true(fabs(grid_dx(grid) / grid_dy(grid) - 1) <= 1e-14);
        assert_true(grid->lx == surface.length_ratio * surface.wavelength_ratio &&
                    grid->ly == surface.length_ratio_y * surface.wavelength_ratio);
        assert_int_equal(band.x, (size_t)(grid->lx * (1 + 1e-9)));
        assert_int_equal(band.y, (size_t)(grid->ly * (1 + 1e-9)));
        assert_true(surface_case_longest(&surface) == fmax(grid->lx, grid->ly));
        surface_case_clear(&surface);
    }
}

/* The bytes of a generator are those of the cell, whichever side is the longer one. */
static void bytes_of_a_rectangle(void **state) {
    (void)state;
    struct surface_case square = read("{\"hurst\": 0.8, \"wavelength_ratio\": 8}");
    struct surface_case half =
        read("{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"length_ratio_y\": 4}");
    double ratio = surface_case_bytes(&half) / surface_case_bytes(&square);
    assert_true(ratio > 0.45 && ratio < 0.55);
    surface_case_clear(&square);
    surface_case_clear(&half);
}

/* nayak_alpha is solved on the rectangle, and a cell that is turned has the same ratio. */
static void alpha_of_a_rectangle(void **state) {
    (void)state;
    struct surface_case wide =
        read("{\"hurst\": 0.8, \"nayak_alpha\": 5, \"length_ratio\": 8, \"length_ratio_y\": 3}");
    struct surface_case high =
        read("{\"hurst\": 0.8, \"nayak_alpha\": 5, \"length_ratio\": 3, \"length_ratio_y\": 8}");
    struct modes *modes = NULL;
    struct moments moments;
    assert_int_equal(modes_create(&modes, &wide.spectrum, &wide.grid, NULL), 0);
    modes_moments(modes, &moments);
    modes_destroy(&modes);
    assert_true(fabs(moments.nayak_alpha - 5) <= 0.02); /* half a step of the staircase */
    assert_true(wide.wavelength_ratio == high.wavelength_ratio);
    surface_case_clear(&wide);
    surface_case_clear(&high);
}

/* Table 3.5 of the reference: ratios for a given alpha by the continuous formula. */
static void ratios_of_alpha(void **state) {
    (void)state;
    const double hurst[] = {0.4, 0.6, 0.8}, alpha[] = {5, 10, 15};
    const double table[3][3] = {
        {9.751, 23.058, 37.921}, {8.308, 16.538, 24.126}, {7.669, 14.163, 19.661}};
    for (int h = 0; h < 3; h++) {
        for (int a = 0; a < 3; a++) {
            char text[200];
            snprintf(text, sizeof text,
                     "{\"hurst\": %g, \"nayak_alpha\": %g, \"alpha_formula\": \"continuous\"}",
                     hurst[h], alpha[a]);
            struct surface_case surface = read(text);
            /* its last printed digit, and the reference cut some off where it should have rounded
             */
            assert_true(fabs(surface.wavelength_ratio - table[h][a]) <= 0.0011);
            surface_case_clear(&surface);
        }
    }
}

static void other_spectra(void **state) {
    (void)state;
    struct surface_case surface = read("{\"wavelength_ratio\": 4, \"spectrum\": {\"type\": "
                                       "\"exponential_acf\", \"length\": [2]}}");
    assert_true(surface.spectrum.correlation_x == 2 && surface.spectrum.correlation_y == 2);
    assert_int_equal(surface_case_band(&surface).x, surface.grid.nx / 2);
    surface_case_clear(&surface);
    surface = read("{\"wavelength_ratio\": 4, \"spectrum\": {\"type\": \"table\","
                   " \"wave_number\": [1, 2, 6], \"density\": [3, 2, 0]}}");
    assert_int_equal(surface.spectrum.table_count, 3);
    assert_true(surface.spectrum.table_wave_number[2] == 6 &&
                surface.spectrum.table_density[1] == 2);
    assert_int_equal(surface_case_band(&surface).x, 30); /* 6 * 32 / (2 pi) */
    surface_case_clear(&surface);
}

#define OWN(distribution)                                                                          \
    "{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\": {\"distribution\": " distribution "}}"

/* The numbers arrive, and are those of one distribution however they were given. */
static void heights_of_ones_own(void **state) {
    (void)state;
    struct surface_case by_samples =
        read(OWN("\"samples\", \"samples\": [4, 1, 3, 9, 5, 8, 6, 7]"));
    struct surface_case by_quantiles =
        read(OWN("\"quantiles\", \"probability\": [0.0625, 0.1875, 0.3125, 0.4375, 0.5625, 0.6875, "
                 "0.8125, 0.9375], \"quantile\": [1, 3, 4, 5, 6, 7, 8, 9]"));
    struct surface_case named = read(OWN("\"gaussian\", \"samples\": [4, 1, 3, 9, 5, 8, 6, 7]"));
    const struct heights *one = &by_samples.options.heights;
    const struct heights *other = &by_quantiles.options.heights;
    assert_true(one->type == HEIGHTS_TABLE && other->type == HEIGHTS_TABLE);
    assert_true(named.options.heights.type == HEIGHTS_GAUSSIAN);
    assert_string_equal(by_samples.heights_name, "samples");
    assert_string_equal(by_quantiles.heights_name, "quantiles");
    assert_string_equal(named.heights_name, "gaussian");
    struct height_moments moments, same;
    assert_int_equal(heights_moments(one, &moments, NULL), 0);
    assert_int_equal(heights_moments(other, &same, NULL), 0);
    assert_true(moments.skewness < -0.1 && moments.skewness > -1);
    for (double p = 0.01; p < 1; p += 0.07)
        check_close(heights_quantile(other, &same, p), heights_quantile(one, &moments, p), 1e-12);
    surface_case_clear(&by_samples);
    surface_case_clear(&by_quantiles);
    surface_case_clear(&named);
    assert_null(by_samples.height_table);
}

/* What is known before a surface is made: of heights that are Gaussian that they are. */
static void surfaces_are_described(void **state) {
    (void)state;
    static const struct {
        const char *surface;
        double ratio, hurst, skewness, kurtosis;
    } CASES[] = {{"{\"hurst\": 0.8, \"wavelength_ratio\": 8}", 0, 0, 0, 3},
                 {"{\"hurst\": 0.8, \"nayak_alpha\": 5.3368}", 8, 0, 0, 3},
                 {"{\"nayak_alpha\": 5.3368, \"wavelength_ratio\": 8}", 0, 0.8, 0, 3},
                 {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\": {\"distribution\": "
                  "\"weibull_max\","
                  " \"shape\": 1}}",
                  0, 0, -2, 9}};
    for (size_t n = 0; n < sizeof CASES / sizeof *CASES; n++) {
        struct surface_case surface = read(CASES[n].surface);
        struct study_cost cost = {0};
        surface_case_estimate(&surface, &cost);
        check_close(cost.wavelength_ratio, CASES[n].ratio, 0.05);
        check_close(cost.hurst, CASES[n].hurst, 1e-3);
        check_close(cost.skewness, CASES[n].skewness, 1e-9);
        check_close(cost.kurtosis, CASES[n].kurtosis, 1e-9);
        surface_case_clear(&surface);
    }
}

static void shape_of_a_skewness(void **state) {
    (void)state;
    struct surface_case surface = read("{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\":"
                                       " {\"distribution\": \"weibull_max\", \"skewness\": -2}}");
    check_close(surface.options.heights.shape, 1, 1e-12);
    surface_case_clear(&surface);
}

static void shapes_of_beta(void **state) {
    (void)state;
#define BETA(heights)                                                                              \
    "{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\": {\"distribution\": \"beta\", " heights \
    "}}"
    static const struct {
        const char *surface;
        double shape, second;
    } CASES[] = {{BETA("\"shape\": 3"), 3, 0},
                 {BETA("\"shape\": 3, \"second_shape\": 2"), 3, 2},
                 {BETA("\"skewness\": 0, \"second_shape\": 2"), 2, 2},
                 {BETA("\"skewness\": 0, \"kurtosis\": 1.8"), 1, 1}};
    for (size_t n = 0; n < sizeof CASES / sizeof *CASES; n++) {
        struct surface_case surface = read(CASES[n].surface);
        check_close(surface.options.heights.shape, CASES[n].shape, 1e-12);
        check_close(surface.options.heights.second, CASES[n].second, 1e-12);
        surface_case_clear(&surface);
    }
}

/* A table of lags becomes one of wave numbers, up to the shortest waves that the lags resolve. */
static void spectrum_of_lags(void **state) {
    (void)state;
#define ACF(members) "{\"wavelength_ratio\": 8, \"spectrum\": {\"type\": \"acf_table\"" members "}}"
    struct surface_case surface = read(
        ACF(", \"lag\": [0, 0.5, 1, 2, 4, 8], \"correlation\": [1, 0.78, 0.61, 0.37, 0.14, 0]"));
    const struct spectrum *spectrum = &surface.spectrum;
    assert_true(spectrum->type == SPECTRUM_TABLE && spectrum->table_count > 10);
    check_close(spectrum->table_wave_number[spectrum->table_count - 1], 2 * M_PI, 1e-9);
    assert_true(spectrum->table_wave_number[0] < 2 * M_PI / 64);
    surface_case_clear(&surface);
}

struct broken_case {
    const char *surface, *pointer, *words;
};
static const struct broken_case BROKEN[] = {
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\": {\"distribution\": \"weibull_min\","
     " \"shape\": 1, \"skewness\": 2}}",
     "/surface/heights/skewness", "not both"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\": {\"distribution\": \"weibull_max\","
     " \"skewness\": 2}}",
     "/surface/heights/skewness", "no shape has the skewness 2; allowed: -6.6"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\": {\"tolerance\": 0, \"tolerances\":"
     " {\"eps_s\": 0.1}}}",
     "/surface/heights/tolerances/eps_s", "no end"},
    {ACF(""), "/surface/spectrum/correlation", "as many of each"},
    {ACF(", \"lag\": [0, 2, 1], \"correlation\": [1, 0.5, 0]"), "/surface/spectrum/lag",
     "must rise"},
    {ACF(", \"lag\": [0, 1, 2], \"correlation\": [1, 1, 1]"), "/surface/spectrum/correlation",
     "no isotropic surface has this"},
    {ACF(", \"lag\": [0, 100, 200], \"correlation\": [1, 0.5, 0]"), "/surface/spectrum/lag",
     "no wave of the cell"},
    {BETA("\"skewness\": 1"), "/surface/heights/skewness", "give the second shape"},
    {BETA("\"skewness\": 1, \"kurtosis\": 5"), "/surface/heights/kurtosis", "allowed: (2, 4.5)"},
    {BETA("\"shape\": 1, \"kurtosis\": 2"), "/surface/heights/kurtosis", "belongs to skewness"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\": {\"distribution\": \"gamma\","
     " \"shape\": 2, \"second_shape\": 2}}",
     "/surface/heights/second_shape", "two shapes, beta"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\": {\"kurtosis\": 4}}",
     "/surface/heights/kurtosis", "two shapes, beta"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\": {\"skewness\": 1}}",
     "/surface/heights/skewness", "these heights have no shape"},
    {"{\"nayak_alpha\": 1.6, \"wavelength_ratio\": 2, \"rolloff_ratio\": 3}",
     "/surface/rolloff_ratio", "more than wavelength_ratio"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\": {\"distribution\": \"lognormal\"}}",
     "/surface/heights/shape", "or its skewness"},
    {"{\"wavelength_ratio\": 8}", "/surface/hurst", "needs it"},
    {"{\"hurst\": 0.8}", "/surface/wavelength_ratio", "or nayak_alpha"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"nayak_alpha\": 5}", "/surface/nayak_alpha",
     "not all"},
    {"{\"nayak_alpha\": 50, \"wavelength_ratio\": 8}", "/surface/nayak_alpha",
     "no Hurst exponent gives alpha = 50 at a wavelength ratio of 8; allowed: "},
    {"{\"hurst\": 0.8, \"nayak_alpha\": 1.2}", "/surface/nayak_alpha", "alpha"},
    {"{\"hurst\": 1.4, \"wavelength_ratio\": 8}", "/surface/hurst", "(0, 1]"},
    {"{\"hurst\": 0, \"wavelength_ratio\": 8}", "/surface/hurst", "(0, 1]"},
    {"{\"hurst\": \"x\", \"wavelength_ratio\": 8}", "/surface/hurst", "number"},
    {"{\"dimension\": 1.5, \"hurst\": 0.8, \"wavelength_ratio\": 8}", "/surface/dimension",
     "integer"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"rolloff_ratio\": 9}", "/surface/rolloff_ratio",
     "more than wavelength_ratio"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 1, \"length_ratio\": 2.5}", "/surface/length_ratio",
     "no wave"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 1024}", "/surface/points_per_wavelength", "46340"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 1024, \"length_ratio_y\": 7}",
     "/surface/points_per_wavelength", "65536 by 57344 points is too large: at most 2147483648"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"dimension\": 1, \"length_ratio_y\": 8}",
     "/surface/length_ratio_y", "profiles have one length"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"length_ratio_y\": 0.5}",
     "/surface/length_ratio_y", "[1, 100000]"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"length_ratio_y\": 3.14159}",
     "/surface/length_ratio_y", "simple ratio"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 1, \"length_ratio\": 1.5, \"length_ratio_y\": 2.5}",
     "/surface/length_ratio", "no wave"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 1, \"length_ratio\": 8, \"anisotropy\": 1.5,"
     " \"lay_angle\": 30}",
     "/surface/length_ratio", "no wave"},
    {"{\"wavelength_ratio\": 1, \"length_ratio\": 8, \"spectrum\": {\"type\": \"table\","
     " \"wave_number\": [4.1, 4.11], \"density\": [1, 1]}}",
     "/surface/length_ratio", "no wave"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"rms_slope\": 1, \"rms_height\": 1}",
     "/surface/rms_height", "not both"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\": {\"distribution\": \"weibull_min\"}}",
     "/surface/heights/shape", "[0.5, 20]"},
    {"{\"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\": {\"distribution\": \"normal\"}}",
     "/surface/heights/distribution", "gaussian"},
    {OWN("\"samples\""), "/surface/heights/samples", "needs its samples"},
    {OWN("\"samples\", \"samples\": [1, 2, 3, 4, 5, 6, 7]"), "/surface/heights/samples",
     "8 to 10000 numbers"},
    {OWN("\"samples\", \"samples\": [1, 2, 3, 4, 5, 6, 7, 1e101]"), "/surface/heights/samples/7",
     "1e+100"},
    {OWN("\"samples\", \"samples\": [1, 2, 3, 4, 5, 6, 7, null]"), "/surface/heights/samples/7",
     "a number"},
    {OWN("\"samples\", \"samples\": [[1, 2, 3, 4, 5, 6, 7, 8]]"), "/surface/heights/samples",
     "8 to 10000 numbers"},
    {OWN("\"samples\", \"samples\": [2, 2, 2, 2, 2, 2, 2, 2]"), "/surface/heights/samples",
     "must differ"},
    {OWN("\"quantiles\""), "/surface/heights/quantile", "as many of each"},
    {OWN("\"quantiles\", \"probability\": [0, 0.1, 0.2, 0.5, 1], \"quantile\": "
         "[1, 2, 3, 4, 5, 6]"),
     "/surface/heights/quantile", "as many of each"},
    {OWN("\"quantiles\", \"probability\": [0, 0.1, 0.2, 0.5, 2], \"quantile\": [1, 2, 3, 4, 5]"),
     "/surface/heights/probability/4", "[0, 1]"},
    {OWN("\"quantiles\", \"probability\": [0, 0.1, 0.7, 0.5, 1], \"quantile\": [1, 2, 3, 4, 5]"),
     "/surface/heights/probability", "must rise; number 3"},
    {OWN("\"quantiles\", \"probability\": [0, 0.1, 0.2, 0.5, 1], \"quantile\": [1, 2, 3, 9, 5]"),
     "/surface/heights/quantile", "must not fall; number 4"},
    {"{\"wavelength_ratio\": 4, \"spectrum\": {\"type\": \"exponential_acf\"}}",
     "/surface/spectrum/length", "correlation lengths"},
    {"{\"wavelength_ratio\": 4, \"spectrum\": {\"type\": \"exponential_acf\", \"length\": [0]}}",
     "/surface/spectrum/length/0", "(0, 10000000000]"},
    {"{\"wavelength_ratio\": 4, \"spectrum\": {\"type\": \"table\", \"wave_number\": [1, 2]}}",
     "/surface/spectrum/density", "as many"},
    {"{\"wavelength_ratio\": 4, \"spectrum\": {\"type\": \"table\", \"wave_number\": [2, 1],"
     " \"density\": [1, 1]}}",
     "/surface/spectrum/wave_number", "must rise"},
    {"{\"wavelength_ratio\": 4, \"spectrum\": {\"type\": \"table\", \"wave_number\": [1, 2],"
     " \"density\": [0, 0]}}",
     "/surface/spectrum/density", "above 0"},
    {"{\"wavelength_ratio\": 4, \"spectrum\": {\"type\": \"table\", \"wave_number\": [1, 99],"
     " \"density\": [1, 1]}}",
     "/surface/spectrum/wave_number", "resolves"},
    {"{\"spectrum\": {\"type\": \"table\", \"wave_number\": [1, 2], \"density\": [1, 1]}}",
     "/surface/wavelength_ratio", "needs it"},
};

static void faults_have_pointer_and_words(void **state) {
    (void)state;
    for (size_t a = 0; a < sizeof BROKEN / sizeof *BROKEN; a++) {
        struct surface_case surface;
        struct fault_list faults = {0};
        struct error err = {0};
        cJSON *parameters = case_of(BROKEN[a].surface);
        assert_int_equal(surface_case_read(&surface, parameters, &faults, &err), ERROR_INPUT);
        if (faults.count == 0 || strcmp(faults.faults[0].pointer, BROKEN[a].pointer) != 0 ||
            strstr(faults.faults[0].detail, BROKEN[a].words) == NULL)
            fail_msg("%s: %zu faults, the first %s: %s", BROKEN[a].surface, faults.count,
                     faults.count > 0 ? faults.faults[0].pointer : "",
                     faults.count > 0 ? faults.faults[0].detail : "");
        assert_non_null(strstr(err.text, BROKEN[a].words));
        fault_list_clear(&faults);
        assert_int_equal(surface_case_read(&surface, parameters, NULL, &err), ERROR_INPUT);
        cJSON_Delete(parameters);
    }
}

/* Cells of which only oblique waves lie in a narrow band are accepted. Their spectra have the modes
 * that are counted by hand, of wave vectors stretched and turned with the lay. */
static void narrow_bands(void **state) {
    (void)state;
    static const struct {
        const char *study;
        size_t modes;
    } BANDS[] = {
        {"{\"hurst\": 0.8, \"wavelength_ratio\": 1.05, \"length_ratio\": 2.5, \"anisotropy\": 2,"
         " \"lay_angle\": 45}",
         4}, /* (1, -2), (2, -1), and their opposites */
        {"{\"hurst\": 0.8, \"wavelength_ratio\": 1.03, \"length_ratio\": 2.75, \"anisotropy\": 2}",
         4}, /* (1, 2), (1, -2), and their opposites */
    };
    for (size_t b = 0; b < sizeof BANDS / sizeof *BANDS; b++) {
        struct surface_case surface = read(BANDS[b].study);
        struct modes *modes = NULL;
        assert_int_equal(modes_create(&modes, &surface.spectrum, &surface.grid, NULL), 0);
        assert_int_equal(modes->count, BANDS[b].modes);
        modes_destroy(&modes);
        surface_case_clear(&surface);
    }
}

/* All faults of a surface at once, not the first alone. */
static void all_faults_at_once(void **state) {
    (void)state;
    struct surface_case surface;
    struct fault_list faults = {0};
    cJSON *parameters =
        case_of("{\"hurst\": 2, \"length_ratio\": 0, \"heights\": {\"shape\": 1, \"keep\": 3}}");
    assert_int_equal(surface_case_read(&surface, parameters, &faults, NULL), ERROR_INPUT);
    assert_int_equal(faults.count, 3); /* that do not fit their rows */
    fault_list_clear(&faults);
    cJSON_Delete(parameters);
    parameters = case_of("{\"length_ratio\": 2, \"rms_slope\": 1, \"rms_height\": 1,"
                         " \"heights\": {\"distribution\": \"weibull_min\"}}");
    assert_int_equal(surface_case_read(&surface, parameters, &faults, NULL), ERROR_INPUT);
    assert_int_equal(faults.count, 4); /* that do not fit together */
    fault_list_clear(&faults);
    cJSON_Delete(parameters);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults),
        cmocka_unit_test(surfaces_are_described),
        cmocka_unit_test(shape_of_a_skewness),
        cmocka_unit_test(shapes_of_beta),
        cmocka_unit_test(spectrum_of_lags),
        cmocka_unit_test(everything_given),
        cmocka_unit_test(what_is_exact),
        cmocka_unit_test(grids),
        cmocka_unit_test(narrow_bands),
        cmocka_unit_test(rectangles),
        cmocka_unit_test(bytes_of_a_rectangle),
        cmocka_unit_test(alpha_of_a_rectangle),
        cmocka_unit_test(ratios_of_alpha),
        cmocka_unit_test(other_spectra),
        cmocka_unit_test(heights_of_ones_own),
        cmocka_unit_test(faults_have_pointer_and_words),
        cmocka_unit_test(all_faults_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
