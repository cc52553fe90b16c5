/* Protects: grooves of studies: what is refused and which values are allowed in its place, that
 * every mesh has the same grooves at its own points, moments of heights with them, and their
 * contact where they are all that there is. */
#include "core/statistics/heights/roughness.h"
#include "jobs/contact/contact_level.h"
#include "jobs/surface/realisation_map.h"
#include "tests/support/check.h"
#include "tests/support/contact_document.h"
#include <stdio.h>
#include <stdlib.h>

static int try(struct surface_case *out, const char *surface, struct error *err) {
    char text[1000];
    snprintf(text, sizeof text,
             "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 4%s}}",
             surface);
    cJSON *parameters = cJSON_Parse(text);
    assert_non_null(parameters);
    int status = surface_case_read(out, parameters, NULL, err);
    cJSON_Delete(parameters);
    return status;
}

static struct surface_case read(const char *surface) {
    struct surface_case out;
    struct error err = {0};
    if (try(&out, surface, &err) != 0)
        fail_msg("%s: %s", surface, err.text);
    return out;
}

#define GROOVES(more) ", \"grooves\": {\"depth\": 2, " more "}"

static void what_does_not_fit_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *surface, *fault;
    } ROWS[] = {
        {GROOVES("\"period\": 5"), "has 3.2 periods along x and 0 along y"},
        {GROOVES("\"period\": 5"), "the nearest is period 5.333333333 at 90 degrees (3 along x"},
        {GROOVES("\"period\": 4, \"angle\": 40"), "along x, 3 along y)"},
        {GROOVES("\"period\": 4, \"cross_angle\": 90"),
         "both families have the same direction and period"},
        {GROOVES("\"period\": 4, \"cross_depth\": 1"), "needs its cross_angle or cross_period"},
        {GROOVES("\"period\": 4, \"cross_period\": 5"),
         "/surface/grooves/cross_period: period 5 at 90"},
        {GROOVES("\"period\": 4, \"cross_period\": 0.25, \"cross_angle\": 0"),
         "points a period; allowed: at least 4"},
        {GROOVES("\"period\": 4, \"cross_angle\": 0, \"cross_shape\": \"harmonics\""),
         "cross_amplitudes: the shape harmonics needs"},
        {GROOVES("\"period\": 4, \"cross_angle\": 0, \"cross_amplitudes\": [1]"),
         "belongs to the cross_shape harmonics"},
        {GROOVES("\"period\": 4, \"phases\": [90]"),
         "/surface/grooves/phases: belongs to the shape harmonics"},
        {GROOVES("\"period\": 4, \"cross_angle\": 0, \"cross_phases\": [90]"),
         "/surface/grooves/cross_phases: belongs to the cross_shape harmonics"},
        /* 8 points a period */
        {GROOVES("\"period\": 1, \"shape\": \"harmonics\", \"amplitudes\": [1, 0, 0, 0.1, 0]"),
         "/surface/grooves/amplitudes: harmonic 4: the grid has two points a wave of it along a "
         "side, or fewer; allowed: harmonics up to 3"},
        {GROOVES("\"period\": 4, \"shape\": \"harmonics\", \"amplitudes\": [0, 0, 0, 1], "
                 "\"cross_period\": 1"),
         "/surface/grooves/cross_period: harmonic 4"},
        {GROOVES("\"period\": 4, \"angle\": 0, \"cross_angle\": 50"),
         "/surface/grooves/cross_angle: period 4 at 50 degrees"},
        {GROOVES("\"period\": 0.25"), "the grid has 2 points a period; allowed: at least 4"},
        {GROOVES("\"angle\": 0"), "belongs to grooves, which need their period"},
        {", \"grooves\": {\"period\": 4}", "/surface/grooves/depth: grooves need their depth"},
        {GROOVES("\"period\": 4, \"shape\": \"harmonics\""), "needs its amplitudes"},
        {GROOVES("\"period\": 4, \"shape\": \"harmonics\", \"amplitudes\": [0, 0]"),
         "the harmonics make no groove"},
        {GROOVES("\"period\": 4, \"angle\": 0") ", \"dimension\": 1",
         "profiles have one direction"},
        {GROOVES("\"period\": 4") ", \"amplitudes\": \"random\", \"heights\": {\"distribution\": "
                                  "\"weibull_max\", \"shape\": 2, \"law\": \"translation\"}",
         "allowed: \"iterated\""},
    };
    for (size_t r = 0; r < sizeof ROWS / sizeof *ROWS; r++) {
        struct surface_case out;
        struct error err = {0};
        assert_int_equal(try(&out, ROWS[r].surface, &err), ERROR_INPUT);
        if (strstr(err.text, ROWS[r].fault) == NULL)
            fail_msg("%s: %s", ROWS[r].surface, err.text);
    }
}

