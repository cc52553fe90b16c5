/* Protects: surfaces of a study hold the measured patch, but for its trend, and differ elsewhere;
 * results have the area within the patch, and the error "patch" by the spread of draws, in the same
 * digits however they are divided; what such a study excludes is refused by name. How often the
 * error holds the truth is in tests/validation/jobs/test_hold_coverage.c. */
#include "core/statistics/grooves/map_grooves.h"
#include "jobs/contact/case/contact_case.h"
#include "jobs/contact/contact_level.h"
#include "jobs/like/like_fit.h"
#include "jobs/like/like_hold.h"
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "jobs/statistics/statistics_case.h"
#include "jobs/surface/realisation_map.h"
#include "schema/json/json.h"
#include "schema/result/total.h"
#include "tests/support/check.h"
#include "tests/support/scalar_of.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 48, SEED = 5, REALISATIONS = 4 };
static const char TRUTH[] = "{\"surface\": {\"hurst\": 0.7, \"wavelength_ratio\": 12,"
                            " \"rolloff_ratio\": 4, \"length_ratio\": 2,"
                            " \"points_per_wavelength\": 4, \"rms_slope\": 0.1,"
                            " \"amplitudes\": \"random\"}}";

/* A patch of a surface, without its plane; hole: one point of it is missing. */
static struct height_map patch_of(bool hole) {
    cJSON *truth = cJSON_Parse(TRUTH);
    struct surface_case one = {0};
    struct height_map map = {.xy_unit = "m", .z_unit = "m"};
    struct surface_report report;
    struct trend trend;
    double *z = NULL;
    assert_int_equal(surface_case_read(&one, truth, NULL, NULL), 0);
    assert_int_equal(realisation_surface(&one, (struct random_key){SEED, 0, 0}, &z, &report, NULL),
                     0);
    assert_int_equal(one.grid.nx, 2 * SIDE);
    assert_int_equal(height_map_shape(&map, SIDE, SIDE, grid_dx(&one.grid), NULL), 0);
    map.z = calloc((size_t)SIDE * SIDE, sizeof *map.z);
    assert_non_null(map.z);
    assert_non_null(z);
    for (size_t p = 0; p < (size_t)SIDE * SIDE; p++)
        map.z[p] = hole && p == 500 ? (double)NAN : z[p / SIDE * one.grid.nx + p % SIDE];
    assert_int_equal(detrend(&map.grid, map.z, DETREND_PLANE, &trend, NULL), 0);
    free(z);
    surface_case_clear(&one);
    cJSON_Delete(truth);
    return map;
}

