/* Reported errors of the cell cover the truth, against cells that are many times as long, at every
 * load: in profiles whose means fall with the length (Gaussian) and fall and rise again (Weibull,
 * log-normal), and in surfaces. They are not much larger than that. */
#include "tests/support/contact_document.h"
#include "tests/support/effort.h"
#include <stdio.h>

struct scene {
    int dimension;
    const char *heights;
    double shape;
    int length, reference;          /* in longest waves */
    uint64_t realisations, control; /* of the one, and of the reference */
};

static cJSON *solve_length(const struct scene *scene, int length, const char *contact,
                           uint64_t realisations) {
    char study[1024];
    snprintf(study, sizeof study,
             "{\"surface\": {\"dimension\": %d, \"hurst\": 0.8, \"wavelength_ratio\": %d,"
             " \"length_ratio\": %d, \"points_per_wavelength\": 4, \"rms_slope\": 0.1,"
             " \"heights\": {\"distribution\": \"%s\", \"shape\": %g}}, \"contact\": {%s"
             " \"tolerance\": 1e-6, \"pressures\": {\"values\": [0.003, 0.01, 0.02, 0.03, 0.05,"
             " 0.1, 0.2, 0.3]}}}",
             scene->dimension, scene->dimension == 1 ? 8 : 4, length, scene->heights, scene->shape,
             contact);
    return solve(study, realisations * effort());
}

static bool same_reference(const struct scene *a, const struct scene *b) {
    return a->dimension == b->dimension && strcmp(a->heights, b->heights) == 0 &&
           a->shape == b->shape && a->reference == b->reference && a->control == b->control;
}

struct coverage {
    int points, covered, within; /* within: sizes that are less than three times the
                                  * truth, or 3 % of the value */
};

/* Of a mean over the cell, whose patches are reported as shares of it. */
static void count_curve(const struct scene *scene, const cJSON *curve, const cJSON *reference,
                        double scale, struct coverage *coverage) {
    for (int k = 0; k < points(curve); k++) {
        double y = at(curve, "/y", k), limit = scale * at(reference, "/y", k);
        double chance =
            hypot(at(curve, "/standard_error", k), scale * at(reference, "/standard_error", k));
        double error = at(curve, "/cell_error", k), bound = at(curve, "/cell_bound", k);
        double room = bound + 2 * chance; /* the bound has that of the error itself */
        if (isnan(y) || isnan(limit))
            continue;
        coverage->points++;
        coverage->covered += fabs(y - error - limit) <= room;
        coverage->within += fabs(error) + bound <= fmax(3 * fabs(y - limit), 0.03 * fabs(y));
        if (!(fabs(y - error - limit) <= room))
            print_message("%d %s %d %s %s at %g: %g of %g\n", scene->dimension, scene->heights,
                          scene->length, json_at(curve, "/quantity")->valuestring,
                          json_at(curve, "/series")->valuestring, at(curve, "/x", k),
                          (y - error - limit) / y, room / y);
    }
}

static void errors_of_cells_cover(void **state) {
    (void)state;
    static const struct scene SCENES[] = {
        {1, "gaussian", 1, 1, 32, 512, 256},    {1, "gaussian", 1, 2, 32, 512, 256},
        {1, "gaussian", 1, 4, 32, 256, 256},    {1, "weibull_min", 1, 1, 32, 512, 256},
        {1, "weibull_min", 1, 2, 32, 512, 256}, {1, "weibull_min", 1, 4, 32, 256, 256},
        {2, "weibull_min", 1, 1, 4, 128, 16},   {2, "gaussian", 1, 1, 4, 128, 16},
        {1, "lognormal", 0.6, 2, 64, 512, 128},
    };
    static const char *const CURVES[][2] = {
        {"contact_area", "edges"}, {"contact_area", "edges_stretched"},
        {"contact_area", "nodes"}, {"mean_gap", ""},
        {"stiffness", ""},         {"patch_count", "wave"},
        {"patch_mean_area", ""}};
    struct coverage coverage = {0};
    cJSON *true_ones = NULL;
    for (size_t s = 0; s < sizeof SCENES / sizeof *SCENES; s += case_step()) {
        const struct scene *scene = &SCENES[s];
        cJSON *told = solve_length(scene, scene->length, "", scene->realisations);
        if (s == 0 || !same_reference(scene, scene - case_step())) {
            cJSON_Delete(true_ones);
            true_ones =
                solve_length(scene, scene->reference, "\"cell_error\": \"none\",", scene->control);
        }
        for (size_t a = 0; a < sizeof CURVES / sizeof *CURVES; a++) {
            double patches = pow((double)scene->reference / scene->length, scene->dimension);
            bool share = strcmp(CURVES[a][0], "patch_mean_area") == 0;
            count_curve(scene, curve_of(told, CURVES[a][0], CURVES[a][1], "halfspace"),
                        curve_of(true_ones, CURVES[a][0], CURVES[a][1], "halfspace"),
                        share ? patches : 1, &coverage);
        }
        cJSON_Delete(told);
    }
    cJSON_Delete(true_ones);
    print_message("%d of %d covered, %d closely\n", coverage.covered, coverage.points,
                  coverage.within);
    assert_true(coverage.points > (every_case() ? 400 : 150));
    assert_true(coverage.covered >= 0.99 * coverage.points);
    assert_true(coverage.within >= 0.8 * coverage.points);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(errors_of_cells_cover)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
