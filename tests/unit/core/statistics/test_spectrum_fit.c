/* Protects: the law that fits a spectrum is the one that the surface was made with; where it ends
 * is reported, and why; what a map does not determine is left open; a law that does not fit says
 * so; ranges that are asked for hold, or are refused. How often the intervals hold the truth is
 * counted in tests/validation/core/test_spectrum_recovery.c. */
#include "tests/support/check.h"

#include "core/statistics/spectra/spectrum_fit.h"
#include "core/theory/nayak.h"
#include "tests/support/spectrum_recovery.h"

enum { SIDE = 128 };
static const struct grid GRID = {SIDE, SIDE, SIDE, SIDE};
static const struct spectrum_fit_request BY_THE_MAP = {0};

static const struct spectrum LAW = {.type = SPECTRUM_SELF_AFFINE,
                                    .hurst = 0.7,
                                    .wavelength_long = SIDE,
                                    .wavelength_rolloff = 16,
                                    .wavelength_short = 4};

static double *surface(const struct spectrum *spectrum, enum surface_amplitudes amplitudes,
                       const struct grid *grid, uint64_t realisation) {
    struct surface_options options = SURFACE_DEFAULTS;
    struct generator *generator = NULL;
    double *z = malloc(grid_points(grid) * sizeof *z);
    options.amplitudes = amplitudes;
    assert_non_null(z);
    assert_int_equal(generator_create(&generator, spectrum, grid, &options, NULL), 0);
    assert_int_equal(
        generator_run(generator, (struct random_key){9, 0, realisation}, z, NULL, NULL), 0);
    generator_destroy(&generator);
    return z;
}

static struct spectrum_fit fit_of(const struct grid *grid, const double *z, enum boundary boundary,
                                  const struct spectrum_fit_request *request) {
    const struct measured_map map = {grid, z, boundary};
    struct map_spectrum *spectrum = NULL;
    struct spectrum_fit fit;
    assert_int_equal(map_spectrum_create(&spectrum, &map, NULL), 0);
    assert_int_equal(spectrum_fit_measure(spectrum, request, &fit, NULL), 0);
    map_spectrum_destroy(&spectrum);
    return fit;
}

static void check_inside(const struct interval *found, double truth, const char *name) {
    if (found->low <= truth && truth <= found->high && found->low <= found->value &&
        found->value <= found->high)
        return;
    print_error("%s: %g [%g, %g], not %g\n", name, found->value, found->low, found->high, truth);
    fail();
}

/* Amplitudes that are not random leave no scatter but that of the grid. */
static void exact_spectra_give_their_law(void **state) {
    (void)state;
    double *z = surface(&LAW, AMPLITUDES_FIXED, &GRID, 1);
    struct spectrum_fit fit = fit_of(&GRID, z, BOUNDARY_PERIODIC, &BY_THE_MAP);
    assert_true(fit.fitted);
    assert_int_equal(fit.from_end, SPECTRUM_END_SIDE);
    assert_int_equal(fit.to_end, SPECTRUM_END_CUTOFF);
    check_close(fit.hurst.value, 0.7, 1e-3);
    check_relative(fit.rolloff_wavelength.value, 16, 1e-3);
    check_relative(fit.short_wavelength.value, 4, 2e-3);
    check_relative(fit.trusted_from, SIDE, 1e-12);
    check_relative(fit.trusted_to, 4, 2e-3);
    check_inside(&fit.hurst, 0.7, "H");
    check_inside(&fit.rolloff_wavelength, 16, "roll-off");
    assert_true(fit.hurst.high - fit.hurst.low > 0.05); /* as of random amplitudes */
    assert_true(isnan(fit.long_wavelength.value) && isnan(fit.long_wavelength.high));
    assert_true(fit.long_wavelength.low < SIDE);
    assert_true(fit.deviance < 0.05);
    assert_true(fit.noise == 0);
    free(z);
}

/* The law of a fit has the RMS height that it reports, and makes surfaces of it. */
static void laws_are_what_they_tell(void **state) {
    (void)state;
    enum { STEPS = 20000 };
    double *z = surface(&LAW, AMPLITUDES_FIXED, &GRID, 2), height = 0, slope = 0, bend = 0;
    struct spectrum_fit fit = fit_of(&GRID, z, BOUNDARY_PERIODIC, &BY_THE_MAP);
    double low = 2 * M_PI / fit.longest, high = 2 * M_PI / fit.shortest;
    double step = log(high / low) / STEPS;
    for (int a = 0; a < STEPS; a++) {
        double k = low * exp((a + 0.5) * step), density = spectrum_fit_density(&fit, k);
        height += 2 * M_PI * density * k * k * step;
        slope += 2 * M_PI * density * pow(k, 4) * step;
        bend += 2 * M_PI * density * pow(k, 6) * step;
    }
    check_relative(fit.rms_height.value, sqrt(height), 1e-6);
    check_relative(fit.rms_slope.value, sqrt(slope), 1e-6);
    check_relative(fit.rms_curvature.value, sqrt(bend) / 2, 1e-6);
    /* m4 is 3/8 of the mean of |k|^4, m2 half of that of |k|^2 */
    check_relative(fit.nayak_alpha.value, 1.5 * height * bend / (slope * slope), 1e-6);
    check_relative(fit.summit_density.value, nayak_summit_density(slope / 2, 3 * bend / 8), 1e-6);
    assert_true(spectrum_fit_density(&fit, 0.9 * low) == 0);
    assert_true(spectrum_fit_density(&fit, 1.1 * high) == 0);
    struct spectrum law;
    struct moments made, given;
    assert_int_equal(spectrum_fit_law(&fit, &law, NULL), 0);
    assert_int_equal(spectrum_moments(&law, &GRID, &made, NULL), 0);
    assert_int_equal(spectrum_moments(&LAW, &GRID, &given, NULL), 0);
    check_relative(made.rms_height, sqrt(height), 1e-7);
    check_relative(made.rms_height, given.rms_height, 0.02);
    check_relative(made.rms_slope, given.rms_slope, 0.02);
    free(z);
}

