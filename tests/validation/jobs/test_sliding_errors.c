/* Reported errors of curves by sliding (friction at finite strain) cover the truth: meshes against
 * finer ones, the solver against a stricter one, on the same realisations. What the half-space
 * differs by, the error of its model, is known. */
#include "tests/support/contact_document.h"
#include "tests/support/effort.h"
#include <stdio.h>

enum { CURVES = 8, COUNT = 6 };
static const struct name {
    const char *quantity, *series;
} NAMES[CURVES] = {{"sliding_force", ""},
                   {"sliding_stick_area", ""},
                   {"sliding_stick_load", ""},
                   {"sliding_contact_area", ""},
                   {"sliding_gap", ""},
                   {"sliding_dissipation", ""},
                   {"sliding_contact_area", "edges"},
                   {"sliding_stick_area", "edges"}};

struct scene {
    double slope, friction, poisson;
    const char *pressing, *weighting;
};
static const struct scene SCENES[] = {{0.1, 0.3, 0.3, "frictionless", "dual"},
                                      {0.3, 0.3, 0.3, "frictional", "standard"},
                                      {0.2, 0.6, 0.45, "frictionless", "standard"},
                                      {0.05, 0.6, 0, "frictional", "dual"},
                                      {0.05, 0.3, 0.4999, "frictionless", "dual"}};

/* What sticks is not known by edges after pressing with friction. */
static size_t curves_of(const struct scene *scene) {
    return same_text(scene->pressing, "frictional") ? CURVES - 1 : CURVES;
}

static size_t scene_count(void) {
    return every_case() ? sizeof SCENES / sizeof *SCENES : 1;
}

static cJSON *solve_scene(const struct scene *scene, const char *levels, const char *more) {
    char study[900];
    snprintf(study, sizeof study,
             "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4,"
             " \"length_ratio\": 1, \"points_per_wavelength\": 32, \"rms_slope\": %g},"
             " \"contact\": {\"model\": [\"halfspace\", \"full\"], \"cell_error\": \"none\","
             " \"levels\": %s, \"friction\": %g, \"poisson\": %g, \"gap_weighting\": \"%s\", %s"
             " \"slip\": {\"to\": [%g], \"steps\": 12, \"pressing\": \"%s\"},"
             " \"pressures\": {\"values\": [0.1]}}}",
             scene->slope, levels, scene->friction, scene->poisson, scene->weighting, more,
             2 * scene->friction, scene->pressing);
    return solve(study, COUNT);
}

static double number_of(const cJSON *curve, const char *key, int k) {
    double value = at(curve, key, k);
    return isnan(value) ? 0 : value;
}

struct coverage {
    int points, covered;
};

static void count_point(const struct name *name, const cJSON *curve, int k, double miss,
                        double room, struct coverage *coverage) {
    double y = at(curve, "/y", k);
    if (isnan(miss))
        return;
    coverage->points++;
    coverage->covered += miss <= room + 1e-4 * fabs(y);
    if (!(miss <= room + 1e-4 * fabs(y)))
        print_message("%s %s at %g: %.4g is off by %.3g, allowed %.3g\n", name->quantity,
                      name->series, at(curve, "/x", k), y, miss, room);
}

static void check_coverage(const struct coverage *coverage, double least) {
    for (size_t c = 0; c < CURVES; c++) {
        print_message("%s %s: %d of %d covered\n", NAMES[c].quantity, NAMES[c].series,
                      coverage[c].covered, coverage[c].points);
        assert_true(coverage[c].points >= 12);
        assert_true(coverage[c].covered >= least * coverage[c].points);
    }
}

/* Reported less true lies within value +- bound, two standard errors of that, and what the
 * reference itself is not sure of. */
static void meshes(void **state) {
    (void)state;
    struct coverage coverage[CURVES] = {0};
    for (size_t s = 0; s < scene_count(); s++) {
        cJSON *document = solve_scene(&SCENES[s], "[4, 8]", "");
        cJSON *reference = solve_scene(&SCENES[s], "[16, 32]", "");
        for (size_t c = 0; c < curves_of(&SCENES[s]); c++) {
            const cJSON *curve = curve_of(document, NAMES[c].quantity, NAMES[c].series, "full");
            const cJSON *limit = curve_of(reference, NAMES[c].quantity, NAMES[c].series, "full");
            for (int k = 0; k < points(curve); k++) {
                double value = number_of(curve, "/discretisation_error", k);
                double off = at(curve, "/y", k) - value - at(limit, "/y", k) +
                             number_of(limit, "/discretisation_error", k);
                double room = number_of(curve, "/discretisation_bound", k) +
                              2 * number_of(curve, "/discretisation_standard_error", k) +
                              number_of(limit, "/discretisation_bound", k);
                count_point(&NAMES[c], curve, k, fabs(off), room, &coverage[c]);
            }
        }
        cJSON_Delete(document);
        cJSON_Delete(reference);
    }
    check_coverage(coverage, 0.9);
}

static void solvers(void **state) {
    (void)state;
    struct coverage coverage[CURVES] = {0};
    for (size_t s = 0; s < scene_count(); s++) {
        cJSON *document = solve_scene(&SCENES[s], "[8]", "\"tolerance\": 1e-4,");
        cJSON *exact = solve_scene(&SCENES[s], "[8]", "\"tolerance\": 1e-10,");
        for (size_t c = 0; c < curves_of(&SCENES[s]); c++) {
            const cJSON *curve = curve_of(document, NAMES[c].quantity, NAMES[c].series, "full");
            const cJSON *limit = curve_of(exact, NAMES[c].quantity, NAMES[c].series, "full");
            for (int k = 0; k < points(curve); k++)
                count_point(&NAMES[c], curve, k, fabs(at(curve, "/y", k) - at(limit, "/y", k)),
                            number_of(curve, "/solver_bound", k), &coverage[c]);
        }
        cJSON_Delete(document);
        cJSON_Delete(exact);
    }
    check_coverage(coverage, 0.9);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(meshes),
        cmocka_unit_test(solvers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
