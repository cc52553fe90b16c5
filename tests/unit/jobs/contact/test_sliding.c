/* Protects friction at finite strain in studies: the flat slides fully in the end, and its work is
 * then that of the friction; where slopes are small, curves are those of lighter loads (nu near
 * 1/2) and of the coupled half-plane or half-space; a path turns; friction while pressing leaves
 * nodes that slide and less area; a realisation that ends early has a note and no values from there
 * on; curves do not depend on how realisations are cut into blocks; what cannot be computed is
 * refused. */
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/quantity/quantity.h"
#include "tests/support/check.h"
#include "tests/support/contact_document.h"
#include "tests/support/effort.h"
#include <stdio.h>
#include <stdlib.h>

#define STUDY(slope, contact)                                                                      \
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\": " \
    "2, \"points_per_wavelength\": 8, \"rms_slope\": " slope "}, \"contact\": {"                   \
    "\"cell_error\": \"none\", \"gap_weighting\": \"dual\", " contact "}}"
static const double MU = 0.3;

/* Returns the value of a curve at x, linear between its points. */
static double between(const cJSON *curve, double x) {
    for (int i = 1; i < points(curve); i++) {
        double from = at(curve, "/x", i - 1), to = at(curve, "/x", i);
        if (x >= from && x <= to)
            return at(curve, "/y", i - 1) +
                   (x - from) / (to - from) * (at(curve, "/y", i) - at(curve, "/y", i - 1));
    }
    fail_msg("no point at %g", x);
    return (double)NAN;
}

/* In the end all slides: Q = mu P, and work grows by mu P a unit of sliding (in E* h' sqrt(m0)).
 * Friction takes no more than that on the path before. */
static void the_flat_slides_fully(void **state) {
    (void)state;
    cJSON *document = solve(STUDY("0.2", "\"model\": \"full\", \"levels\": [4, 8], \"friction\": "
                                         "0.3, \"pressures\": {\"values\": [0.05, 0.1]}"),
                            3);
    const cJSON *force = curve_of(document, "sliding_force", "", "full");
    const cJSON *area = curve_of(document, "sliding_stick_area", "", "full");
    const cJSON *load = curve_of(document, "sliding_stick_load", "", "full");
    const cJSON *touching = curve_of(document, "sliding_contact_area", "", "full");
    const cJSON *work = curve_of(document, "sliding_dissipation", "", "full");
    const cJSON *gap = curve_of(document, "sliding_gap", "", "full");
    int last = points(force) - 1;
    assert_int_equal(last, 30);
    assert_near(at(force, "/x", last), 4 * MU, 1e-12, 0);
    assert_near(at(force, "/y", 0), 0, 1e-12, 0);
    assert_near(at(area, "/y", 0), 1, 0, 0);
    assert_near(at(load, "/y", 0), 1, 0, 0);
    assert_near(at(touching, "/y", 0), 1, 0, 0);
    assert_near(at(gap, "/y", 0), at(curve_of(document, "mean_gap", "", "full"), "/y", 1), 1e-9, 0);
    for (int i = 1; i <= last; i++) {
        double x = at(force, "/x", i), more = at(work, "/y", i) - at(work, "/y", i - 1);
        assert_true(at(force, "/y", i) >= at(force, "/y", i - 1) - 1e-9);
        assert_true(at(area, "/y", i) <= at(area, "/y", i - 1));
        assert_true(more >= 0 && more <= MU * 0.1 * 4 * MU / 30 * (1 + 1e-6));
        assert_true(at(force, "/discretisation_bound", i) >= 0 && x > 0);
    }
    assert_near(at(force, "/y", last), MU, 1e-6, 4 * MU);
    assert_near(at(area, "/y", last), 0, 0, 4 * MU);
    assert_near(at(load, "/y", last), 0, 0, 4 * MU);
    check_relative(at(work, "/y", last) - at(work, "/y", last - 1), MU * 0.1 * 4 * MU / 30, 1e-5);
    double full = json_at(document, "/scalars/sliding_to_full_slip/value")->valuedouble;
    assert_true(full > 0.05 && full < 4 * MU);
    assert_true(between(force, full) > 0.9 * MU && between(force, full) < MU);
    cJSON_Delete(document);
}