/* A sub-map with random amplitudes determines its law, also where it is a profile or has unlike
 * sides. */
static void pieces_hold_the_truth(void **state) {
    (void)state;
    static const struct recovery_case CASES[] = {
        {"piece", 320, 112, 112, 0.5, 20, 4, 320, 0, false, 0, 0},
        {"piece of unlike sides", 320, 80, 160, 0.8, 20, 4, 320, 0, false, 0, 0},
    };
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct recovery recovery;
        enum { PATCHES = 12 };
        recovery_run(&recovery, &CASES[c], PATCHES);
        for (size_t a = 0; a < RECOVERED; a++) /* at most 2 of 12: 98 times in 100 */
            if (recovery.of[a].inside + 3 < PATCHES) {
                recovery_print(&recovery, &CASES[c]);
                fail();
            }
        assert_true(recovery.of[RECOVERED_SHORT].seen == PATCHES);
        assert_true(recovery.of[RECOVERED_LONG].seen == 0);
    }
}

/* Adds noise of unit variance times its deviation, as good as Gaussian. */
static void noise_add(double *z, size_t n, double deviation) {
    enum { SUMMED = 12 };
    for (size_t point = 0; point < n; point++) {
        double u[SUMMED], total = -SUMMED / 2.;
        random_uniform((struct random_key){4, 0, 0}, STREAM_HEIGHTS, SUMMED * point, SUMMED, u);
        for (size_t a = 0; a < SUMMED; a++)
            total += u[a];
        z[point] += deviation * total;
    }
}

/* Noise is as strong as waves of 6 points. */
static void noise_ends_the_trust(void **state) {
    (void)state;
    static const double DEVIATION = 0.5;
    struct spectrum law = LAW;
    law.wavelength_short = 2;
    for (int weak = 0; weak < 2; weak++) {
        double *z = surface(&law, AMPLITUDES_RANDOM, &GRID, 3);
        double deviation = weak == 0 ? DEVIATION : 1e-9;
        noise_add(z, grid_points(&GRID), deviation);
        struct spectrum_fit fit = fit_of(&GRID, z, BOUNDARY_PERIODIC, &BY_THE_MAP);
        assert_true(fit.fitted);
        if (weak == 0) {
            assert_int_equal(fit.to_end, SPECTRUM_END_NOISE);
            check_relative(fit.noise, DEVIATION * DEVIATION / pow(2 * M_PI, 2), 0.5);
            assert_true(fit.trusted_to > 4);
        } else {
            assert_int_equal(fit.to_end, SPECTRUM_END_SPACING);
            check_relative(fit.trusted_to, 4, 0.05);
        }
        check_inside(&fit.hurst, 0.7, "H");
        assert_true(isnan(fit.short_wavelength.value) && isnan(fit.short_wavelength.low));
        assert_true(fit.short_wavelength.high == fit.trusted_to);
        free(z);
    }
}

/* Takes exp(-(b k)^2/2) of the amplitudes, as a blunt instrument does. */
static double *blurred(double *z, double b) {
    enum { REACH = 16 };
    double weight[REACH + 1], total = 0, *out = calloc(grid_points(&GRID), sizeof *out);
    assert_non_null(out);
    for (int a = 0; a <= REACH; a++) {
        weight[a] = exp(-a * a / (2 * b * b));
        total += (a > 0 ? 2 : 1) * weight[a];
    }
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++)
            for (int y = -REACH; y <= REACH; y++)
                for (int x = -REACH; x <= REACH; x++)
                    out[j * SIDE + i] += weight[abs(x)] * weight[abs(y)] / (total * total) *
                                         z[(j + y + SIDE) % SIDE * SIDE + (i + x + SIDE) % SIDE];
    free(z);
    return out;
}

