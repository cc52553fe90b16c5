/* Contact studies from parameters to curves against exact solutions: one wave and full contact; and
 * what must hold for rough blocks: fine meshes that agree with the half-space, theories on their
 * sides, the same curves in any units, an answer in hard cases, and a scatter that was stated. */
#include "core/theory/contact.h"
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/contact_scene.h"
#include "tests/support/contact_document.h"
#include "tests/support/effort.h"
#include <stdio.h>

#define WAVE(contact)                                                                              \
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 1,"                    \
    " \"length_ratio\": 1, \"points_per_wavelength\": 64}, \"contact\": {\"cell_error\": "         \
    "\"none\", " contact "}}"

/* Every realisation is the wave at another phase of the grid: each by itself, so that phases do not
 * cancel. 1 % is what edges reach at 64 points a wave. The gap is an integral: 0.002 of sqrt(m0).
 */
static void one_wave_is_westergaards(void **state) {
    (void)state;
    static const char study[] = WAVE("\"pressures\": {\"to\": 0.68, \"steps\": 34}");
    for (uint64_t phase = 0; phase < 4; phase++) {
        cJSON *document = solve_from(study, phase, 1);
        const cJSON *area = curve_of(document, "contact_area", "edges", "halfspace");
        const cJSON *gap = curve_of(document, "mean_gap", "", "halfspace");
        assert_int_equal(points(area), 34);
        for (int k = 0; k < points(area); k++) {
            double load = at(area, "/x", k), exact = 2 / M_PI * asin(sqrt(sqrt(2) * load));
            assert_near(at(area, "/theory/westergaard", k), exact, 1e-12, load);
            if (load > 0.0999)
                assert_near(at(area, "/y", k), exact, 0.01 * exact, load);
            assert_near(at(gap, "/y", k), at(gap, "/theory/westergaard", k), 0.002, load);
        }
        assert_null(json_at(area, "/theory/persson"));
        cJSON_Delete(document);
    }
}

/* The stiffness is the slope of the gap: against central differences of Westergaard's. */
static void stiffness_of_a_wave(void **state) {
    (void)state;
    cJSON *document = solve(WAVE("\"pressures\": {\"values\": [0.1, 0.3, 0.5]}"), 2);
    const cJSON *stiffness = curve_of(document, "stiffness", "", "halfspace");
    for (int k = 0; k < 3; k++) {
        double load = at(stiffness, "/x", k), step = 1e-4, ratio = sqrt(2);
        double rise = sqrt(2) * (westergaard_gap(ratio * (load - step)) -
                                 westergaard_gap(ratio * (load + step)));
        double exact = 2 * step / rise;
        /* contact of 64 nodes moves by whole nodes: 5 % */
        assert_near(at(stiffness, "/y", k), exact, 0.05 * exact, load);
    }
    cJSON_Delete(document);
}

/* Full contact begins at p*, load 1/sqrt(2): all in contact, no gap, and no stiffness. */
static void full_contact_of_a_wave(void **state) {
    (void)state;
    cJSON *document = solve(WAVE("\"pressures\": {\"values\": [0.7, 0.708, 20]}"), 2);
    const cJSON *area = curve_of(document, "contact_area", "edges", "halfspace");
    const cJSON *gap = curve_of(document, "mean_gap", "", "halfspace");
    const cJSON *stiffness = curve_of(document, "stiffness", "", "halfspace");
    assert_true(at(area, "/y", 0) < 0.99);
    for (int k = 1; k < 3; k++) {
        assert_near(at(area, "/y", k), 1, 0, at(area, "/x", k));
        assert_near(at(gap, "/y", k), 0, 1e-10, at(area, "/x", k));
        assert_true(isnan(at(stiffness, "/y", k)));
        assert_near(at(stiffness, "/valueless", k), 2, 0, at(area, "/x", k));
    }
    cJSON_Delete(document);
}

