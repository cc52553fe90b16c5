/* Protects: what a patch leaves open of surfaces like it is estimated from surfaces whose
 * parameters are fitted to sub-maps: reproducibly, block by block, as far as it was fitted and the
 * study did not give it. The error has the size by which sub-maps scatter. Studies that do not ask
 * for it are as before. How often it holds the truth is in
 * tests/validation/jobs/test_like_coverage.c. */
#include "jobs/like/like_draw.h"
#include "jobs/like/like_fit.h"
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "jobs/statistics/statistics_case.h"
#include "jobs/surface/realisation_map.h"
#include "jobs/surface/surface_case.h"
#include "schema/json/json.h"
#include "schema/result/total.h"
#include "tests/support/check.h"
#include "tests/support/effort.h"
#include "tests/support/scalar_of.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 64, SEED = 3, REALISATIONS = 8 };

static const char TRUTH[] = "{\"surface\": {\"hurst\": 0.7, \"wavelength_ratio\": 12,"
                            " \"rolloff_ratio\": 4, \"length_ratio\": 2.6666666666666667,"
                            " \"points_per_wavelength\": 4, \"rms_slope\": 0.1,"
                            " \"amplitudes\": \"random\"}}";

static struct like_source source_of(enum like_spectrum spectrum, enum like_heights heights) {
    return (struct like_source){
        .file = "patch",
        .format = "npy",
        .prepared = "",
        .sha256 = "00112233445566778899aabbccddeeff00112233445566778899aabbccddeeff",
        .detrend = DETREND_PLANE,
        .spectrum = spectrum,
        .heights = heights,
        .uncertainty = LIKE_UNCERTAINTY_POSTERIOR,
        .off_stated = true};
}

/* Returns the parameters of a case of surfaces like a patch, with what its "surface" says. */
static cJSON *case_of(const char *surface, const struct like_source *source) {
    cJSON *truth = cJSON_Parse(TRUTH), *parameters = cJSON_CreateObject();
    struct surface_case one = {0};
    struct height_map map = {.xy_unit = "m", .z_unit = "m"};
    struct surface_report report;
    struct trend trend;
    struct error err = {0};
    double *z = NULL;
    if (surface_case_read(&one, truth, NULL, &err) != 0 ||
        realisation_surface(&one, (struct random_key){SEED, 0, 0}, &z, &report, &err) != 0)
        fail_msg("%s", err.text);
    assert_int_equal(one.grid.nx, 2 * SIDE);
    assert_int_equal(height_map_shape(&map, SIDE, SIDE, grid_dx(&one.grid), &err), 0);
    map.z = calloc((size_t)SIDE * SIDE, sizeof *map.z);
    assert_non_null(map.z);
    for (size_t j = 0; j < SIDE && z != NULL; j++)
        memcpy(map.z + j * SIDE, z + j * one.grid.nx, SIDE * sizeof *z);
    assert_int_equal(detrend(&map.grid, map.z, DETREND_PLANE, &trend, &err), 0);
    cJSON *object = cJSON_Parse(surface);
    assert_true(cJSON_AddItemToObject(parameters, "surface", object));
    if (like_fit(object, &map, source, &err) != 0)
        fail_msg("%s", err.text);
    free(z);
    height_map_clear(&map);
    surface_case_clear(&one);
    cJSON_Delete(truth);
    return parameters;
}

static cJSON *like_of(const cJSON *parameters) {
    cJSON *surface = cJSON_GetObjectItemCaseSensitive(parameters, "surface");
    return cJSON_GetObjectItemCaseSensitive(surface, "like");
}

static void set_uncertainty(const cJSON *parameters, const char *uncertainty) {
    cJSON *like = like_of(parameters);
    cJSON_DeleteItemFromObject(like, "uncertainty");
    if (uncertainty != NULL)
        cJSON_AddStringToObject(like, "uncertainty", uncertainty);
}

static void run(const char *name, const cJSON *parameters, uint64_t block,
                struct case_result *out) {
    const struct job_kind *kind = kind_find(name);
    struct job_runner *runner = NULL;
    struct job_merger *merger = NULL;
    struct error err = {0};
    *out = (struct case_result){0};
    if (runner_create(&runner, kind, parameters, NULL, SEED, 0, &err) != 0 ||
        merger_create(&merger, kind, parameters, &err) != 0)
        fail_msg("%s", err.text);
    for (uint64_t first = 0; first < REALISATIONS; first += block) {
        struct block_result result = {0};
        if (runner_run(runner, first, block, NULL, &result, &err) != 0 ||
            merger_add(merger, &result, &err) != 0)
            fail_msg("%s", err.text);
        block_result_clear(&result);
    }
    if (merger_result(merger, out, &err) != 0)
        fail_msg("%s", err.text);
    merger_destroy(&merger);
    runner_destroy(&runner);
}

static const struct scalar_error *patch_of(const struct case_result *result, const char *name) {
    return &scalar_of(result, name)->errors[ERROR_PATCH];
}

static double deviation_of(const struct case_result *result, const char *name) {
    return scalar_of(result, name)->standard_error * sqrt(REALISATIONS);
}

