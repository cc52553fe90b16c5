/* Protects: /surface/plateau is read as a stratified face in one cell, has the moments, curves and
 * contact of one, and what it cannot have is refused, with its pointer. */
#include "core/surface/plateau_face.h"
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/kind.h"
#include "jobs/merger.h"
#include "jobs/runner.h"
#include "tests/support/check.h"
#include "tests/support/scalar_of.h"
#include "tests/support/unstopped.h"
#include <string.h>

#define PROFILE                                                                                    \
    "\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 4, "             \
    "\"rms_slope\": 0.1"
#define STRATA "\"rms_ratio\": 0.25, \"material_ratio\": 0.8"
#define FACE(surface, plateau, rest)                                                               \
    "{\"surface\": {" surface ", \"plateau\": {" plateau "}}" rest "}"
#define PRESSED(surface, plateau, contact)                                                         \
    FACE(surface, plateau, ", \"contact\": {\"pressures\": {\"values\": [0.02, 0.1]}" contact "}")
#define DIGEST "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef"

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

/* Without rows of its own the plateau has the spectrum of /surface; the grid resolves the shorter
 * of their waves. */
static void one_cell(void **state) {
    (void)state;
    static const struct {
        const char *study;
        double shortest;
        size_t points, band;
    } CASES[] = {
        {PRESSED(PROFILE, STRATA, ""), 1, 128, 16},
        {PRESSED(PROFILE, STRATA ", \"wavelength_ratio\": 8", ""), 0.5, 256, 32},
        {PRESSED(PROFILE, STRATA ", \"length_ratio\": 8", ""), 0.5, 256, 32},
        {PRESSED(PROFILE, STRATA ", \"wavelength_ratio\": 2", ""), 2, 128, 16},
    };
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        struct contact_case one_case = read_case(CASES[c].study);
        const struct surface_case *surface = &one_case.surface;
        const struct surface_band band = surface_case_band(surface);
        struct height_moments heights;
        bool known;
        check_close(surface->plateau->spectrum.wavelength_short, CASES[c].shortest, 1e-12);
        check_close(surface->plateau->offset, stratified_offset(0.25, 0.8), 1e-15);
        assert_int_equal(surface->grid.nx, CASES[c].points);
        assert_int_equal(band.x, CASES[c].band);
        assert_false(surface_case_band_limited(surface));
        assert_false(surface_case_gaussian(surface));
        assert_int_equal(surface_case_heights(surface, &heights, &known, NULL), 0);
        assert_true(known && heights.skewness < -1);
        contact_case_clear(&one_case);
    }
}

/* A plateau of a narrow band with a lay, of which only oblique waves fit into the cell: two of them
 * and their opposites. */
static void oblique_plateau(void **state) {
    (void)state;
    struct contact_case one_case = read_case(
        PRESSED("\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 4",
                STRATA ", \"length_ratio\": 2.5, \"wavelength_ratio\": 1.05, \"anisotropy\": 2,"
                       " \"lay_angle\": 45",
                ""));
    struct modes *modes = NULL;
    const struct surface_case *surface = &one_case.surface;
    assert_int_equal(modes_create(&modes, &surface->plateau->spectrum, &surface->grid, NULL), 0);
    assert_int_equal(modes->count, 4);
    modes_destroy(&modes);
    contact_case_clear(&one_case);
}