/* At nu near 1/2 and slopes of 0.005 what sticks is the contact of the lighter load P - Q/mu, and
 * the flat has slid by mu times what the gap differs (Ciavarella, Jaeger): 3 % for the mesh's own
 * compliance, two nodes of some thirty for the area. By edges what sticks lacks 0.04 on this mesh,
 * half of it on one twice as fine. */
static void small_slopes_slide_by_lighter_loads(void **state) {
    (void)state;
    cJSON *document = solve(
        STUDY("0.005",
              "\"model\": \"full\", \"levels\": [16], \"poisson\": 0.4999, \"friction\": 0.3, "
              "\"slip\": {\"to\": [0.6], \"steps\": 60}, \"pressures\": {\"values\": "
              "[0.05, 0.1]}"),
        1);
    const cJSON *gap = curve_of(document, "mean_gap", "", "full");
    const cJSON *nodes = curve_of(document, "contact_area", "nodes", "full");
    double slid = MU * (at(gap, "/y", 0) - at(gap, "/y", 1));
    double force = between(curve_of(document, "sliding_force", "", "full"), slid);
    double stick = between(curve_of(document, "sliding_stick_area", "", "full"), slid);
    printf("[   INFO   ] slid by %.4f: Q/P = %.4f (%.4f), sticks %.3f (%.3f)\n", slid, force,
           MU / 2, stick, at(nodes, "/y", 0) / at(nodes, "/y", 1));
    check_relative(force, MU / 2, 0.03);
    check_close(stick, at(nodes, "/y", 0) / at(nodes, "/y", 1), 2 / (128 * at(nodes, "/y", 1)));
    const cJSON *edges = curve_of(document, "contact_area", "edges", "full");
    const double lighter = at(edges, "/y", 0) / at(edges, "/y", 1);
    stick = between(curve_of(document, "sliding_stick_area", "edges", "full"), slid);
    const cJSON *touching = curve_of(document, "sliding_contact_area", "edges", "full");
    printf("[   INFO   ] by edges sticks %.4f (%.4f), touches %.4f in the end\n", stick, lighter,
           at(touching, "/y", 60));
    check_close(stick, lighter, 0.05);
    check_close(at(touching, "/y", 60), 1, 0.01);
    cJSON_Delete(document);
}

/* Small slopes at nu = 0.3 and the coupled half-plane: another discretisation and another solver.
 * Of some thirty nodes in contact up to three or four may differ. */
static void small_slopes_slide_as_the_half_plane(void **state) {
    (void)state;
    static const char *const PRESSING[] = {"frictionless", "frictional"};
    for (size_t p = 0; p < 2; p++) {
        char study[800];
        snprintf(study, sizeof study,
                 STUDY("0.005", "\"model\": [\"halfspace\", \"full\"], \"friction\": 0.3, "
                                "\"levels\": [8, 16], \"slip\": {\"to\": [0.6], \"pressing\": "
                                "\"%s\"}, \"pressures\": {\"values\": [0.1]}"),
                 PRESSING[p]);
        cJSON *document = solve(study, cases_of(3));
        static const struct {
            const char *name, *series;
            double scale, apart;
        } CURVES[] = {
            {"sliding_force", "", 0.3, 0.02},         {"sliding_stick_area", "", 1, 0.12},
            {"sliding_stick_load", "", 1, 0.08},      {"sliding_contact_area", "", 1, 0.1},
            {"sliding_dissipation", "", 0.01, 0.02},  {"sliding_gap", "", 1, 0.01},
            {"sliding_stick_area", "edges", 1, 0.04}, {"sliding_contact_area", "edges", 1, 0.02}};
        for (size_t c = 0; c < (p == 0 ? 8 : 5); c++) {
            const cJSON *full = curve_of(document, CURVES[c].name, CURVES[c].series, "full");
            const cJSON *linear = curve_of(document, CURVES[c].name, CURVES[c].series, "halfspace");
            double most = 0;
            assert_int_equal(points(full), 31);
            assert_int_equal(points(linear), 31);
            for (int i = 0; i < points(full); i++) {
                check_close(at(full, "/y", i), at(linear, "/y", i),
                            CURVES[c].apart * CURVES[c].scale);
                most = fmax(most, fabs(at(full, "/y", i) - at(linear, "/y", i)));
            }
            printf("[   INFO   ] %s, %s %s: %.4f apart\n", PRESSING[p], CURVES[c].name,
                   CURVES[c].series, most / CURVES[c].scale);
            assert_true(isfinite(at(linear, "/model_bound", 10)));
        }
        const cJSON *stick = curve_of(document, "sliding_stick_area", "", "full");
        const cJSON *area = curve_of(document, "sliding_contact_area", "", "full");
        if (p == 0)
            assert_near(at(stick, "/y", 0), 1, 0, 0);
        else
            assert_true(at(stick, "/y", 0) < 0.98 && at(area, "/y", 0) < 1);
        cJSON_Delete(document);
    }
}