/* A bound is Student's 2.365 of 7 degrees of freedom, and 1.06 for one more draw. RMS height and
 * slope are fitted to those of the sub-map, and scatter as those of sub-maps do. Two deviations
 * from 8 values each have a ratio within a factor of 3 in 99 % (the F distribution). */
static void error_is_the_scatter_of_patches(void **state) {
    (void)state;
    static const char *const NAMES[] = {"rms_height", "rms_slope", "rms_curvature"};
    const struct like_source source = source_of(LIKE_SPECTRUM_TABLE, LIKE_HEIGHTS_GAUSSIAN);
    struct case_result whole, parts, none;
    cJSON *parameters = case_of("{}", &source);
    run("statistics", parameters, REALISATIONS, &whole);
    run("statistics", parameters, 4, &parts);
    set_uncertainty(parameters, "none");
    run("statistics", parameters, REALISATIONS, &none);
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++) {
        char piece[40];
        snprintf(piece, sizeof piece, "piece_%s", NAMES[n]);
        const struct scalar_error *error = patch_of(&whole, NAMES[n]);
        const double ratio = error->bound / (2.365 * sqrt(9. / 8) * deviation_of(&whole, piece));
        print_message("%s: bound %.3g, over that of sub-maps %.2f\n", NAMES[n], error->bound,
                      ratio);
        assert_true(error->applies && error->known && ratio > 1. / 3 && ratio < 3);
        assert_true(error->bound == patch_of(&parts, NAMES[n])->bound);
        assert_true(error->value == patch_of(&parts, NAMES[n])->value);
        assert_false(patch_of(&none, NAMES[n])->applies);
        assert_true(scalar_of(&none, NAMES[n])->value == scalar_of(&whole, NAMES[n])->value);
    }
    assert_false(patch_of(&whole, "generator_iterations")->applies);
    const struct curve *heights = result_curve(&whole, "height_cdf");
    const struct curve_error *error = &heights->errors[ERROR_PATCH];
    const size_t middle = heights->n / 3; /* about the mean of heights from -4 to 8 deviations */
    assert_true(error->applies && error->bound != NULL && error->bound[middle] > 0 &&
                error->bound[middle] < 0.2);
    result_clear(&whole);
    result_clear(&parts);
    result_clear(&none);
    cJSON_Delete(parameters);
}

/* At one pressure the area of light contact goes as 1/h'. */
static void contact_has_it_by_the_slope(void **state) {
    (void)state;
    const struct like_source source = source_of(LIKE_SPECTRUM_TABLE, LIKE_HEIGHTS_GAUSSIAN);
    struct case_result statistics, contact;
    cJSON *parameters = case_of("{\"points_per_wavelength\": 2.25}", &source);
    run("statistics", parameters, REALISATIONS, &statistics);
    cJSON *options = cJSON_Parse("{\"levels\": [2.25], \"cell_error\": \"none\","
                                 " \"pressures\": {\"values\": [0.05]}}");
    cJSON_AddItemToObject(parameters, "contact", options);
    run("contact", parameters, REALISATIONS, &contact);
    const struct scalar *slope = scalar_of(&statistics, "rms_slope");
    const struct curve *area = result_curve(&contact, "contact_area");
    const struct scalar_error error = curve_error_at(area, ERROR_PATCH, 0);
    const double ratio =
        error.bound / area->y[0] / (slope->errors[ERROR_PATCH].bound / slope->value);
    print_message("relative bound of the area over that of the slope: %.2f\n", ratio);
    assert_true(error.applies && error.known && ratio > 0.5 && ratio < 2);
    result_clear(&statistics);
    result_clear(&contact);
    cJSON_Delete(parameters);
}

/* --- what is drawn --- */

static void read_case(const cJSON *parameters, struct statistics_case *one_case) {
    struct error err = {0};
    if (statistics_case_read(one_case, parameters, NULL, &err) != 0)
        fail_msg("%s", err.text);
}

static void draw_of(const struct statistics_case *one_case, uint64_t realisation,
                    struct like_drawn *out, struct like_draw **draw) {
    struct error err = {0};
    if (like_draw_create(draw, &one_case->like, &one_case->surface, &err) != 0 ||
        like_draw_make(*draw, (struct random_key){SEED, 0, realisation}, false, out, &err) != 0)
        fail_msg("%s", err.text);
}

/* Each source of the spectrum and the heights; another realisation has other parameters, the same
 * one the same to the bit. */
