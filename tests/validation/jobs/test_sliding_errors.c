/* Reported errors of curves by sliding (friction at finite strain) cover the truth: meshes against
 * finer ones, the solver against a stricter one, on the same realisations. */
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

static const struct scene SINGLE[] = {
    {0.05, 0.3, 0.3, "frictionless", "dual"},   {0.1, 0.3, 0.3, "frictionless", "dual"},
    {0.3, 0.3, 0.3, "frictionless", "dual"},    {0.05, 0.3, 0.4999, "frictionless", "dual"},
    {0.1, 0.3, 0.4999, "frictionless", "dual"}, {0.3, 0.3, 0.4999, "frictionless", "dual"}};

/* What sticks is not known by edges after pressing with friction. */
static size_t curves_of(const struct scene *scene) {
    return same_text(scene->pressing, "frictional") ? CURVES - 1 : CURVES;
}

static size_t scene_count(void) {
    return every_case() ? sizeof SCENES / sizeof *SCENES : 1;
}

/* Profiles that are solved together: realisations from the first one on. */
struct group {
    const struct scene *scene;
    uint64_t first, count;
};

static cJSON *solve_scene(const struct group *group, const char *levels, const char *more) {
    const struct scene *scene = group->scene;
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
    return solve_from(study, group->first, group->count);
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
 * reference itself is not sure of; the true value is in the total with the last. */
static void count_meshes(const struct group *group, struct coverage *meshes,
                         struct coverage *totals) {
    cJSON *document = solve_scene(group, "[4, 8]", "");
    cJSON *reference = solve_scene(group, "[16, 32]", "");
    for (size_t c = 0; c < curves_of(group->scene); c++) {
        const cJSON *curve = curve_of(document, NAMES[c].quantity, NAMES[c].series, "full");
        const cJSON *limit = curve_of(reference, NAMES[c].quantity, NAMES[c].series, "full");
        for (int k = 0; k < points(curve); k++) {
            double truth = at(limit, "/y", k) - number_of(limit, "/discretisation_error", k);
            double unsure = number_of(limit, "/discretisation_bound", k);
            double off = at(curve, "/y", k) - number_of(curve, "/discretisation_error", k) - truth;
            double room = number_of(curve, "/discretisation_bound", k) +
                          2 * number_of(curve, "/discretisation_standard_error", k);
            double out =
                fmax(at(curve, "/total_low", k) - truth, truth - at(curve, "/total_high", k));
            count_point(&NAMES[c], curve, k, fabs(off), room + unsure, &meshes[c]);
            count_point(&NAMES[c], curve, k, out, unsure, &totals[c]);
        }
    }
    cJSON_Delete(document);
    cJSON_Delete(reference);
}

static void meshes(void **state) {
    (void)state;
    struct coverage coverage[CURVES] = {0}, totals[CURVES] = {0};
    for (size_t s = 0; s < scene_count(); s++)
        count_meshes(&(struct group){&SCENES[s], 0, COUNT}, coverage, totals);
    check_coverage(coverage, 0.9);
    check_coverage(totals, 0.9);
}

/* As meshes, of profiles by themselves, as that of a map is, over slope and Poisson's ratio: one of
 * two scenes, with RUGO_EFFORT four times as many of all. */
static void single_profiles(void **state) {
    (void)state;
    struct coverage coverage[CURVES] = {0}, totals[CURVES] = {0};
    const uint64_t count = every_case() ? 4 * effort() : 1;
    for (size_t s = every_case() ? 0 : 1; s < sizeof SINGLE / sizeof *SINGLE;
         s += every_case() ? 1 : 4)
        for (uint64_t r = 0; r < count; r++)
            count_meshes(&(struct group){&SINGLE[s], r, 1}, coverage, totals);
    check_coverage(coverage, 0.9);
    check_coverage(totals, 0.9);
}

static void solvers(void **state) {
    (void)state;
    struct coverage coverage[CURVES] = {0};
    for (size_t s = 0; s < scene_count(); s++) {
        const struct group group = {&SCENES[s], 0, COUNT};
        cJSON *document = solve_scene(&group, "[8]", "\"tolerance\": 1e-4,");
        cJSON *exact = solve_scene(&group, "[8]", "\"tolerance\": 1e-10,");
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
        cmocka_unit_test(single_profiles),
        cmocka_unit_test(solvers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
