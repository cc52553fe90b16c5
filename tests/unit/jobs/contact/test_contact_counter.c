/* Protects: two rough faces of a contact study are read as one surface in one cell, and what they
 * cannot have is refused, with its pointer. */
#include "core/surface/spectrum.h"
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/contact_scene.h"
#include "tests/support/check.h"
#include <string.h>

#define PROFILE                                                                                    \
    "\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2, "             \
    "\"rms_slope\": 0.1"
#define FACE "\"hurst\": 0.5, \"wavelength_ratio\": 8, \"rms_slope\": 0.2"
#define DIGEST "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef"
#define STUDY(surface, counter, contact)                                                           \
    "{\"surface\": {" surface "}, \"counter_surface\": {" counter "}, \"contact\": {" contact "}}"

static struct contact_case read_case(const char *text) {
    struct contact_case one_case;
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    if (contact_case_read(&one_case, parameters, 0, NULL, &err) != 0)
        fail_msg("%s: %s", text, err.text);
    cJSON_Delete(parameters);
    return one_case;
}

/* The cell is that of the first face, and the grid resolves the shorter wave: that of the second is
 * half as long where its band is twice as wide, or where twice as many of its longest waves fit. */
static void one_cell(void **state) {
    (void)state;
    static const struct {
        const char *study;
        double shortest;
        size_t points, band;
    } CASES[] = {{STUDY(PROFILE, FACE, ""), 0.5, 128, 16},
                 {STUDY(PROFILE, FACE ", \"length_ratio\": 4", ""), 0.25, 256, 32},
                 {STUDY(PROFILE, FACE ", \"length_ratio\": 1", ""), 1, 64, 8},
                 {STUDY(PROFILE, "\"hurst\": 0.5, \"wavelength_ratio\": 2, \"rms_slope\": 1", ""),
                  2, 64, 8}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct contact_case one_case = read_case(CASES[c].study);
        const struct surface_case *surface = &one_case.surface;
        check_close(surface->counter->spectrum.wavelength_short, CASES[c].shortest, 1e-12);
        assert_true(surface->grid.lx == 8);
        assert_int_equal(surface->grid.nx, CASES[c].points);
        assert_int_equal(one_case.levels[0].grid.nx, CASES[c].points);
        assert_int_equal(one_case.band.x, CASES[c].band);
        assert_false(surface_case_exact(surface));
        assert_true(surface_case_gaussian(surface));
        contact_case_clear(&one_case);
    }
}

/* Scales are those of the sum: root of the sum of squares. Lengths are in lambda_s of the first
 * face, and levels are of the shorter wave. */
static void scales(void **state) {
    (void)state;
    double height, slope;
    struct contact_case one_case = read_case(STUDY(PROFILE, FACE, "\"levels\": [4, 8]"));
    assert_int_equal(contact_case_scale(&one_case, &height, &slope, NULL), 0);
    check_close(slope, hypot(0.1, 0.2), 1e-14);
    assert_int_equal(one_case.levels[0].grid.nx, 64);
    contact_case_clear(&one_case);
    one_case = read_case(
        STUDY("\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2, \"rms_height\": 0.3",
              "\"spectrum\": {\"type\": \"table\", \"wave_number\": [1, 3], \"density\": [1, 1]}, "
              "\"rms_height\": 0.4",
              "\"block_height\": {\"rms_heights\": 160}, \"model\": \"layered\""));
    assert_int_equal(contact_case_scale(&one_case, &height, &slope, NULL), 0);
    check_close(height, 0.5, 1e-14);
    check_close(one_case.blocks[0].height, 80, 1e-10);
    contact_case_clear(&one_case);
}

/* Skewness of the sum of two independent heights, of the same spectrum and opposite skewness. */
static void heights_of_the_sum(void **state) {
    (void)state;
    struct height_moments heights;
    bool known;
    struct contact_case one_case = read_case(
        STUDY(PROFILE ", \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 1.5}",
              "\"hurst\": 0.8, \"wavelength_ratio\": 4, \"rms_slope\": 0.1, \"heights\": "
              "{\"distribution\": \"weibull_max\", \"shape\": 1.5}",
              "\"law_difference\": \"none\""));
    assert_int_equal(surface_case_heights(&one_case.surface, &heights, &known, NULL), 0);
    assert_true(known && surface_case_iterated(&one_case.surface));
    check_close(heights.skewness, 0, 1e-12);
    struct height_moments own;
    assert_int_equal(heights_moments(&one_case.surface.options.heights, &own, NULL), 0);
    check_close(heights.kurtosis, 3 + (own.kurtosis - 3) / 2, 1e-12);
    contact_case_clear(&one_case);
}

