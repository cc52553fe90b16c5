/* The model on the true geometry in contact studies: where slopes are small it is the layered model
 * of the same mesh and Westergaard's wave; it gives what no linear model has; a surface that it
 * cannot press costs that realisation's values alone. */
#include "tests/support/contact_document.h"
#include <stdio.h>

#define ROUGH(slope, kinematics)                                                                   \
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 4, \"length_ratio\":"  \
    " 2, \"points_per_wavelength\": 8, \"rms_slope\": " slope                                      \
    "}, \"contact\": {\"cell_error\": \"none\", \"model\":"                                        \
    " [\"layered\", \"full\"], \"kinematics\": \"" kinematics "\","                                \
    " \"pressures\": {\"values\": [0.05, 0.1, 0.2, 0.3]}}}"

/* On the same realisations. Differences fall with the slope, 1e-3 (test_full.c): over it they are
 * up to 0.5 of hencky and small, and 3 of st_venant_kirchhoff, which is softer under pressure;
 * bounds twice that. */
static void small_slopes_are_layered(void **state) {
    (void)state;
    static const struct {
        const char *study, *kinematics;
        double bound;
    } CASES[] = {{ROUGH("1e-3", "hencky"), "hencky", 1e-3},
                 {ROUGH("1e-3", "small"), "small", 1e-3},
                 {ROUGH("1e-3", "st_venant_kirchhoff"), "st_venant_kirchhoff", 6e-3}};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        cJSON *document = solve(CASES[c].study, 3);
        static const char *const quantities[][2] = {{"contact_area", "edges"}, {"mean_gap", ""}};
        for (size_t q = 0; q < 2; q++) {
            const cJSON *linear = curve_of(document, quantities[q][0], quantities[q][1], "layered");
            const cJSON *full = curve_of(document, quantities[q][0], quantities[q][1], "full");
            assert_true(text_is(full, "/kinematics", CASES[c].kinematics));
            assert_null(json_at(linear, "/kinematics"));
            assert_null(json_at(full, "/model_error"));
            for (int k = 0; k < points(full); k++) {
                double y = at(full, "/y", k), load = at(full, "/x", k);
                assert_near(at(linear, "/y", k), y, CASES[c].bound * y, load);
                /* one level does not estimate its own error, which would be in the difference */
                assert_true(cJSON_IsNull(json_at(linear, "/model_error")));
                assert_near(at(full, "/valueless", k), 0, 0, load);
            }
        }
        cJSON_Delete(document);
    }
}

#define BESIDE(slope, poisson)                                                                     \
    "{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 8, \"length_ratio\":"  \
    " 2, \"points_per_wavelength\": 16, \"rms_slope\": " slope                                     \
    "}, \"contact\": {\"cell_error\": \"none\", \"model\":"                                        \
    " [\"halfspace\", \"layered\", \"full\"], \"poisson\": " poisson ", \"levels\": [8, 16],"      \
    " \"gap_weighting\": \"dual\", \"pressures\": {\"values\": [0.05, 0.1, 0.3]}}}"

/* The area of both linear models, stretched, less that of full at the limit of the meshes: what is
 * left falls with the slope (test_full_face.c has the bounds, of one mesh); another 2e-3 is how
 * well two levels know the limit. Undeformed areas are further off. */
static void linear_models_know_the_stretch(void **state) {
    (void)state;
    static const struct {
        const char *study;
        double bound,
            undeformed; /* over the area; undeformed: error that is exceeded at all loads */
    } CASES[] = {{BESIDE("0.01", "0.3"), 0.05 * 0.01, 0},
                 {BESIDE("0.1", "0"), 0.11 * 0.1, 0.02},
                 {BESIDE("0.1", "0.3"), 0.05 * 0.1, 0.012},
                 {BESIDE("0.1", "0.4999"), 0.035 * 0.1, 0}};
    static const char *const MODELS[] = {"halfspace", "layered"};
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        cJSON *document = solve(CASES[c].study, 4);
        for (size_t m = 0; m < 2; m++) {
            const cJSON *curve = curve_of(document, "contact_area", "edges_stretched", MODELS[m]);
            const cJSON *plain = curve_of(document, "contact_area", "edges", MODELS[m]);
            for (int k = 0; k < points(curve); k++) {
                double y = at(curve, "/y", k), error = at(curve, "/model_error", k);
                assert_near(error, 0, (CASES[c].bound + 2e-3) * y, at(curve, "/x", k));
                assert_true(at(plain, "/model_error", k) > CASES[c].undeformed * y ||
                            CASES[c].undeformed == 0);
            }
        }
        cJSON_Delete(document);
    }
}

/* RMS slope 0.004, height/length 0.0009: finite slope is worth 0.1 %; 1 % at 64 points a wave, as
 * of the linear models. The gap is an integral: 0.002 of sqrt(m0). */