static void draws_are_reproducible(void **state) {
    (void)state;
    static const struct {
        enum like_spectrum spectrum;
        enum like_heights heights;
        const char *surface;
    } CASES[] = {
        {LIKE_SPECTRUM_TABLE, LIKE_HEIGHTS_QUANTILES, "{}"},
        {LIKE_SPECTRUM_FIT, LIKE_HEIGHTS_GAUSSIAN, "{}"},
        {LIKE_SPECTRUM_FIT, LIKE_HEIGHTS_FIT, "{}"},
        {LIKE_SPECTRUM_TABLE, LIKE_HEIGHTS_QUANTILES, "{\"heights\": {\"law\": \"translation\"}}"}};
    for (size_t w = 0; w < sizeof CASES / sizeof *CASES; w += case_step()) {
        const struct like_source source = source_of(CASES[w].spectrum, CASES[w].heights);
        cJSON *parameters = case_of(CASES[w].surface, &source);
        struct statistics_case one_case = {0};
        struct like_drawn drawn[3] = {{0}};
        struct like_draw *draws[3] = {NULL};
        read_case(parameters, &one_case);
        assert_true(like_draw_applies(&one_case.like));
        for (size_t d = 0; d < 3; d++)
            draw_of(&one_case, d == 2 ? 1 : 0, &drawn[d], &draws[d]);
        const size_t points = grid_points(&one_case.surface.grid);
        assert_memory_equal(drawn[0].z, drawn[1].z, points * sizeof(double));
        assert_true(drawn[0].moments.rms_slope != drawn[2].moments.rms_slope);
        assert_true(drawn[0].moments.rms_slope != one_case.surface.spectrum.scale_value);
        check_relative(drawn[0].moments.rms_slope, one_case.surface.spectrum.scale_value, 0.3);
        assert_memory_not_equal(drawn[0].z, drawn[2].z, points * sizeof(double));
        for (size_t d = 0; d < 3; d++)
            like_draw_destroy(&draws[d]);
        statistics_case_clear(&one_case);
        cJSON_Delete(parameters);
    }
}

static void what_a_study_gives_is_held(void **state) {
    (void)state;
    const struct like_source table = source_of(LIKE_SPECTRUM_TABLE, LIKE_HEIGHTS_GAUSSIAN);
    const struct like_source law = source_of(LIKE_SPECTRUM_FIT, LIKE_HEIGHTS_GAUSSIAN);
    cJSON *parameters = case_of("{\"rms_slope\": 0.25, \"anisotropy\": 2}", &table);
    struct statistics_case one_case = {0};
    struct like_drawn drawn = {0};
    struct like_draw *draw = NULL;
    read_case(parameters, &one_case);
    draw_of(&one_case, 0, &drawn, &draw);
    check_relative(drawn.moments.rms_slope, 0.25, 1e-9);
    assert_true(drawn.surface != NULL && drawn.surface->spectrum.anisotropy == 2);
    like_draw_destroy(&draw);
    statistics_case_clear(&one_case);
    cJSON_Delete(parameters);
    parameters = case_of("{\"rolloff_ratio\": 1.5}", &law);
    read_case(parameters, &one_case);
    draw_of(&one_case, 0, &drawn, &draw);
    const struct surface_case *surface = drawn.surface;
    assert_true(surface != NULL &&
                fabs(surface->spectrum.wavelength_long / surface->spectrum.wavelength_rolloff -
                     1.5) < 1e-9);
    like_draw_destroy(&draw);
    statistics_case_clear(&one_case);
    cJSON_Delete(parameters);
    /* nothing is open where the study gives all */
    parameters = case_of("{\"hurst\": 0.7, \"wavelength_ratio\": 12, \"rms_slope\": 0.1,"
                         " \"points_per_wavelength\": 4}",
                         &table);
    assert_string_equal(json_at(like_of(parameters), "/uncertainty")->valuestring, "none");
    cJSON_Delete(parameters);
}

/* A study that was fitted before this was asked has the mark that it had. */
static void older_studies_keep_their_mark(void **state) {
    (void)state;
    const struct like_source source = source_of(LIKE_SPECTRUM_TABLE, LIKE_HEIGHTS_GAUSSIAN);
    static const char *const UNCERTAINTIES[] = {NULL, "none", "posterior"};
    const struct job_kind *kind = kind_find("statistics");
    cJSON *parameters = case_of("{}", &source);
    uint64_t marks[3];
    for (size_t u = 0; u < 3; u++) {
        struct error err = {0};
        set_uncertainty(parameters, UNCERTAINTIES[u]);
        assert_int_equal(kind_fingerprint(kind, parameters, &marks[u], &err), 0);
    }
    assert_true(marks[0] == marks[1] && marks[0] != marks[2]);
    cJSON_Delete(parameters);
}

static void few_draws_have_students_bound(void **state) {
    (void)state;
    const struct like_error two = like_draw_error(3, 0.5, 2), many = like_draw_error(3, 0.5, 10000);
    check_close(two.value, 3, 0);
    check_close(two.bound, 12.706 * 0.5 * sqrt(1.5), 1e-3);
    check_close(two.standard_error, 0.5 / sqrt(2), 1e-12);
    check_close(many.bound, 1.96 * 0.5, 1e-3);
    assert_true(isnan(like_draw_error(3, 0.5, 1).value));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(error_is_the_scatter_of_patches),
                                       cmocka_unit_test(contact_has_it_by_the_slope),
                                       cmocka_unit_test(draws_are_reproducible),
                                       cmocka_unit_test(what_a_study_gives_is_held),
                                       cmocka_unit_test(older_studies_keep_their_mark),
                                       cmocka_unit_test(few_draws_have_students_bound)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
