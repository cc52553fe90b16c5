/* Protects: the error of discretisation of spectral density and autocorrelation: none of the waves
 * of a band; of means over rings at least what they are off the mean over circles; of heights that
 * are assigned point by point the change on every second point; none of what theory expects. */
#include "jobs/statistics/statistics_case.h"
#include "jobs/statistics/statistics_expectation.h"
#include "jobs/statistics/statistics_scalars.h"
#include "tests/support/scalar_of.h"
#include "tests/support/statistics_study.h"

enum { DRAWN = 3 };

static struct case_result result_of(const char *surface, cJSON **parameters) {
    char text[400];
    struct case_result out = {0};
    struct error err = {0};
    snprintf(text, sizeof text,
             "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4,"
             " \"points_per_wavelength\": 8, \"length_ratio\": %s}}",
             surface);
    struct job_runner *runner = runner_of(text);
    struct job_merger *merger = merger_of(text);
    struct block_result block = run(runner, 0, DRAWN);
    merge(merger, &block);
    if (merger_result(merger, &out, &err) != 0)
        fail_msg("%s", err.text);
    *parameters = parse(text);
    block_result_clear(&block);
    merger_destroy(&merger);
    runner_destroy(&runner);
    return out;
}

static const struct curve_error *error_of(const struct case_result *result, const char *quantity) {
    const struct curve *curve = result_curve(result, quantity);
    assert_non_null(curve);
    assert_true(curve->errors[ERROR_DISCRETISATION].applies);
    return &curve->errors[ERROR_DISCRETISATION];
}

/* Of each wave the mean over a circle of radius r is Bessel's function of k r. */
static double circle_mean(const struct modes *modes, double r) {
    const struct grid *grid = &modes->grid;
    double sum = 0, all = 0;
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (long my = -(long)modes->mode_y; my <= (long)modes->mode_y; my++) {
            double power = (mx > 0 ? 2 : 1) * modes_power(modes, mx, my);
            double k = 2 * M_PI * hypot((double)mx / grid->lx, (double)my / grid->ly);
            sum += power * j0(k * r);
            all += power;
        }
    return sum / all;
}

static void check_circles(const char *surface, bool exact) {
    struct statistics_case one_case;
    struct modes *modes = NULL;
    struct error err = {0};
    cJSON *parameters;
    struct case_result result = result_of(surface, &parameters);
    assert_int_equal(statistics_case_read(&one_case, parameters, NULL, &err), 0);
    assert_int_equal(modes_create(&modes, &one_case.surface.spectrum, &one_case.surface.grid, &err),
                     0);
    const struct curve *acf = result_curve(&result, "acf");
    const struct curve_error *error = error_of(&result, "acf"), *psd = error_of(&result, "psd");
    double off = 0, bound = 0, most = 0;
    size_t within = 0;
    for (size_t a = 0; a < acf->n; a++) {
        double less = acf->theories[0].y[a] - circle_mean(modes, acf->x[a]);
        assert_true(error->value[a] == 0 && error->bound[a] >= 0);
        within += fabs(less) <= error->bound[a] + 1e-12;
        off += less * less;
        bound += error->bound[a] * error->bound[a];
        most = fmax(most, fabs(less));
    }
    assert_true(exact == (acf->standard_error[1] == 0));
    assert_true(error->bound[0] == 0 && most > 1e-3);
    assert_true(bound > off && bound < 100 * off);
    assert_true(10 * within >= 9 * acf->n);
    for (size_t a = 0; a < result_curve(&result, "psd")->n; a++)
        assert_true(psd->value[a] == 0 && psd->bound[a] == 0 && psd->standard_error[a] == 0);
    modes_destroy(&modes);
    statistics_case_clear(&one_case);
    result_clear(&result);
    cJSON_Delete(parameters);
}

static void rings_are_near_circles(void **state) {
    (void)state;
    check_circles("2", true);
    check_circles("4, \"length_ratio_y\": 1", true);
    check_circles("2, \"amplitudes\": \"random\"", false);
}

/* Rings of profiles are single lags. */
static void profiles_have_no_rings(void **state) {
    (void)state;
    cJSON *parameters;
    struct case_result result = result_of("2, \"dimension\": 1", &parameters);
    const struct curve_error *error = error_of(&result, "acf");
    for (size_t a = 0; a < result_curve(&result, "acf")->n; a++)
        check_close(error->bound[a], 0, 1e-14);
    cJSON_Delete(parameters);
    result_clear(&result);
}