/* Loads in Pa are over the E* of both bodies: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2. */
static void loads_in_pascal(void **state) {
    (void)state;
    static const struct {
        const char *study;
        double modulus;
    } CASES[] = {
#define PASCAL                                                                                     \
    "\"young\": 2e9, \"poisson\": 0.25, \"pressures\": {\"values\": [1e6], \"unit\": \"Pa\"}"
        {STUDY(PROFILE, FACE, PASCAL), 2e9 / (1 - 0.0625)},
        {STUDY(PROFILE, FACE ", \"young\": 2e9", PASCAL), 1e9 / (1 - 0.0625)},
        {STUDY(PROFILE, FACE ", \"young\": 1e9, \"poisson\": 0", PASCAL),
         1 / ((1 - 0.0625) / 2e9 + 1e-9)}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct contact_case one_case = read_case(CASES[c].study);
        check_close(one_case.loads[0], 1e6 / (CASES[c].modulus * hypot(0.1, 0.2)), 1e-15);
        contact_case_clear(&one_case);
    }
}

static void faults(void **state) {
    (void)state;
    static const struct {
        const char *study, *pointer, *words;
    } BAD[] = {
        {STUDY(PROFILE, "\"wavelength_ratio\": 4, \"rms_slope\": 1", ""), "/counter_surface/hurst",
         "needs it"},
        {STUDY(PROFILE, FACE ", \"hurst\": 2", ""), "/counter_surface/hurst", "(0, 1]"},
        {STUDY(PROFILE, FACE ", \"rolloff_ratio\": 9", ""), "/counter_surface/rolloff_ratio",
         "more than wavelength_ratio"},
        {STUDY(PROFILE, FACE ", \"anisotropy\": 2", ""), "/counter_surface/anisotropy",
         "one direction"},
        {STUDY(PROFILE, "\"hurst\": 0.5, \"wavelength_ratio\": 8", ""),
         "/counter_surface/rms_slope", "both faces a scale"},
        {STUDY("\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4", FACE, ""),
         "/surface/rms_slope", "both faces a scale"},
        {STUDY(PROFILE, FACE, "\"model\": [\"halfspace\", \"full\"]"), "/contact/model",
         "the model full has the shape of one rough face"},
        {STUDY(PROFILE, FACE ", \"poisson\": 0.2", ""), "/counter_surface/poisson",
         "give its young"},
        {STUDY(PROFILE, FACE ", \"young\": 2", "\"model\": \"layered\""), "/counter_surface/young",
         "infinite half-space"},
        {STUDY(PROFILE, FACE ", \"young\": 2", "\"block_height\": {\"lengths\": 1}"),
         "/counter_surface/young", "infinite half-space"},
        {STUDY(PROFILE, FACE ", \"young\": 2", "\"coating\": {\"thickness\": 1, \"modulus\": 2}"),
         "/counter_surface/young", "a coating"},
        {STUDY(PROFILE, FACE ", \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 2}",
               ""),
         "/contact/law_difference", "two faces"},
        {STUDY(PROFILE ", \"amplitudes\": \"random\", \"heights\": {\"distribution\": "
                       "\"weibull_min\", \"shape\": 3.6, \"law\": \"translation\"}",
               FACE, "\"law_difference\": \"none\""),
         "/surface/heights/law", "no translation"},
        {STUDY(PROFILE,
               "\"spectrum\": {\"type\": \"exponential_acf\", \"length\": [2]}, "
               "\"length_ratio\": 3, \"rms_slope\": 0.1",
               ""),
         "/counter_surface/length_ratio", "self-affine"},
        {"{\"surface\": {" PROFILE
         ", \"like\": {\"file\": \"a.npy\", \"spacing\": 1, \"points\": [9], "
         "\"sha256\": \"" DIGEST "\"}}, \"counter_surface\": {" FACE "}}",
         "/surface/like/file", "as one face"},
        {STUDY(PROFILE ", \"points_per_wavelength\": 10000",
               "\"hurst\": 0.5, \"wavelength_ratio\": 100000, \"rms_slope\": 1, "
               "\"length_ratio\": 4",
               ""),
         "/surface/points_per_wavelength", "too large"},
    };
    for (size_t b = 0; b < sizeof BAD / sizeof *BAD; b++) {
        struct contact_case one_case;
        struct error err = {0};
        struct fault_list list = {0};
        char text[1000];
        snprintf(text, sizeof text, "%s", BAD[b].study);
        cJSON *parameters = cJSON_Parse(text);
        assert_non_null(parameters);
        if (strstr(text, "\"hurst\": 2") != NULL) /* a name is there once */
            cJSON_DeleteItemFromObject(cJSON_GetObjectItem(parameters, "counter_surface"), "hurst");
        int status = contact_case_read(&one_case, parameters, 0, &list, &err);
        bool found = false;
        for (size_t f = 0; status == ERROR_INPUT && f < list.count; f++)
            found = found || (strcmp(list.faults[f].pointer, BAD[b].pointer) == 0 &&
                              strstr(list.faults[f].detail, BAD[b].words) != NULL);
        if (!found)
            fail_msg("%s: %s", text, err.text);
        fault_list_clear(&list);
        cJSON_Delete(parameters);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_cell),
        cmocka_unit_test(scales),
        cmocka_unit_test(heights_of_the_sum),
        cmocka_unit_test(loads_in_pascal),
        cmocka_unit_test(faults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