#define ROUGH(levels)                                                                              \
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 8,"                    \
    " \"length_ratio\": 4, \"points_per_wavelength\": 64}, \"contact\": {\"cell_error\": "         \
    "\"none\", "                                                                                   \
    "\"model\": [\"layered\", \"halfspace\"], \"levels\": " levels ","                             \
    "\"pressures\": {\"values\": [0.05, 0.1, 0.2, 0.3]}}}"

/* A fine layered mesh is the half-space that it stands for: the mesh's own error, 0.5 %. */
static void fine_layers_are_the_halfspace(void **state) {
    (void)state;
    cJSON *fine = solve(ROUGH("[16, 32, 64]"), 10);
    const cJSON *halfspace = curve_of(fine, "contact_area", "edges", "halfspace");
    for (int k = 0; k < points(halfspace); k++)
        assert_near(at(halfspace, "/model_error", k), 0, 0.005 * at(halfspace, "/y", k),
                    at(halfspace, "/x", k));
    cJSON_Delete(fine);
}

/* Levels see the same surface: the difference of two scatters far less than either. */
static void levels_see_the_same_surface(void **state) {
    (void)state;
    cJSON *document = solve(ROUGH("[32, 64]"), 10);
    const cJSON *area = curve_of(document, "contact_area", "edges", "halfspace");
    for (int k = 0; k < points(area); k++) {
        double alone = at(area, "/standard_error", k);
        double pair = at(area, "/discretisation_standard_error", k);
        if (!(pair < alone / 10))
            fail_msg("pairs scatter by %g, realisations by %g", pair, alone);
    }
    cJSON_Delete(document);
}

/* In 3D simulations lie between Persson and BGT at light load, and near Persson at high load. */
static void surfaces_against_theories(void **state) {
    (void)state;
    cJSON *document =
        solve("{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4,"
              " \"length_ratio\": 4}, \"contact\": {\"cell_error\": \"none\", \"pressures\":"
              " {\"values\": [0.01, 0.02, 0.05, 0.4, 0.8, 1.2]}}}",
              5);
    const cJSON *area = curve_of(document, "contact_area", "edges", "halfspace");
    for (int k = 0; k < 6; k++) {
        double y = at(area, "/y", k), persson = at(area, "/theory/persson", k);
        assert_true(persson > 0);
        if (k < 3)
            assert_true(y > persson && y < at(area, "/theory/bgt_light_load", k));
        else
            assert_near(y, persson, 0.15 * persson, at(area, "/x", k));
    }
    assert_true(at(area, "/theory/bgt", 0) > 0 && at(area, "/theory/gw_mccool", 0) > 0);
    const cJSON *kappa = json_at(document, "/scalars/kappa/value");
    assert_true(kappa->valuedouble > persson_light_load() && kappa->valuedouble < bgt_light_load());
    cJSON_Delete(document);
}

/* Heights decide at light load, which Persson's theory does not see: at 0.01 the maximum of C = 2
 * has 2.8 times the area of the minimum. Theories by the exact summits follow within 35 %: 25 % by
 * which asperities err, 5 % for twenty surfaces of 16 waves, 5 % for the mesh. */
static void translated_surfaces_against_their_summits(void **state) {
    (void)state;
    static const struct {
        const char *name;
        const char *theory;
        double shape;
    } CASES[] = {{"weibull_max", "/theory/bgt_translation", 2},
                 {"weibull_min", "/theory/bgt_translation", 2},
                 {"weibull_min", "/theory/gw_translation", 1}};
    double areas[3];
    for (int c = 0; c < 3; c++) {
        char study[500];
        snprintf(study, sizeof study,
                 "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 4,"
                 " \"amplitudes\": \"random\", \"heights\": {\"distribution\": \"%s\", \"shape\": "
                 "%g, \"law\":"
                 " \"translation\"}}, \"contact\": {\"cell_error\": \"none\", \"pressures\": "
                 "{\"values\": [0.01]}}}",
                 CASES[c].name, CASES[c].shape);
        cJSON *document = solve(study, 20);
        const cJSON *area = curve_of(document, "contact_area", "edges", "halfspace");
        areas[c] = at(area, "/y", 0);
        assert_near(areas[c], at(area, CASES[c].theory, 0), 0.35 * areas[c], c);
        assert_null(json_at(area, "/theory/bgt"));
        cJSON_Delete(document);
    }
    assert_true(areas[0] > 2 * areas[1]);
}

