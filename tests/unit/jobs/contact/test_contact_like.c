/* Protects: a measured surface is pressed, to the bit, as sub-maps of random surfaces are: one of
 * them, given as the measured one, is found equal to itself at each load; its percentile is that of
 * the counts; loads that are not those of the case leave it out. */
#include "core/map/preparation/detrend.h"
#include "jobs/surface/realisation_map.h"
#include "jobs/surface/surface_case.h"
#include "tests/support/contact_document.h"
#include <stdio.h>
#include <stdlib.h>

#define DIGEST "00112233445566778899aabbccddeeff00112233445566778899aabbccddeeff"
static const char STUDY[] =
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.7, \"wavelength_ratio\": 8, \"length_ratio\": 6,"
    " \"points_per_wavelength\": 4, \"rms_slope\": 0.1, \"amplitudes\": \"random\","
    " \"like\": {\"file\": \"x\", \"sha256\": \"" DIGEST "\", \"spacing\": 0.25, \"points\": [90],"
    " \"detrend\": \"plane\"}}, \"contact\": {\"cell_error\": \"none\", \"pressures\":"
    " {\"values\": [0.05, 0.2]}}}";
enum { POINTS = 90, ALL = 8, ITSELF = 3, LOADS = 2 };

/* The sub-map of a realisation, as an instrument would give it. */
static double *piece_of(const cJSON *parameters, uint64_t realisation) {
    struct surface_case surface;
    struct surface_report report;
    struct trend trend;
    double *z = NULL, *piece = calloc(POINTS, sizeof *piece);
    const struct grid grid = {POINTS, 1, 0.25 * POINTS, 0.25};
    assert_non_null(piece);
    assert_int_equal(surface_case_read(&surface, parameters, NULL, NULL), 0);
    assert_int_equal(realisation_surface(&surface,
                                         (struct random_key){CONTACT_SEED, 0, realisation}, &z,
                                         &report, NULL),
                     0);
    memcpy(piece, z, POINTS * sizeof *piece);
    assert_int_equal(detrend(&grid, piece, DETREND_PLANE, &trend, NULL), 0);
    free(z);
    surface_case_clear(&surface);
    return piece;
}

/* The parameters with what pressing the sub-map of a realisation gave. */
static cJSON *measured_study(void) {
    const struct job_kind *kind = kind_find("contact");
    cJSON *parameters = cJSON_Parse(STUDY);
    void *one_case = NULL;
    struct error err = {0};
    assert_non_null(parameters);
    double *piece = piece_of(parameters, ITSELF);
    cJSON *like = cJSON_GetObjectItem(cJSON_GetObjectItem(parameters, "surface"), "like");
    if (kind_case_create(&one_case, kind, parameters, NULL, &err) != 0 ||
        kind->measure_like(one_case, piece, like, &err) != 0)
        fail_msg("%s", err.text);
    kind_case_destroy(kind, &one_case);
    free(piece);
    assert_int_equal(cJSON_GetArraySize(json_at(like, "/contact_areas")), LOADS);
    assert_int_equal(cJSON_GetArraySize(json_at(like, "/contact_gaps")), LOADS);
    return parameters;
}

static const cJSON *find(const cJSON *document, const char *quantity) {
    const cJSON *curve;
    cJSON_ArrayForEach(curve, json_at(document, "/curves")) {
        if (text_is(curve, "/quantity", quantity))
            return curve;
    }
    return NULL;
}

static double value(const cJSON *curve, const char *key, int load) {
    const cJSON *found = cJSON_GetArrayItem(json_at(curve, key), load);
    assert_true(cJSON_IsNumber(found));
    return found->valuedouble;
}

static void a_piece_is_equal_to_itself(void **state) {
    (void)state;
    static const char *const QUANTITIES[][2] = {{"piece_contact_area", "percentile_contact_area"},
                                                {"piece_mean_gap", "percentile_mean_gap"}};
    cJSON *parameters = measured_study();
    char *text = json_print(parameters);
    cJSON *document = solve(text, ALL);
    for (size_t q = 0; q < 2; q++) {
        const cJSON *mean = find(document, QUANTITIES[q][0]);
        const cJSON *percentile = find(document, QUANTITIES[q][1]);
        assert_non_null(mean);
        assert_non_null(percentile);
        for (int load = 0; load < LOADS; load++) {
            /* b below and one equal: 100 (b + 1)/(n + 1); none equal would end in a half */
            double place = value(percentile, "/y", load) / 100 * (ALL + 1);
            assert_true(fabs(place - rint(place)) < 1e-9);
            assert_true(place > 0.9 && place < ALL + 0.1);
            assert_true(value(percentile, "/standard_error", load) > 0);
            assert_true(value(mean, "/standard_error", load) > 0);
            const char *key = q == 0 ? "/surface/like/contact_areas" : "/surface/like/contact_gaps";
            assert_true(value(json_at(mean, "/theory"), "/measured", load) ==
                        value(parameters, key, load));
        }
    }
    cJSON_Delete(document);
    cJSON_Delete(parameters);
    free(text);
}

/* A case of other loads, or of another scale, has no contact of the map to compare with. */
static void other_loads_are_left_out(void **state) {
    (void)state;
    static const char *const OTHERS[][2] = {{"\"values\":[0.05,0.2]", "\"values\":[0.05,0.1]"},
                                            {"\"rms_slope\":0.1", "\"rms_slope\":0.2"},
                                            {"\"points\":[90]", "\"points\":[97]"}};
    cJSON *parameters = measured_study();
    char *text = json_print(parameters);
    for (size_t o = 0; o < sizeof OTHERS / sizeof *OTHERS; o++) {
        char *changed = strdup(text), *at = strstr(changed, OTHERS[o][0]);
        assert_non_null(at);
        assert_int_equal(strlen(OTHERS[o][0]), strlen(OTHERS[o][1]));
        memcpy(at, OTHERS[o][1], strlen(OTHERS[o][1]));
        cJSON *document = solve(changed, 2);
        assert_null(find(document, "percentile_contact_area"));
        cJSON_Delete(document);
        free(changed);
    }
    cJSON_Delete(parameters);
    free(text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_piece_is_equal_to_itself),
        cmocka_unit_test(other_loads_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