static void waves_beyond_the_grid_are_folded(void **state) {
    (void)state;
    cJSON *parameters;
    struct error err = {0};
    struct case_result result =
        result_of("2, \"heights\": {\"distribution\": \"weibull_max\", \"shape\": 2, \"keep\":"
                  " \"heights\"}",
                  &parameters);
    struct case_result expected = {0};
    const struct curve *psd = result_curve(&result, "psd"), *acf = result_curve(&result, "acf");
    const struct curve_error *folded = error_of(&result, "psd"), *rings = error_of(&result, "acf");
    size_t known = 0;
    for (size_t a = 0; a < psd->n; a++) {
        bool below = a + 1 < 16; /* of 64 points: rings of every second one */
        assert_true(isnan(folded->value[a]) == !below && isnan(folded->bound[a]) == !below);
        known += folded->bound[a] > 0 && folded->standard_error[a] > 0;
    }
    assert_int_equal(known, 15);
    for (size_t a = 1; a < acf->n; a++)
        assert_true(rings->value[a] == 0 && rings->bound[a] > 0 && rings->standard_error[a] > 0);
    /* heights jump between points no more than waves of the band do: nearly nothing is folded */
    assert_true(folded->bound[2] < 0.1 * psd->y[2]);
    assert_int_equal(statistics_expectation(parameters, false, &expected, &err), 0);
    for (size_t a = 0; a < expected.curve_count; a++)
        assert_false(expected.curves[a].errors[ERROR_DISCRETISATION].applies);
    cJSON_Delete(parameters);
    result_clear(&result);
    result_clear(&expected);
}

/* The realisation that results are compared with, generated and measured anew. */
static void check_measures(const char *surface, const struct surface_options *options) {
    char text[400];
    struct generator *generator = NULL;
    struct roughness expected;
    struct moments moments;
    snprintf(text, sizeof text,
             "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 4,"
             " \"points_per_wavelength\": 4, %s}}",
             surface);
    const struct grid grid = {64, 64, 16, 16};
    const struct spectrum spectrum = {.type = SPECTRUM_SELF_AFFINE,
                                      .hurst = 0.8,
                                      .wavelength_long = 4,
                                      .wavelength_rolloff = 4,
                                      .wavelength_short = 1};
    static double z[64 * 64], x[64 * 64], density[64 * 64], correlation[64 * 64];
    static double whole[64 * 64], band[64 * 64];
    const struct random_key key = {STUDY_SEED, STUDY_CASE, 0};
    assert_int_equal(generator_create(&generator, &spectrum, &grid, options, NULL), 0);
    assert_int_equal(generator_run(generator, key, z, NULL, NULL), 0);
    roughness_measure(&grid, z, &expected);
    assert_int_equal(roughness_spectral(&grid, z, &moments, NULL), 0);
    assert_int_equal(psd_measure(&grid, z, x, density, NULL), 0);
    assert_int_equal(acf_measure(&grid, z, x, correlation, NULL), 0);
    psd_of_modes(generator_modes(generator), x, whole);
    psd_of_band(generator_modes(generator), x, band);

    struct case_result result = {0};
    struct job_runner *runner = runner_of(text);
    struct job_merger *merger = merger_of(text);
    struct block_result block = run(runner, 0, 1);
    const double *found = block.scalars;
    check_relative(found[SCALAR_RMS_HEIGHT], expected.rms_height, 1e-12);
    check_relative(found[SCALAR_RMS_SLOPE], expected.rms_slope, 1e-12);
    check_relative(found[SCALAR_RMS_CURVATURE], expected.rms_curvature, 1e-12);
    check_relative(found[SCALAR_M4_DIFFERENCE], expected.m4, 1e-12);
    check_relative(found[SCALAR_NAYAK_ALPHA_DIFFERENCE], expected.nayak_alpha, 1e-12);
    check_close(found[SCALAR_SKEWNESS], expected.skewness, 1e-12);
    check_relative(found[SCALAR_KURTOSIS], expected.kurtosis, 1e-12);
    check_relative(found[SCALAR_M0], moments.m0, 1e-12);
    check_relative(found[SCALAR_M4], moments.m4, 1e-12);
    check_relative(found[SCALAR_NAYAK_ALPHA], moments.nayak_alpha, 1e-12);
    merge(merger, &block);
    assert_int_equal(merger_result(merger, &result, NULL), 0);
    const struct curve *psd = result_curve(&result, "psd"), *acf = result_curve(&result, "acf");
    for (size_t a = 1; a <= psd->n;
         a++) { /* bin 0 is the mean; others are over waves of the band */
        double share = whole[a] > 0 ? band[a] / whole[a] : 0;
        check_close(psd->y[a - 1], density[a] * share, 1e-12 * density[5]);
    }
    for (size_t a = 0; a < acf->n; a++)
        check_close(acf->y[a], correlation[a], 1e-12);
    result_clear(&result);
    block_result_clear(&block);
    merger_destroy(&merger);
    runner_destroy(&runner);
    generator_destroy(&generator);
}