static void one_low_wave_is_westergaards(void **state) {
    (void)state;
    cJSON *document =
        solve("{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 1, "
              "\"length_ratio\":"
              " 1, \"points_per_wavelength\": 64, \"rms_slope\": 0.004}, \"contact\": "
              "{\"cell_error\": \"none\", \"model\":"
              " \"full\", \"pressures\": {\"to\": 0.68, \"steps\": 17}}}",
              2);
    const cJSON *area = curve_of(document, "contact_area", "edges", "full");
    const cJSON *gap = curve_of(document, "mean_gap", "", "full");
    for (int k = 0; k < points(area); k++) {
        double load = at(area, "/x", k), exact = at(area, "/theory/westergaard", k);
        assert_near(at(area, "/y", k), exact, 0.01 * exact, load);
        assert_near(at(gap, "/y", k), at(gap, "/theory/westergaard", k), 0.002, load);
    }
    cJSON_Delete(document);
}

static double scalar(const cJSON *document, const char *pointer) {
    const cJSON *value = json_at(document, pointer);
    return cJSON_IsNumber(value) ? value->valuedouble : NAN;
}

/* What a step ends with is reported: Newton's iterations, forces in balance, nothing through the
 * flat, and sideways strain, whose size at slope 0.2 and hencky is some percent. */
static void what_the_model_tells(void **state) {
    (void)state;
    cJSON *document = solve(ROUGH("0.2", "hencky"), 2);
    const cJSON *stretch = curve_of(document, "stretch", "", "full");
    const cJSON *cuts = curve_of(document, "load_cuts", "", "full");
    const cJSON *iterations = curve_of(document, "iterations", "", "full");
    double sum = 0;
    for (int k = 0; k < points(stretch); k++) {
        assert_true(at(stretch, "/y", k) > 0.8 && at(stretch, "/y", k) < 1.2);
        assert_true(at(cuts, "/y", k) >= 0);
        sum += at(iterations, "/y", k);
    }
    assert_near(scalar(document, "/scalars/full_iterations/value"), sum, 1e-9 * sum, 0);
    assert_near(scalar(document, "/scalars/full_load_reached/value"), 0.3, 1e-12, 0);
    assert_near(scalar(document, "/scalars/full_force_balance/value"), 0, 1e-6, 0);
    assert_near(scalar(document, "/scalars/full_weighted_penetration/value"), 0, 1e-6, 0);
    /* Nodes between those that carry the load lie in the flat: some percent of the RMS height. */
    double deepest = scalar(document, "/scalars/full_penetration/value");
    assert_true(deepest > 1e-3 && deepest < 0.3);
    assert_near(scalar(document, "/scalars/full_stretch/value"),
                at(stretch, "/y", points(stretch) - 1), 1e-12, 0);
    /* The Jacobian of a column sheared by the steepest slope s, over its edges, is 1/sqrt(1 + s^2);
     * layers thinned by the heights take somewhat more. */
    double slope = scalar(document, "/scalars/full_steepest_slope/value");
    double quality = scalar(document, "/scalars/full_mesh_quality/value");
    assert_true(slope > scalar(document, "/scalars/rms_slope/value") && slope < 2);
    assert_true(quality > 0.5 && quality < 1 / sqrt(1 + slope * slope) + 0.01);
    cJSON_Delete(document);
}

/* RMS slope 1.9: some surfaces are too steep to mesh, or to press in the time they have, the others
 * keep their values, a failure lasts, and the linear model beside sees all. */
static void steep_realisations_have_no_values(void **state) {
    (void)state;
    enum { COUNT = 12 };
    cJSON *document =
        solve("{\"surface\": {\"dimension\": 1, \"hurst\": 0.8, \"wavelength_ratio\": 2, "
              "\"length_ratio\":"
              " 2, \"points_per_wavelength\": 6, \"rms_slope\": 1.9}, \"contact\": "
              "{\"cell_error\": \"none\", \"model\":"
              " [\"halfspace\", \"full\"], \"time_limit\": 0.7, \"pressures\": {\"values\": [0.01, "
              "0.2, 0.5, 1]}}}",
              COUNT);
    const cJSON *full = curve_of(document, "contact_area", "nodes", "full");
    const cJSON *linear = curve_of(document, "contact_area", "nodes", "halfspace");
    int last = points(full) - 1;
    for (int k = 0; k <= last; k++) {
        double valueless = at(full, "/valueless", k);
        assert_true(valueless >= (k > 0 ? at(full, "/valueless", k - 1) : 0) && valueless <= COUNT);
        assert_true(at(linear, "/y", k) > 0 && at(linear, "/standard_error", k) > 0);
        assert_int_equal(isnan(at(full, "/y", k)), valueless == COUNT);
    }
    assert_true(at(full, "/valueless", last) > 0 && at(full, "/valueless", 0) < COUNT);
    double reached = scalar(document, "/scalars/full_load_reached/value");
    assert_true(reached > 0 && reached < 1);
    cJSON_Delete(document);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_slopes_are_layered),
        cmocka_unit_test(linear_models_know_the_stretch),
        cmocka_unit_test(one_low_wave_is_westergaards),
        cmocka_unit_test(what_the_model_tells),
        cmocka_unit_test(steep_realisations_have_no_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