/* Surfaces of small slopes and the coupled half-space, dragged along y: the same path, with all
 * curves and the error of the model. Directions of tractions turn until the end, so that the force
 * comes to mu P within a thousandth. */
static void surfaces_slide_as_the_half_space(void **state) {
    (void)state;
    cJSON *document =
        solve("{\"surface\": {\"hurst\": 0.8, \"wavelength_ratio\": 1.5, \"length_ratio\": 2, "
              "\"points_per_wavelength\": 8, \"rms_slope\": 0.01}, \"contact\": {\"cell_error\": "
              "\"none\", \"levels\": [4, 8], \"gap_weighting\": \"dual\", \"model\": "
              "[\"full\", \"halfspace\"], \"friction\": 0.3, \"slip\": {\"to\": [1.2], \"steps\": "
              "12, \"direction\": \"y\"}, \"pressures\": {\"values\": [0.1]}}}",
              1);
    static const struct {
        const char *name, *series;
        double scale, apart;
    } CURVES[] = {
        {"sliding_force", "", 0.3, 0.03},        {"sliding_stick_area", "", 1, 0.1},
        {"sliding_stick_load", "", 1, 0.1},      {"sliding_contact_area", "", 1, 0.05},
        {"sliding_dissipation", "", 0.03, 0.05}, {"sliding_gap", "", 1, 0.01},
        {"sliding_stick_area", "edges", 1, 0.1}, {"sliding_contact_area", "edges", 1, 0.02}};
    for (size_t c = 0; c < sizeof CURVES / sizeof *CURVES; c++) {
        const cJSON *full = curve_of(document, CURVES[c].name, CURVES[c].series, "full");
        const cJSON *linear = curve_of(document, CURVES[c].name, CURVES[c].series, "halfspace");
        double most = 0;
        assert_int_equal(points(full), 13);
        assert_int_equal(points(linear), 13);
        for (int i = 0; i < points(full); i++) {
            check_close(at(full, "/y", i), at(linear, "/y", i), CURVES[c].apart * CURVES[c].scale);
            most = fmax(most, fabs(at(full, "/y", i) - at(linear, "/y", i)));
        }
        printf("[   INFO   ] %s %s: %.4f apart\n", CURVES[c].name, CURVES[c].series,
               most / CURVES[c].scale);
        assert_true(isfinite(at(linear, "/model_bound", 6)));
    }
    const cJSON *force = curve_of(document, "sliding_force", "", "full");
    check_relative(at(force, "/y", 12), MU, 1e-3);
    assert_near(at(curve_of(document, "sliding_stick_area", "", "full"), "/y", 12), 0, 0, 1.2);
    cJSON_Delete(document);
}

/* To and fro: x is how far the flat has gone, tractions turn their sign, and friction takes work
 * all along. */