/* What a message allows is read, though it is rounded. */
static void allowed_values_are_read(void **state) {
    (void)state;
    struct surface_case surface = read(GROOVES("\"period\": 5.333, \"angle\": 90"));
    check_close(surface.grooves->family[0].wave_x, 3. / 16, 1e-14);
    assert_true(surface.grooves->family[0].wave_y == 0);
    surface_case_clear(&surface);
    surface =
        read(GROOVES("\"period\": 1, \"shape\": \"harmonics\", \"amplitudes\": [1, 0, 0.1, 0]"));
    surface_case_clear(&surface);
    surface = read(GROOVES("\"period\": 3.771236, \"angle\": 45, \"cross_angle\": -45"));
    assert_int_equal(surface.grooves->families, 2);
    assert_true(grooves_fit(surface.grooves, 32, 32) && !grooves_fit(surface.grooves, 8, 8));
    surface_case_clear(&surface);
}

/* The second family has what is given of its own, and else what the first has. */
static void the_second_family_has_its_own(void **state) {
    (void)state;
    struct surface_case surface =
        read(GROOVES("\"period\": 4, \"shape\": \"arcs\", \"cross_period\": 2.743977,"
                     "\"cross_angle\": -30.96375653, \"cross_depth\": 0.5,"
                     "\"cross_shape\": \"triangle\""));
    const struct groove_family *family = surface.grooves->family;
    assert_int_equal(surface.grooves->families, 2);
    check_close(family[1].wave_x, -3. / 16, 1e-14);
    check_close(family[1].wave_y, -5. / 16, 1e-14);
    assert_true(family[0].depth == 2 && family[1].depth == 0.5);
    assert_true(family[0].profile.shape == GROOVE_ARCS &&
                family[1].profile.shape == GROOVE_TRIANGLE);
    check_close(grooves_cumulants(surface.grooves).second, 4 * 4. / 45 + 0.25 / 12, 1e-12);
    surface_case_clear(&surface);
    surface = read(GROOVES("\"period\": 4, \"shape\": \"saw\", \"cross_period\": 2"));
    family = surface.grooves->family;
    assert_true(family[1].wave_x == 0.5 && family[1].wave_y == 0 && family[1].depth == 2 &&
                family[1].profile.shape == GROOVE_SAW);
    surface_case_clear(&surface);
}

/* Both grids are of one realisation, with grooves of cusps that no grid resolves. */
static void meshes_have_the_same_grooves(void **state) {
    (void)state;
    static const char *const PHASES[] = {"", ", \"phase\": 0.3"};
    for (size_t p = 0; p < 2; p++) {
        char coarse[300], fine[400];
        snprintf(coarse, sizeof coarse,
                 GROOVES("\"period\": 3.5777087640, \"angle\": 26.56505118, \"shape\": \"arcs\"%s"),
                 PHASES[p]);
        snprintf(fine, sizeof fine, "%s, \"points_per_wavelength\": 20", coarse);
        struct surface_case own = read(coarse), finer = read(fine);
        const struct random_key key = {5, 0, 7};
        const struct contact_level level = {.points = 20, .grid = finer.grid};
        struct surface_report report;
        double *z = NULL, *expected = NULL;
        const size_t points = grid_points(&finer.grid);
        assert_int_equal(realisation_surface(&own, key, &z, &report, NULL), 0);
        assert_int_equal(realisation_surface(&finer, key, &expected, &report, NULL), 0);
        double *sampled = malloc(points * sizeof *sampled);
        assert_non_null(sampled);
        const struct level_source source = {1, key}; /* m0 is 1 */
        assert_int_equal(contact_level_sample(&level, &own, &source, z, sampled, NULL), 0);
        for (size_t i = 0; i < points; i++)
            check_close(sampled[i], expected[i], 1e-10);
        free(z);
        free(expected);
        free(sampled);
        surface_case_clear(&own);
        surface_case_clear(&finer);
    }
}

/* Over 200 realisations, each at phases of its own: within four standard errors of the cumulants.
 */
static void moments_add_up(void **state) {
    (void)state;
    enum { DRAWS = 200 };
    struct surface_case surface =
        read(GROOVES("\"period\": 5.3333333333, \"angle\": 0, \"cross_angle\": 90, \"shape\": "
                     "\"arcs\"") ", \"points_per_wavelength\": 4");
    struct height_moments heights;
    bool known;
    double skewness = 0, skewness_square = 0, kurtosis = 0, kurtosis_square = 0, square = 0;
    assert_int_equal(surface_case_heights(&surface, &heights, &known, NULL), 0);
    assert_true(known);
    for (uint64_t r = 0; r < DRAWS; r++) {
        double *z = NULL;
        struct surface_report report;
        struct roughness found;
        assert_int_equal(
            realisation_surface(&surface, (struct random_key){3, 0, r}, &z, &report, NULL), 0);
        roughness_measure(&surface.grid, z, &found);
        skewness += found.skewness / DRAWS;
        skewness_square += found.skewness * found.skewness / DRAWS;
        kurtosis += found.kurtosis / DRAWS;
        kurtosis_square += found.kurtosis * found.kurtosis / DRAWS;
        square += found.rms_height * found.rms_height / DRAWS;
        free(z);
    }
    const double bound_3 = 4 * sqrt((skewness_square - skewness * skewness) / DRAWS);
    const double bound_4 = 4 * sqrt((kurtosis_square - kurtosis * kurtosis) / DRAWS);
    check_close(square, 1 + 2 * 4 * 4. / 45, 0.02);
    assert_true(heights.skewness > 1.5 * bound_3); /* so that the test can see it */
    assert_true(fabs(skewness - heights.skewness) < bound_3);
    /* fixed amplitudes: one cell has a little less than 3 (F3.2) */
    assert_true(fabs(kurtosis - heights.kurtosis) < bound_4 + 0.03);
    surface_case_clear(&surface);
}