static void faults(void **state) {
    (void)state;
    static const struct {
        const char *study, *pointer, *words;
    } BAD[] = {
        {PRESSED(PROFILE, "\"offset\": -0.5", ""), "/surface/plateau/offset", "give its rms_ratio"},
        {PRESSED(PROFILE, "\"rms_ratio\": 0.2", ""), "/surface/plateau/offset",
         "one of offset and material_ratio"},
        {PRESSED(PROFILE, STRATA ", \"offset\": 0", ""), "/surface/plateau/material_ratio",
         "one of offset and material_ratio"},
        {PRESSED(PROFILE, "\"rms_ratio\": 1, \"material_ratio\": 0.5", ""),
         "/surface/plateau/material_ratio", "do not cross"},
        {PRESSED(PROFILE, "\"rms_ratio\": 2, \"offset\": 0", ""), "/surface/plateau/rms_ratio",
         "2"},
        {PRESSED(PROFILE, STRATA ", \"rolloff_ratio\": 9", ""), "/surface/plateau/rolloff_ratio",
         "more than wavelength_ratio"},
        {PRESSED(PROFILE, STRATA ", \"anisotropy\": 2", ""), "/surface/plateau/anisotropy",
         "one direction"},
        {PRESSED("\"hurst\": 0.8, \"wavelength_ratio\": 2, \"length_ratio\": 4",
                 STRATA ", \"anisotropy\": 5", ""),
         "/surface/plateau/anisotropy", "does not hold"},
        {PRESSED(PROFILE ", \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 2}", STRATA,
                 ""),
         "/surface/heights/distribution", "two Gaussian surfaces"},
        {PRESSED(PROFILE, STRATA ", \"length_ratio\": 4.5, \"wavelength_ratio\": 1.05", ""),
         "/surface/plateau/length_ratio", "no wave"},
        {PRESSED("\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 8",
                 STRATA ", \"wavelength_ratio\": 1, \"anisotropy\": 1.5, \"lay_angle\": 30", ""),
         "/surface/plateau/length_ratio", "no wave"},
        {PRESSED("\"hurst\": 0.8, \"wavelength_ratio\": 4",
                 STRATA ", \"length_ratio\": 1e5, \"wavelength_ratio\": 1e5", ""),
         "/surface/points_per_wavelength", "too large"},
        {PRESSED(PROFILE, STRATA, ", \"levels\": [3, 8]"), "/contact/levels", "has kinks"},
        {PRESSED(PROFILE, STRATA, ", \"levels\": [8, 16]"), "/contact/levels", "has kinks"},
        {FACE("\"dimension\": 1, \"wavelength_ratio\": 4, \"spectrum\": {\"type\": "
              "\"exponential_acf\", \"length\": [1]}",
              STRATA, ""),
         "/surface/plateau/hurst", "missing"},
        {FACE(PROFILE, STRATA,
              ", \"counter_surface\": {\"hurst\": 0.5, \"wavelength_ratio\": 4, \"rms_slope\": 1}"),
         "/surface/plateau/rms_ratio", "plateau and counter_surface"},
        {FACE(PROFILE ", \"like\": {\"file\": \"x\", \"sha256\": \"" DIGEST
                      "\", \"spacing\": 0.25, \"points\": [30], \"detrend\": \"plane\"}",
              STRATA, ""),
         "/surface/plateau/rms_ratio", "like and plateau"},
    };
    for (size_t b = 0; b < sizeof BAD / sizeof *BAD; b++) {
        struct fault_list list = {0};
        struct contact_case one_case;
        cJSON *parameters = cJSON_Parse(BAD[b].study);
        assert_non_null(parameters);
        assert_int_equal(contact_case_read(&one_case, parameters, 0, &list, NULL), ERROR_INPUT);
        bool found = false;
        for (size_t f = 0; f < list.count && f < FAULTS_KEPT; f++)
            found = found || (strcmp(list.faults[f].pointer, BAD[b].pointer) == 0 &&
                              strstr(list.faults[f].detail, BAD[b].words) != NULL);
        if (!found)
            fail_msg("%s: %zu faults, the first at %s: %s", BAD[b].study, list.count,
                     list.faults[0].pointer, list.faults[0].detail);
        fault_list_clear(&list);
        cJSON_Delete(parameters);
    }
}

/* Runs `count` realisations of a case as blocks of `block`, and fills the result. */
static void run(const char *kind_name, const char *text, uint64_t count, uint64_t block,
                struct case_result *out) {
    const struct job_kind *kind = kind_find(kind_name);
    struct job_runner *runner = NULL;
    struct job_merger *merger = NULL;
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    must(runner_create(&runner, kind, parameters, NULL, 3, 0, &err), &err);
    must(merger_create(&merger, kind, parameters, &err), &err);
    for (uint64_t first = 0; first < count; first += block) {
        struct block_result result;
        must(runner_run(runner, first, block, NULL, &result, &err), &err);
        must(merger_add(merger, &result, &err), &err);
        block_result_clear(&result);
    }
    must(merger_result(merger, out, &err), &err);
    merger_destroy(&merger);
    runner_destroy(&runner);
    cJSON_Delete(parameters);
}