/* The parameters of a case whose surfaces hold the patch, beside what its "surface" says. */
static cJSON *held(const struct height_map *map, const char *surface) {
    const struct like_source source = {
        .file = "patch",
        .format = "npy",
        .prepared = "",
        .sha256 = "00112233445566778899aabbccddeeff00112233445566778899aabbccddeeff",
        .detrend = DETREND_PLANE,
        .uncertainty = LIKE_UNCERTAINTY_POSTERIOR,
        .off_stated = true,
        .hold = true};
    cJSON *parameters = cJSON_CreateObject(), *object = cJSON_Parse(surface);
    struct error err = {0};
    assert_true(cJSON_AddItemToObject(parameters, "surface", object));
    if (like_fit(object, map, &source, &err) != 0)
        fail_msg("%s", err.text);
    return parameters;
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

static void surfaces_hold_the_patch(void **state) {
    (void)state;
    struct height_map map = patch_of(true);
    cJSON *parameters = held(&map, "{}");
    const double length = json_number_at(parameters, "/surface/like/wavelength", NAN);
    struct statistics_case one = {0};
    struct error err = {0};
    double *z[2], square = 0, far = 0;
    if (statistics_case_read(&one, parameters, NULL, &err) != 0)
        fail_msg("%s", err.text);
    assert_non_null(one.surface.held);
    assert_int_equal(one.surface.grid.nx, 2 * SIDE);
    assert_false(like_case_is_cut(&one.like));
    for (size_t p = 0; p < (size_t)SIDE * SIDE; p++)
        square += isnan(map.z[p]) ? 0 : map.z[p] * map.z[p] / (SIDE * SIDE);
    for (uint64_t r = 0; r < 2; r++) {
        double rest[SIDE * SIDE], off = 0;
        struct surface_report report;
        struct trend trend;
        if (realisation_surface(&one.surface, (struct random_key){SEED, 0, r}, &z[r], &report,
                                &err) != 0)
            fail_msg("%s", err.text);
        for (size_t p = 0; p < (size_t)SIDE * SIDE; p++)
            rest[p] = z[r][p / SIDE * 2 * SIDE + p % SIDE] * length - map.z[p];
        assert_int_equal(detrend(&map.grid, rest, DETREND_PLANE, &trend, NULL), 0);
        for (size_t p = 0; p < (size_t)SIDE * SIDE; p++)
            off += isnan(rest[p]) ? 0 : rest[p] * rest[p] / (SIDE * SIDE);
        print_message("realisation %d: %.2g of the RMS height off, slope %.3g\n", (int)r,
                      sqrt(off / square), trend.slope_x);
        assert_true(off > 0 && sqrt(off / square) < 3e-3);
        assert_true(fabs(trend.slope_x) > 1e-6); /* the patch is level in no surface */
    }
    for (size_t p = 0; p < (size_t)SIDE; p++)
        far = fmax(far, fabs(z[0][SIDE * 3 / 2 * 2 * SIDE + SIDE / 2 + p] -
                             z[1][SIDE * 3 / 2 * 2 * SIDE + SIDE / 2 + p]) *
                            length);
    assert_true(far > 0.3 * sqrt(square));
    free(z[0]);
    free(z[1]);
    statistics_case_clear(&one);
    cJSON_Delete(parameters);
    height_map_clear(&map);
}

/* Grooves of a patch are held with it and go on in each draw, with whole numbers of periods, also
 * between the points of the cell. */
static void grooves_go_on(void **state) {
    (void)state;
    enum { CELL = 2 * SIDE, FINE = 2 * CELL };
    struct height_map map = patch_of(false);
    double square = 0;
    for (size_t p = 0; p < (size_t)SIDE * SIDE; p++)
        square += map.z[p] * map.z[p] / (SIDE * SIDE);
    for (size_t y = 0; y < SIDE; y++)
        for (size_t x = 0; x < SIDE; x++)
            map.z[y * SIDE + x] +=
                1.5 * sqrt(square) * cos(2 * M_PI * (0.14 * (double)x + 0.031 * (double)y));
    cJSON *parameters = held(&map, "{}");
    const double length = json_number_at(parameters, "/surface/like/wavelength", NAN);
    const char *prepared = cJSON_GetStringValue(json_at(parameters, "/surface/like/prepared"));
    assert_non_null(strstr(prepared, " beyond the map, which holds them as they are"));
    struct statistics_case one = {0};
    struct error err = {0};
    if (statistics_case_read(&one, parameters, NULL, &err) != 0)
        fail_msg("%s", err.text);
    assert_non_null(one.surface.grooves);
    assert_int_equal(one.surface.held->grooves->families, 1);
    double *z = NULL, rest[SIDE * SIDE], off = 0;
    struct surface_report report;
    struct trend trend;
    const struct random_key key = {SEED, 0, 1};
    assert_int_equal(realisation_surface(&one.surface, key, &z, &report, &err), 0);
    for (size_t p = 0; p < (size_t)SIDE * SIDE; p++)
        rest[p] = z[p / SIDE * CELL + p % SIDE] * length - map.z[p];
    assert_int_equal(detrend(&map.grid, rest, DETREND_PLANE, &trend, NULL), 0);
    for (size_t p = 0; p < (size_t)SIDE * SIDE; p++)
        off += rest[p] * rest[p] / (SIDE * SIDE);
    print_message("with grooves %.2g of the RMS height off\n", sqrt(off / square));
    assert_true(sqrt(off / square) < 3e-3);
    for (size_t p = 0; p < (size_t)SIDE * SIDE; p++) /* beyond it, along x */
        rest[p] = z[p / SIDE * CELL + SIDE + p % SIDE] * length;
    const struct measured_map beyond = {&map.grid, rest, BOUNDARY_OPEN};
    struct map_grooves found;
    assert_int_equal(map_grooves_find(&found, &beyond, NULL), 0);
    assert_int_equal(found.families, 1);
    /* 2*6.72 periods along x are 13, of which 6.28 lie here */
    print_message("%.3f and %.3f periods beyond the map\n", found.family[0].lines.mx,
                  found.family[0].lines.my);
    assert_true(fabs(found.family[0].lines.mx - (13 - 0.14 * SIDE)) < 0.15);
    assert_true(fabs(found.family[0].lines.my - 0.031 * SIDE) < 0.15);
    struct contact_level level = {.grid = {FINE, FINE, one.surface.grid.lx, one.surface.grid.ly}};
    double *fine = calloc((size_t)FINE * FINE, sizeof *fine);
    const struct level_source source = {.key = key, .rms_height = 1};
    assert_non_null(fine);
    assert_int_equal(contact_level_sample(&level, &one.surface, &source, z, fine, &err), 0);
    for (size_t j = 0; j < CELL; j++)
        for (size_t i = 0; i < CELL; i++)
            assert_true(fabs(fine[2 * j * FINE + 2 * i] - z[j * CELL + i]) * length <
                        1e-6 * sqrt(square));
    free(fine);
    free(z);
    statistics_case_clear(&one);
    cJSON_Delete(parameters);
    height_map_clear(&map);
}

static void areas_have_the_spread_of_draws(void **state) {
    (void)state;
    struct height_map map = patch_of(false);
    cJSON *parameters = held(&map, "{}");
    struct case_result result, again;
    cJSON_AddItemToObject(parameters, "contact",
                          cJSON_Parse("{\"pressures\": {\"values\": [0.05, 0.2]}}"));
    run("contact", parameters, REALISATIONS, &result);
    run("contact", parameters, 1, &again);
    const struct curve *within = result_curve(&result, "held_contact_area");
    const struct curve *whole = result_curve(&result, "contact_area");
    const struct curve *same = result_curve(&again, "held_contact_area");
    assert_non_null(within);
    for (size_t k = 0; k < 2; k++) {
        const struct scalar_error of_within = curve_error_at(within, ERROR_PATCH, k);
        const struct scalar_error of_whole = curve_error_at(whole, ERROR_PATCH, k);
        print_message("within %.4f +- %.4f, whole %.4f +- %.4f\n", within->y[k], of_within.bound,
                      whole->y[k], of_whole.bound);
        assert_true(within->y[k] > 0.2 * whole->y[k] && within->y[k] < 3 * whole->y[k]);
        assert_true(of_within.known && of_within.value == 0);
        /* Student's t of 3 degrees of freedom, and one more draw */
        check_relative(of_within.bound, 3.182446 * 2 * sqrt(1.25) * within->standard_error[k],
                       1e-4);
        assert_true(of_whole.known && of_whole.bound > 0);
        assert_true(within->y[k] == same->y[k]);
        assert_false(curve_error_at(within, ERROR_CELL, k).known);
    }
    result_clear(&result);
    result_clear(&again);
    run("statistics", parameters, REALISATIONS, &result);
    const struct scalar *height = scalar_of(&result, "rms_height");
    assert_true(height->errors[ERROR_PATCH].known && height->errors[ERROR_PATCH].bound > 0);
    result_clear(&result);
    cJSON_Delete(parameters);
    height_map_clear(&map);
}

/* What the case says once `surface` has replaced a member of its surface. */
static void refused(const cJSON *whole, const char *name, const char *value, const char *words) {
    cJSON *parameters = cJSON_Duplicate(whole, 1);
    cJSON *surface = cJSON_GetObjectItem(parameters, "surface");
    cJSON *like = cJSON_GetObjectItem(surface, "like");
    const bool own = strcmp(name, "heights") != 0 && cJSON_HasObjectItem(like, name);
    cJSON *of = own ? like : surface;
    struct statistics_case one = {0};
    struct error err = {0};
    cJSON_DeleteItemFromObject(of, name);
    if (value != NULL)
        cJSON_AddItemToObject(of, name, cJSON_Parse(value));
    assert_int_equal(statistics_case_read(&one, parameters, NULL, &err), ERROR_INPUT);
    if (strstr(err.text, words) == NULL)
        fail_msg("no \"%s\" in %s", words, err.text);
    statistics_case_clear(&one);
    cJSON_Delete(parameters);
}

static void what_it_excludes_is_refused(void **state) {
    (void)state;
    struct height_map map = patch_of(false);
    cJSON *parameters = held(&map, "{}");
    refused(parameters, "patch", NULL, "/surface/like/patch");
    refused(parameters, "patch", "\"AACAPwAAAEA=\"", "8 bytes");
    refused(parameters, "patch", "\"?\"", "base64");
    refused(parameters, "length_ratio", "4", "twice the sides");
    refused(parameters, "hold", "false", "nothing holds it");
    refused(parameters, "heights", "{\"distribution\": \"weibull_min\", \"shape\": 2}",
            "heights of the patch");
    cJSON_Delete(parameters);
    height_map_clear(&map);
    struct height_map large = {.grid = {1024, 512, 1024, 512}};
    struct error err = {0};
    char *text = NULL;
    assert_int_equal(like_hold_text(&text, &large, 1, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "262144 points"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces_hold_the_patch),
        cmocka_unit_test(grooves_go_on),
        cmocka_unit_test(areas_have_the_spread_of_draws),
        cmocka_unit_test(what_it_excludes_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