static void a_path_turns(void **state) {
    (void)state;
    cJSON *document =
        solve(STUDY("0.1", "\"model\": \"full\", \"friction\": 0.3, \"slip\": {\"to\": "
                           "[0.9, -0.9], \"steps\": 15}, \"pressures\": {\"values\": "
                           "[0.1]}"),
              2);
    const cJSON *force = curve_of(document, "sliding_force", "", "full");
    const cJSON *work = curve_of(document, "sliding_dissipation", "", "full");
    const cJSON *area = curve_of(document, "sliding_stick_area", "", "full");
    assert_int_equal(points(force), 31);
    for (int i = 1; i < points(force); i++) {
        assert_true(at(force, "/x", i) > at(force, "/x", i - 1));
        assert_true(at(work, "/y", i) >= at(work, "/y", i - 1));
    }
    assert_near(at(force, "/x", 30), 2.7, 1e-12, 0);
    assert_near(at(force, "/y", 15), MU, 1e-6, 0.9);
    assert_near(at(force, "/y", 30), -MU, 1e-6, 2.7);
    assert_true(at(area, "/y", 15) == 0 && at(area, "/y", 16) > 0 && at(area, "/y", 30) == 0);
    cJSON_Delete(document);
}

/* More points than loads, and fewer; with companions, and a model that has none of it. */
static void blocks_do_not_matter(void **state) {
    (void)state;
    static const char *const STUDIES[] = {
        STUDY("0.2",
              "\"model\": [\"halfspace\", \"layered\", \"full\"], \"levels\": [4, 8], "
              "\"friction\": 0.4, \"conductance\": true, \"pressures\": {\"values\": [0.1]}"),
        STUDY("0.1", "\"model\": \"full\", \"friction\": 0.4, \"slip\": {\"steps\": 2}, "
                     "\"pressures\": {\"values\": [0.01, 0.02, 0.05, 0.1, 0.2]}")};
    for (size_t s = 0; s < sizeof STUDIES / sizeof *STUDIES; s++) {
        char *one = in_blocks(STUDIES[s], 2, 2, NULL), *two = in_blocks(STUDIES[s], 2, 1, NULL);
        assert_string_equal(one, two);
        assert_non_null(strstr(one, "\"sliding_force\""));
        free(one);
        free(two);
    }
}

/* Steep faces with much friction: some paths end. Each has a note, the points before it values, and
 * the result is whole. */
static void a_path_that_ends_has_a_note(void **state) {
    (void)state;
    enum { COUNT = 5 };
    char *text =
        in_blocks(STUDY("0.5", "\"model\": \"full\", \"kinematics\": \"small\", \"friction\": 0.9, "
                               "\"pressures\": {\"values\": [0.2]}"),
                  COUNT, 3, NULL);
    cJSON *document = cJSON_Parse(text);
    const cJSON *force = curve_of(document, "sliding_force", "", "full");
    const cJSON *note, *notes = json_at(document, "/notes/kept");
    double before = 0;
    size_t slid = 0, all = 0;
    for (int i = 0; i < points(force); i++) {
        double missing = at(force, "/valueless", i);
        assert_true(missing >= before && missing <= COUNT);
        before = missing;
    }
    cJSON_ArrayForEach(note, notes) {
        const char *why = cJSON_GetStringValue(json_at(note, "/text"));
        assert_non_null(why);
        slid += strstr(why, "slid ") != NULL && strstr(why, "friction 0.9") != NULL;
        all++;
    }
    printf("[   INFO   ] %zu of %d ended, %zu of them while they slid\n", all, COUNT, slid);
    assert_non_null(json_at(document, "/notes/count"));
    check_close(json_at(document, "/notes/count")->valuedouble, before, 0);
    assert_true(slid > 0 && slid < COUNT);
    cJSON_Delete(document);
    free(text);
}

static void refuse(const char *study, const char *expected) {
    struct contact_case one_case;
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(study);
    assert_non_null(parameters);
    assert_int_equal(contact_case_read(&one_case, parameters, 0, NULL, &err), ERROR_INPUT);
    cJSON_Delete(parameters);
    assert_string_equal(err.text, expected);
}