/* Counted summits of translated surfaces have the area of their exact densities. 8 points a
 * shortest wave count 3 % fewer summits than there are, with curvatures some percent too small; 20
 * surfaces of 16 longest waves scatter by 2 to 5 % at this load: 12 %. Areas on the next grid are
 * within what is stated. */
static void counted_summits_against_their_densities(void **state) {
    (void)state;
    static const struct {
        const char *heights, *theories[2];
    } CASES[] = {{"{\"distribution\": \"gaussian\"}", {"gw_mccool", "bgt"}},
                 {"{\"distribution\": \"weibull_max\", \"shape\": 2, \"law\": \"translation\"}",
                  {"gw_translation", "bgt_translation"}},
                 {"{\"distribution\": \"weibull_min\", \"shape\": 1.5, \"law\": \"translation\"}",
                  {"gw_translation", "bgt_translation"}}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        char study[600];
        snprintf(
            study, sizeof study,
            "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 4,"
            " \"amplitudes\": \"random\", \"heights\": %s}, \"contact\": {\"levels\": [4, 8],"
            " \"estimators\": \"edges\", \"asperities\": \"counted\", \"cell_error\": \"none\","
            " \"law_difference\": \"none\", \"pressures\": {\"values\": [0.01, 0.05]}}}",
            CASES[c].heights);
        cJSON *document = solve(study, 20);
        for (size_t t = 0; t < 2; t++) {
            const cJSON *area =
                curve_of(document, "asperity_area", t == 0 ? "gw_counted" : "bgt_counted", NULL);
            for (int k = 0; k < 2; k++) {
                char name[40];
                snprintf(name, sizeof name, "/theory/%s", CASES[c].theories[t]);
                double theory = at(area, name, k), counted = at(area, "/y", k);
                assert_near(counted, theory, 0.12 * theory, at(area, "/x", k));
                assert_true(at(area, "/standard_error", k) > 0);
            }
        }
        cJSON_Delete(document);
    }
}

/* Profiles lie above Persson at every load, the more so the lighter it is (line contacts are none
 * of his): about 2.2 times at 0.005, 1.5 at 0.1, 1.2 at 0.3 and 1.1 at 0.5. 15 % leave room for the
 * scatter of 40 profiles (5 % at the lightest load) and for what H and the ratio do. */
static void profiles_against_persson(void **state) {
    (void)state;
    static const double times[] = {2.2, 1.5, 1.2, 1.1};
    cJSON *document = solve(
        "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 8,"
        " \"points_per_wavelength\": 16}, \"contact\": {\"cell_error\": \"none\", \"pressures\":"
        " {\"values\": [0.005, 0.1, 0.3, 0.5]}}}",
        40);
    const cJSON *area = curve_of(document, "contact_area", "edges", "halfspace");
    for (int k = 0; k < 4; k++) {
        double expected = times[k] * at(area, "/theory/persson", k);
        assert_near(at(area, "/y", k), expected, 0.15 * expected, at(area, "/x", k));
    }
    cJSON_Delete(document);
}

/* C = 1: plateaus of the maximum touch early, valleys of the minimum fill late. By many standard
 * errors on both sides of the crossing. */
static void weibull_curves_cross(void **state) {
    (void)state;
    static const char *const names[] = {"weibull_max", "weibull_min"};
    double area[2][2];
    for (int d = 0; d < 2; d++) {
        char study[400];
        snprintf(
            study, sizeof study,
            "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 8, \"heights\":"
            " {\"distribution\": \"%s\", \"shape\": 1}}, \"contact\": {\"cell_error\": \"none\", "
            "\"pressures\":"
            " {\"values\": [0.05, 0.5]}}}",
            names[d]);
        cJSON *document = solve(study, 20);
        const cJSON *curve = curve_of(document, "contact_area", "edges", "halfspace");
        for (int k = 0; k < 2; k++)
            area[d][k] = at(curve, "/y", k);
        cJSON_Delete(document);
    }
    assert_true(area[0][0] > 2 * area[1][0]);
    assert_true(area[0][1] < area[1][1] - 0.03);
}