static const struct curve *curve_of(const struct case_result *result, const char *quantity,
                                    double level) {
    for (size_t a = 0; a < result->curve_count; a++)
        if (strcmp(result->curves[a].quantity, quantity) == 0 &&
            (level == 0 || result->curves[a].level == level))
            return &result->curves[a];
    fail_msg("no curve %s", quantity);
    return NULL;
}

/* Statistics stand beside the law of heights: 5 standard errors. No theory of summits, which is of
 * one Gaussian surface, and none of spectra is there. */
static void statistics_beside_the_law(void **state) {
    (void)state;
    struct case_result result = {0};
    run("statistics",
        FACE("\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 8, "
             "\"points_per_wavelength\": 4, \"amplitudes\": \"random\"",
             STRATA, ", \"statistics\": {\"bins\": {\"height\": [-4, 3, 14]}}"),
        60, 60, &result);
    const struct curve *cdf = curve_of(&result, "height_cdf", 0);
    assert_int_equal(cdf->theory_count, 1);
    assert_string_equal(cdf->theories[0].name, "stratified");
    size_t compared = 0;
    for (size_t b = 0; b < cdf->n; b++)
        if (cdf->standard_error[b] > 1e-6) {
            check_close(cdf->y[b], cdf->theories[0].y[b], 5 * cdf->standard_error[b]);
            compared++;
        }
    assert_true(compared >= 8);
    assert_int_equal(curve_of(&result, "summit_height_pdf", 0)->theory_count, 0);
    assert_int_equal(curve_of(&result, "psd", 0)->theory_count, 0);
    const struct scalar *height = scalar_of(&result, "rms_height");
    assert_true(isnan(scalar_of(&result, "m4")->theory));
    check_close(height->value, height->theory, 5 * height->standard_error);
    result_clear(&result);
}

/* The plateaus touch: at a light load a face of the same valleys with a plateau touches on more of
 * its area than the valleys alone. Coarser levels are the same face. Blocks of any size give the
 * same bits. */
static void pressed_on_its_plateaus(void **state) {
    (void)state;
    struct case_result whole = {0}, parts = {0}, valleys = {0};
#define LEVELS ", \"levels\": [8, 16, 32], \"cell_error\": \"none\""
#define FINE PROFILE ", \"points_per_wavelength\": 32"
    const char *study = PRESSED(FINE, STRATA, LEVELS);
    run("contact", study, 8, 8, &whole);
    run("contact", study, 8, 2, &parts);
    run("contact",
        "{\"surface\": {" FINE "}, \"contact\": {\"pressures\": {\"values\": [0.02, 0.1]}" LEVELS
        "}}",
        8, 8, &valleys);
    const struct curve *area = curve_of(&whole, "contact_area", 32);
    const struct curve *other = curve_of(&parts, "contact_area", 32);
    const struct curve *rough = curve_of(&valleys, "contact_area", 32);
    const struct curve *coarse = curve_of(&whole, "contact_area", 8);
    for (size_t k = 0; k < 2; k++) {
        assert_true(area->y[k] == other->y[k] &&
                    area->standard_error[k] == other->standard_error[k]);
        assert_true(area->y[k] > 1.1 * rough->y[k]);
        check_close(coarse->y[k], area->y[k], 0.2 * area->y[k]);
    }
    /* Loads are over the RMS slope of the whole face. */
    const struct scalar *slope = scalar_of(&whole, "rms_slope");
    check_close(slope->value, slope->theory, 0.1 * slope->theory);
    assert_true(slope->theory < 0.1);
    result_clear(&whole);
    result_clear(&parts);
    result_clear(&valleys);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_cell),
        cmocka_unit_test(oblique_plateau),
        cmocka_unit_test(faults),
        cmocka_unit_test(statistics_beside_the_law),
        cmocka_unit_test(pressed_on_its_plateaus),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