static void an_instrument_is_no_law(void **state) {
    (void)state;
    struct spectrum law = LAW;
    law.wavelength_short = 2;
    double *z = blurred(surface(&law, AMPLITUDES_RANDOM, &GRID, 4), 1.6);
    struct spectrum_fit fit = fit_of(&GRID, z, BOUNDARY_PERIODIC, &BY_THE_MAP);
    assert_true(fit.fitted);
    assert_int_equal(fit.to_end, SPECTRUM_END_LOW_PASS);
    /* half of the power has gone where (1.6 k)^2 is log 2 */
    assert_true(fit.trusted_to > 6 && fit.trusted_to < 2.5 * 2 * M_PI * 1.6 / sqrt(log(2)));
    check_inside(&fit.hurst, 0.7, "H");
    check_inside(&fit.rolloff_wavelength, 16, "roll-off");
    assert_true(isnan(fit.short_wavelength.value));
    assert_true(fit.deviance < 2);
    free(z);
}

static void ranges_that_are_asked_for(void **state) {
    (void)state;
    const struct measured_map map = {&GRID, surface(&LAW, AMPLITUDES_RANDOM, &GRID, 5),
                                     BOUNDARY_PERIODIC};
    struct spectrum_fit_request request = {.longest = 14, .shortest = 5};
    struct spectrum_fit fit = fit_of(&GRID, map.z, BOUNDARY_PERIODIC, &request);
    assert_int_equal(fit.from_end, SPECTRUM_END_OPTION);
    assert_int_equal(fit.to_end, SPECTRUM_END_OPTION);
    assert_true(fit.trusted_from <= 14 && fit.trusted_to >= 5);
    assert_true(fit.trusted_from > 12 && fit.trusted_to < 5.5);
    assert_true(isnan(fit.rolloff_wavelength.value)); /* the rings hold none */
    assert_true(isnan(fit.short_wavelength.value));
    check_inside(&fit.hurst, 0.7, "H");
    struct map_spectrum *spectrum = NULL;
    struct error err = {0};
    assert_int_equal(map_spectrum_create(&spectrum, &map, NULL), 0);
    request = (struct spectrum_fit_request){.longest = 1};
    assert_int_equal(spectrum_fit_measure(spectrum, &request, &fit, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "no wave of the map"));
    request.longest = 5e-324; /* the side has more such waves than there are numbers */
    assert_int_equal(spectrum_fit_measure(spectrum, &request, &fit, &err), ERROR_INPUT);
    request = (struct spectrum_fit_request){.shortest = 1e6};
    assert_int_equal(spectrum_fit_measure(spectrum, &request, &fit, &err), ERROR_INPUT);
    map_spectrum_destroy(&spectrum);
    free((double *)map.z);
}

/* A bump in the middle of the spectrum is no self-affine law. */
static void other_spectra_are_told(void **state) {
    (void)state;
    static const double WAVE_NUMBER[] = {0.05, 0.3, 0.35, 0.5, 0.55, 1.6};
    static const double DENSITY[] = {1, 0.1, 1, 1, 0.05, 0.01};
    const struct spectrum bump = {.type = SPECTRUM_TABLE,
                                  .table_count = 6,
                                  .table_wave_number = WAVE_NUMBER,
                                  .table_density = DENSITY};
    double *z = surface(&bump, AMPLITUDES_RANDOM, &GRID, 6);
    struct spectrum_fit fit = fit_of(&GRID, z, BOUNDARY_PERIODIC, &BY_THE_MAP);
    assert_true(fit.fitted && fit.deviance > 3);
    free(z);
}

static void maps_that_tell_nothing(void **state) {
    (void)state;
    double z[64] = {0};
    static const size_t SIZES[][2] = {{2, 1}, {8, 8}, {2, 32}, {32, 2}, {64, 1}, {3, 3}};
    for (size_t n = 0; n < sizeof SIZES / sizeof *SIZES; n++)
        for (int rough = 0; rough < 3; rough++)
            for (enum boundary boundary = BOUNDARY_PERIODIC; boundary <= BOUNDARY_OPEN;
                 boundary++) {
                const struct grid grid = {SIZES[n][0], SIZES[n][1], 1, 1};
                for (size_t point = 0; point < 64; point++)
                    z[point] = rough == 0   ? 2
                               : rough == 1 ? (double)(point * point % 7)
                                            : 1e200 * (double)(point * point % 11);
                struct spectrum_fit fit = fit_of(&grid, z, boundary, &BY_THE_MAP);
                struct spectrum law;
                struct error err = {0};
                if (fit.fitted)
                    continue;
                assert_true(isnan(fit.hurst.value) && isnan(fit.rms_height.value));
                assert_true(spectrum_fit_density(&fit, 6) == 0);
                assert_int_equal(spectrum_fit_law(&fit, &law, &err), ERROR_INPUT);
                assert_non_null(strstr(err.text, "no law"));
            }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_spectra_give_their_law), cmocka_unit_test(laws_are_what_they_tell),
        cmocka_unit_test(pieces_hold_the_truth),        cmocka_unit_test(noise_ends_the_trust),
        cmocka_unit_test(an_instrument_is_no_law),      cmocka_unit_test(ranges_that_are_asked_for),
        cmocka_unit_test(other_spectra_are_told),       cmocka_unit_test(maps_that_tell_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