/* The same dimensionless curves for any slope: rounding alone, times what contact makes of it. */
static void any_scale(void **state) {
    (void)state;
    static const char form[] =
        "{\"surface\": {\"dimension\": 1, \"hurst\": 0.4,"
        " \"wavelength_ratio\": 8, \"length_ratio\": 2,"
        " \"rms_slope\": %s}, \"contact\": {\"cell_error\": \"none\", \"model\": \"layered\","
        " \"young\": %s}}";
    static const char *const scales[][2] = {{"1", "1"}, {"1e-9", "1e15"}, {"1e6", "1e-12"}};
    cJSON *documents[3];
    for (size_t a = 0; a < 3; a++) {
        char study[400];
        snprintf(study, sizeof study, form, scales[a][0], scales[a][1]);
        documents[a] = solve(study, 2);
    }
    static const char *const quantities[][2] = {{"contact_area", "edges"}, {"mean_gap", ""}};
    for (size_t q = 0; q < 2; q++)
        for (size_t a = 1; a < 3; a++) {
            const cJSON *one =
                curve_of(documents[0], quantities[q][0], quantities[q][1], "layered");
            const cJSON *other =
                curve_of(documents[a], quantities[q][0], quantities[q][1], "layered");
            for (int k = 0; k < points(one); k++)
                assert_near(at(other, "/y", k), at(one, "/y", k), 1e-10, at(one, "/x", k));
        }
    for (size_t a = 0; a < 3; a++)
        cJSON_Delete(documents[a]);
}

/* Every curve has numbers, or null where there is no value to be had. */
static void assert_sound(const cJSON *document, const char *study) {
    const cJSON *curve;
    cJSON_ArrayForEach(curve, json_at(document, "/curves")) {
        bool may_lack = text_is(curve, "/quantity", "stiffness");
        bool area = text_is(curve, "/quantity", "contact_area");
        for (int k = 0; k < points(curve) && !may_lack; k++) {
            double y = at(curve, "/y", k);
            if (!(y >= -1e-9) || (area && !(y <= 1 + 1e-9)))
                fail_msg("%s: %s %s is %g at %g", study, json_at(curve, "/quantity")->valuestring,
                         json_at(curve, "/series")->valuestring, y, at(curve, "/x", k));
        }
    }
}

/* First touch by one node, plateaus, full contact, thin blocks, incompressible ones, coarse grids,
 * odd and prime grids: each ends in an answer. */
static void hard_cases(void **state) {
    (void)state;
    static const char *const studies[] = {
        WAVE("\"pressures\": {\"values\": [1e-8, 1e-4, 0.7, 0.7071, 100]}"),
        "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 8, "
        "\"length_ratio\":"
        " 2, \"heights\": {\"distribution\": \"weibull_max\", \"shape\": 1}},"
        " \"contact\": {\"pressures\": {\"values\": [1e-8, 1e-3, 0.1, 1, 100]}}}",
        "{\"surface\": {\"dimension\": 1, \"hurst\": 0.2, \"wavelength_ratio\": 8, "
        "\"length_ratio\":"
        " 2}, \"contact\": {\"model\": \"layered\", \"poisson\": 0.4999,"
        " \"block_height\": {\"lengths\": 0.02}, \"gap_weighting\": \"dual\"}}",
        "{\"surface\": {\"dimension\": 1, \"hurst\": 1, \"wavelength_ratio\": 3, \"length_ratio\":"
        " 1, \"points_per_wavelength\": 4.34}, \"contact\": {\"model\": \"layered\", \"poisson\":"
        " 0}}",
        "{\"surface\": {\"dimension\": 1, \"hurst\": 1, \"wavelength_ratio\": 1, \"length_ratio\":"
        " 1, \"points_per_wavelength\": 2}, \"contact\": {}}",
        "{\"surface\": {\"hurst\": 0.5, \"wavelength_ratio\": 1, \"length_ratio\": 1,"
        " \"points_per_wavelength\": 13}, \"contact\": {\"model\": [\"layered\", \"halfspace\"],"
        " \"pressures\": {\"values\": [1e-8, 0.01, 0.5, 100]}}}",
        "{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": 2,"
        " \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 1, \"keep\": \"heights\"}},"
        " \"contact\": {\"levels\": [4, 8, 16], \"pressures\": {\"to\": 0.5, \"steps\": 4}}}",
    };
    for (size_t s = 0; s < sizeof studies / sizeof *studies; s += case_step()) {
        cJSON *document = solve(studies[s], 2);
        assert_sound(document, studies[s]);
        cJSON_Delete(document);
    }
}