/* With random amplitudes all that a spectrum holds is taken from the one that was drawn: the same,
 * to 12 digits, as is measured on the heights. */
static void drawn_spectra_are_as_measured(void **state) {
    (void)state;
    struct surface_options options = SURFACE_DEFAULTS;
    options.amplitudes = AMPLITUDES_RANDOM;
    check_measures("\"amplitudes\": \"random\"", &options);
    options.heights = (struct heights){.type = HEIGHTS_WEIBULL_MAX, .shape = 2};
    check_measures("\"amplitudes\": \"random\","
                   " \"heights\": {\"distribution\": \"weibull_max\", \"shape\": 2}",
                   &options);
}

/* With grooves the spectrum asked for is that of the random part, and nothing is known of what
 * differences see. */
static void grooves_are_beside_the_random_part(void **state) {
    (void)state;
    static const char *const SPECTRA[] = {"psd", "acf"};
    static const enum statistics_scalar OF_GRID[] = {SCALAR_RMS_SLOPE, SCALAR_RMS_CURVATURE,
                                                     SCALAR_M2_DIFFERENCE,
                                                     SCALAR_NAYAK_ALPHA_DIFFERENCE};
    cJSON *parameters;
    struct case_result result =
        result_of("2, \"grooves\": {\"period\": 4, \"depth\": 2}", &parameters);
    for (int s = 0; s < 2; s++) {
        const struct curve *curve = result_curve(&result, SPECTRA[s]);
        assert_non_null(curve);
        assert_int_equal(curve->theory_count, 1);
        assert_string_equal(curve->theories[0].name, "random_part");
    }
    for (size_t a = 0; a < sizeof OF_GRID / sizeof *OF_GRID; a++) {
        const char *name = statistics_scalar_name(OF_GRID[a]);
        double grid = 0;
        for (size_t n = 0; n < result.scalar_count; n++)
            if (strcmp(result.scalars[n].name, name) == 0)
                grid = result.scalars[n].grid;
        assert_true(isnan(grid));
    }
    assert_null(result_scalar(&result, "isotropy"));
    assert_true(isnan(result_scalar(&result, "summit_density")->theory));
    cJSON_Delete(parameters);
    result_clear(&result);
}

/* Density and theory of a surface with a lay are means over the same waves of a ring: with the
 * prescribed spectrum in every surface they are the same. */
static void a_lay_has_the_prescribed_density(void **state) {
    (void)state;
    cJSON *parameters;
    struct case_result result = result_of("4, \"anisotropy\": 4", &parameters);
    const struct curve *psd = result_curve(&result, "psd");
    size_t compared = 0;
    assert_int_equal(psd->theory_count, 1);
    for (size_t a = 0; a < psd->n; a++) {
        check_relative(psd->theories[0].y[a], psd->y[a], 1e-12);
        compared += psd->y[a] > 0;
    }
    assert_true(compared > 10);
    cJSON_Delete(parameters);
    result_clear(&result);
}

/* Spectra of surfaces with a lay are not isotropic, nor is the square of an exponential
 * autocorrelation's waves. Moments by differences of heights that are set point by point do not
 * follow from the spectrum; of a spectrum that is kept they do. */
static void theory_of_moments_where_it_holds(void **state) {
    (void)state;
#define WEIBULL "\"heights\": {\"distribution\": \"weibull_max\", \"shape\": 2"
    static const struct {
        const char *surface;
        bool isotropic, differences;
    } CASES[] = {
        {"2", true, true},
        {"2, \"anisotropy\": 2", false, true},
        {"2, " WEIBULL "}", true, true},
        {"2, " WEIBULL ", \"keep\": \"heights\"}", true, false},
    };
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        cJSON *parameters;
        struct case_result result = result_of(CASES[c].surface, &parameters);
        const struct scalar *isotropy = scalar_of(&result, "isotropy");
        assert_true(CASES[c].isotropic ? isotropy->theory == 1 : isnan(isotropy->theory));
        assert_true(isnan(isotropy->grid) == !CASES[c].differences);
        assert_true(isnan(scalar_of(&result, "rms_slope")->grid) == !CASES[c].differences);
        cJSON_Delete(parameters);
        result_clear(&result);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rings_are_near_circles),
        cmocka_unit_test(profiles_have_no_rings),
        cmocka_unit_test(waves_beyond_the_grid_are_folded),
        cmocka_unit_test(drawn_spectra_are_as_measured),
        cmocka_unit_test(grooves_are_beside_the_random_part),
        cmocka_unit_test(a_lay_has_the_prescribed_density),
        cmocka_unit_test(theory_of_moments_where_it_holds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