static void what_does_not_fit_is_refused(void **state) {
    (void)state;
    refuse(STUDY("0.1", "\"model\": \"full\", \"friction\": 0.3, \"slip\": {\"direction\": \"y\"}"),
           "/contact/slip/direction: \"y\": profiles have one direction, x");
    refuse(STUDY("0.1", "\"model\": \"full\", \"friction\": 1.5"),
           "/contact/friction: 1.5; allowed with the model full: (0, 1]");
    refuse(STUDY("0.1", "\"model\": \"full\", \"slip\": {\"to\": [1]}"),
           "/contact/slip/to: belongs to /contact/friction with the model full");
    refuse(STUDY("0.1", "\"model\": \"layered\", \"friction\": 0.3, \"slip\": {\"steps\": 3}"),
           "/contact/slip/steps: belongs to /contact/friction with the model full");
    refuse(STUDY("0.1", "\"model\": \"full\", \"friction\": 0.3, \"slip\": {\"to\": [1, 1]}"),
           "/contact/slip/to: number 1, 1, is no turning point: from 0 the flat comes to 1; "
           "allowed: numbers that go forth and back");
    refuse(
        STUDY("0.1",
              "\"model\": \"full\", \"friction\": 0.3, \"slip\": {\"to\": [0.2, -0.1, -0.4]}"),
        "/contact/slip/to: number 2, -0.4, is no turning point: from 0.2 the flat comes to -0.1; "
        "allowed: numbers that go forth and back");
    refuse(
        STUDY("0.1", "\"model\": \"full\", \"friction\": 0.3, \"slip\": {\"to\": [0]}"),
        "/contact/slip/to: number 0, 0, is no turning point: from 0 the flat comes to 0; allowed: "
        "numbers that go forth and back");
    refuse(STUDY("0.1", "\"model\": \"full\", \"friction\": 0.3, \"slip\": {\"to\": [1, -1], "
                        "\"steps\": 600}"),
           "/contact/slip/steps: 600 steps to each of 2 turning points; allowed: 999 in all");
    refuse(STUDY("0.1", "\"model\": [\"halfspace\", \"full\"], \"friction\": 0.3, \"slip\": "
                        "{\"coupling\": true}"),
           "/contact/slip/coupling: the model full has none, but an infinite half-space; leave one "
           "of them out");
}

/* A load is held that is none of the study's: it becomes one, and no other is added. */
static void a_load_is_held(void **state) {
    (void)state;
    struct contact_case one_case;
    struct error err = {0};
    cJSON *parameters = cJSON_Parse(
        STUDY("0.1", "\"model\": \"full\", \"friction\": 0.3, \"slip\": {\"pressure\": 0.07}, "
                     "\"pressures\": {\"values\": [0.05, 0.1]}"));
    if (contact_case_read(&one_case, parameters, 0, NULL, &err) != 0)
        fail_msg("%s", err.text);
    assert_int_equal(one_case.load_count, 3);
    assert_int_equal(one_case.slip_load, 1);
    assert_near(one_case.loads[1], 0.07, 0, 0.07);
    assert_false(one_case.asked.of[FRICTION_AT]);
    assert_true(one_case.asked.of[SLIDING_AT]);
    assert_int_equal(contact_case_slots(&one_case), 31);
    assert_near(contact_case_slid(&one_case, 30), 1.2, 1e-12, 0);
    contact_case_clear(&one_case);
    cJSON_Delete(parameters);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_does_not_fit_is_refused),
        cmocka_unit_test(a_load_is_held),
        cmocka_unit_test(the_flat_slides_fully),
        cmocka_unit_test(small_slopes_slide_by_lighter_loads),
        cmocka_unit_test(small_slopes_slide_as_the_half_plane),
        cmocka_unit_test(surfaces_slide_as_the_half_space),
        cmocka_unit_test(a_path_turns),
        cmocka_unit_test(a_path_that_ends_has_a_note),
        cmocka_unit_test(blocks_do_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