/* What `rugo check` states of the statistical error is the scatter that comes out at the lightest
 * load. Constants are fitted to other surfaces, within 0.7 to 1.5 in nine of ten; the scatter of
 * 200 profiles is itself known to 5 to 10 %. */
static void stated_scatter_comes_out(void **state) {
    (void)state;
    static const char *const STUDIES[] = {
        "{\"surface\": {\"dimension\": 1, \"hurst\": 0.7, \"wavelength_ratio\": 8, "
        "\"length_ratio\": 8},"
        " \"contact\": {\"pressures\": {\"values\": [0.01]}, \"cell_error\": \"none\"}}",
        "{\"surface\": {\"dimension\": 1, \"hurst\": 0.7, \"wavelength_ratio\": 8, "
        "\"length_ratio\": 8},"
        " \"contact\": {\"pressures\": {\"values\": [0.2, 0.3]}, \"cell_error\": \"none\"}}",
        "{\"surface\": {\"dimension\": 1, \"hurst\": 0.3, \"wavelength_ratio\": 16, "
        "\"length_ratio\": 8,"
        " \"amplitudes\": \"random\", \"heights\": {\"distribution\": \"weibull_min\", \"shape\": "
        "1.5,"
        " \"misfit\": 0.2, \"law\": \"translation\"}}, \"contact\": {\"pressures\": {\"values\":"
        " [0.01]}, \"law_difference\": \"none\", \"cell_error\": \"none\"}}"};
    enum { COUNT = 200 };
    for (size_t a = 0; a < sizeof STUDIES / sizeof *STUDIES; a++) {
        struct contact_case one_case;
        struct study_cost cost;
        struct error err = {0};
        cJSON *parameters = cJSON_Parse(STUDIES[a]), *document = solve(STUDIES[a], COUNT);
        const cJSON *area = curve_of(document, "contact_area", "edges", "halfspace");
        if (contact_case_read(&one_case, parameters, 0, NULL, &err) != 0)
            fail_msg("%s", err.text);
        contact_case_estimate(&one_case, &cost);
        double found = sqrt(COUNT) * at(area, "/standard_error", 0) / at(area, "/y", 0);
        if (!(cost.relative_error > found / 1.7 && cost.relative_error < 1.7 * found))
            fail_msg("study %zu: %g stated, %g found", a, cost.relative_error, found);
        contact_case_clear(&one_case);
        cJSON_Delete(parameters);
        cJSON_Delete(document);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_wave_is_westergaards),
        cmocka_unit_test(stiffness_of_a_wave),
        cmocka_unit_test(full_contact_of_a_wave),
        cmocka_unit_test(fine_layers_are_the_halfspace),
        cmocka_unit_test(levels_see_the_same_surface),
        cmocka_unit_test(surfaces_against_theories),
        cmocka_unit_test(translated_surfaces_against_their_summits),
        cmocka_unit_test(counted_summits_against_their_densities),
        cmocka_unit_test(profiles_against_persson),
        cmocka_unit_test(weibull_curves_cross),
        cmocka_unit_test(any_scale),
        cmocka_unit_test(hard_cases),
        cmocka_unit_test(stated_scatter_comes_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