/* Parallel families of a fixed phase lie beside each other alike in every realisation: their
 * heights are not independent, and have no theory. */
static void locked_families_have_no_moments(void **state) {
    (void)state;
    static const struct {
        const char *surface;
        bool known;
    } ROWS[] = {
        {GROOVES("\"period\": 8, \"cross_period\": 4, \"phase\": 0"), false},
        {GROOVES("\"period\": 8, \"cross_period\": 4, \"phase\": 0.3") ", \"dimension\": 1", false},
        {GROOVES("\"period\": 8, \"cross_period\": 4"), true},
        {GROOVES("\"period\": 8, \"cross_angle\": 0, \"phase\": 0"), true},
        {GROOVES("\"period\": 8, \"phase\": 0"), true},
    };
    for (size_t r = 0; r < sizeof ROWS / sizeof *ROWS; r++) {
        struct surface_case surface = read(ROWS[r].surface);
        struct height_moments heights;
        bool known;
        assert_int_equal(surface_case_heights(&surface, &heights, &known, NULL), 0);
        assert_true(known == ROWS[r].known);
        assert_true(isnan(grooves_cumulants(surface.grooves).second) == !known);
        surface_case_clear(&surface);
    }
}

/* Grooves a million times as deep as the random part are Westergaard's wave. Loads are over E* h'
 * of the random part, one wave of RMS slope 2 pi. */
static void deep_sines_are_westergaards(void **state) {
    (void)state;
    static const double DEPTH = 1e6, PERIOD = 2;
    static const double RATIOS[] = {0.05, 0.3, 0.9};
    char study[900];
    const double full = DEPTH / (4 * PERIOD); /* p* = pi E* amplitude/period, over E* h' */
    snprintf(study, sizeof study,
             "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 1, "
             "\"length_ratio\": 4, \"points_per_wavelength\": 32, \"grooves\": {\"period\": %g, "
             "\"depth\": %g}}, \"contact\": {\"cell_error\": \"none\", \"model\": \"halfspace\", "
             "\"levels\": [32, 64], \"pressures\": {\"values\": [%.17g, %.17g, %.17g]}}}",
             PERIOD, DEPTH, full * RATIOS[0], full * RATIOS[1], full * RATIOS[2]);
    cJSON *document = solve(study, 2);
    const cJSON *area = curve_of(document, "contact_area", "edges", "halfspace");
    const cJSON *y = json_at(area, "/y");
    for (int k = 0; k < 3; k++) {
        const double found = cJSON_GetNumberValue(cJSON_GetArrayItem(y, k));
        const double exact = 2 / M_PI * asin(sqrt(RATIOS[k]));
        if (!(fabs(found - exact) < 0.01 * exact))
            fail_msg("p/p* %g: area %g, and not %g", RATIOS[k], found, exact);
    }
    assert_null(
        json_at(area, "/theory/westergaard")); /* no theory of one wave is that of the sum */
    cJSON_Delete(document);
}

/* Theories of contact are of random faces. */
static void contact_has_no_theory(void **state) {
    (void)state;
    cJSON *document =
        solve("{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, "
              "\"length_ratio\": 4, \"points_per_wavelength\": 4, \"grooves\": {\"period\": 4, "
              "\"depth\": 1}}, \"contact\": {\"cell_error\": \"none\", \"model\": \"halfspace\", "
              "\"levels\": [4], \"pressure_pdf\": {\"at\": [0.1]}, "
              "\"pressures\": {\"values\": [0.1]}}}",
              2);
    const cJSON *curve;
    int seen = 0;
    cJSON_ArrayForEach(curve, json_at(document, "/curves")) {
        seen += text_is(curve, "/quantity", "contact_pressure_pdf");
        if (cJSON_GetArraySize(json_at(curve, "/theory")) > 0)
            fail_msg("%s has a theory", json_at(curve, "/quantity")->valuestring);
    }
    assert_true(seen > 0);
    cJSON_Delete(document);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_does_not_fit_is_refused),
        cmocka_unit_test(allowed_values_are_read),
        cmocka_unit_test(the_second_family_has_its_own),
        cmocka_unit_test(meshes_have_the_same_grooves),
        cmocka_unit_test(moments_add_up),
        cmocka_unit_test(locked_families_have_no_moments),
        cmocka_unit_test(deep_sines_are_westergaards),
        cmocka_unit_test(contact_has_no_theory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
