/* Protects: the law "translation" of a study: what it refuses and why, which amplitudes it takes,
 * and that meshes of other points sample the same surface. */
#include "jobs/contact/contact_level.h"
#include "jobs/surface/realisation_map.h"
#include "jobs/surface/surface_law.h"
#include "schema/json/json.h"
#include "tests/support/check.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static cJSON *case_of(const char *surface) {
    char text[1000];
    snprintf(text, sizeof text,
             "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2%s}}",
             surface);
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

#define MAXIMUM                                                                                    \
    ", \"heights\": {\"distribution\": \"weibull_max\", \"shape\": 1, \"law\": \"translation\""

static void the_law_is_read(void **state) {
    (void)state;
    struct surface_case surface = read(MAXIMUM "}, \"amplitudes\": \"random\"");
    assert_true(surface_case_translated(&surface));
    assert_false(surface_case_band_limited(&surface));
    assert_false(surface_is_iterated(&surface.options));
    surface_case_clear(&surface);
    surface =
        read(", \"heights\": {\"law\": \"translation\"}"); /* Gaussian: nothing to translate */
    assert_false(surface_case_translated(&surface));
    surface_case_clear(&surface);
}

static void what_does_not_belong_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *surface, *fault;
    } ROWS[] = {
        {MAXIMUM "}", "/surface/amplitudes: fixed amplitudes"},
        {MAXIMUM ", \"keep\": \"heights\"}, \"amplitudes\": \"random\"",
         "/surface/heights/keep: is of the law \"iterated\""},
        {MAXIMUM ", \"tolerance\": 0}, \"amplitudes\": \"random\"",
         "/surface/heights/tolerance: is of the law \"iterated\""},
        {MAXIMUM ", \"relaxed_iterations\": 5}, \"amplitudes\": \"random\"",
         "/surface/heights/relaxed_iterations: is of the law \"iterated\""},
        {", \"heights\": {\"distribution\": \"weibull_max\", \"shape\": 0.5, \"law\": "
         "\"translation\"}, \"amplitudes\": \"random\"",
         "/surface/heights/law: these heights and this spectrum go together only so far"},
        {", \"heights\": {\"distribution\": \"samples\", \"samples\": [0, 1, 1, 1, 1, 2, 3, 4], "
         "\"law\": \"translation\"}, \"amplitudes\": \"random\"",
         "/surface/heights/law: heights near"},
    };
    for (size_t a = 0; a < sizeof ROWS / sizeof *ROWS; a++) {
        struct surface_case surface;
        struct error err = {0};
        cJSON *parameters = case_of(ROWS[a].surface);
        assert_int_equal(surface_case_read(&surface, parameters, NULL, &err), ERROR_INPUT);
        if (strncmp(err.text, ROWS[a].fault, strlen(ROWS[a].fault)) != 0)
            fail_msg("%s, expected %s", err.text, ROWS[a].fault);
        cJSON_Delete(parameters);
    }
}

static void a_misfit_may_be_allowed(void **state) {
    (void)state;
    struct study_cost cost = {0};
    struct surface_case surface =
        read(", \"heights\": {\"distribution\": \"weibull_max\", \"shape\": 0.5, \"law\": "
             "\"translation\", \"misfit\": 0.3}, \"amplitudes\": \"random\"");
    surface_law_estimate(surface.translation, &cost);
    assert_true(cost.law_misfit > 0.01 && cost.law_misfit <= 0.3);
    assert_true(cost.law_outside > 0 && cost.law_outside < 0.5);
    surface_case_clear(&surface);
}

/* Amplitudes that are left out are random with this law alone, and those given stay. */
static void amplitudes_follow_the_law(void **state) {
    (void)state;
    static const struct {
        const char *given, *law, *distribution, *expected;
    } ROWS[] = {{"", "translation", "weibull_min", "random"},
                {"", "translation", "gaussian", "fixed"},
                {"", "iterated", "weibull_min", "fixed"},
                {", \"amplitudes\": \"fixed\"", "translation", "weibull_min", "fixed"}};
    for (size_t a = 0; a < sizeof ROWS / sizeof *ROWS; a++) {
        char text[300];
        snprintf(text, sizeof text,
                 ", \"amplitudes\": \"fixed\", \"heights\": {\"distribution\": \"%s\", \"law\": "
                 "\"%s\"}",
                 ROWS[a].distribution, ROWS[a].law);
        cJSON *document = case_of(ROWS[a].given), *parameters = case_of(text);
        assert_int_equal(surface_law_complete(document, parameters, NULL), 0);
        assert_string_equal(cJSON_GetStringValue(json_at(parameters, "/surface/amplitudes")),
                            ROWS[a].expected);
        cJSON_Delete(document);
        cJSON_Delete(parameters);
    }
}

/* Sampled on 12 points a wave from 8, and generated there: within what the inverse of the height
 * function loses at the bound of the heights. */
static void meshes_sample_one_surface(void **state) {
    (void)state;
    struct surface_case own = read(MAXIMUM "}, \"amplitudes\": \"random\"");
    struct surface_case finer =
        read(MAXIMUM "}, \"amplitudes\": \"random\", \"points_per_wavelength\": 12");
    const struct random_key key = {5, 0, 7};
    const struct contact_level level = {.points = 12, .grid = finer.grid};
    struct surface_report report;
    double *z = NULL, *expected = NULL;
    size_t points = grid_points(&finer.grid);
    assert_int_equal(realisation_surface(&own, key, &z, &report, NULL), 0);
    assert_int_equal(realisation_surface(&finer, key, &expected, &report, NULL), 0);
    double *sampled = malloc(points * sizeof *sampled);
    assert_non_null(sampled);
    assert_int_equal(contact_level_sample(&level, &own, &(struct level_source){.rms_height = 1}, z,
                                          sampled, NULL),
                     0);
    for (size_t i = 0; i < points; i++)
        check_close(sampled[i], expected[i], 1e-9);
    free(z);
    free(expected);
    free(sampled);
    surface_case_clear(&own);
    surface_case_clear(&finer);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_law_is_read),
        cmocka_unit_test(what_does_not_belong_is_refused),
        cmocka_unit_test(a_misfit_may_be_allowed),
        cmocka_unit_test(amplitudes_follow_the_law),
        cmocka_unit_test(meshes_sample_one_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
