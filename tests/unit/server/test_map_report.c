/* Protects: what is reported of a map, by name: errors stand behind the values that they are of, in
 * their units; columns hold what was measured; and a map too small for errors says so and has
 * none. */
#include "server/show/map/functional_report.h"
#include "server/show/map/map_report.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <stdlib.h>
#include <string.h>

enum { SIDE = 64, POINTS = SIDE * SIDE };

static void report(double *z, struct map_characterisation *measured, struct named_values *found) {
    const struct height_map map = {.grid = {SIDE, SIDE, 32, 32}, .z = z};
    const struct preparation_record record = {
        .boundary = BOUNDARY_OPEN, .boundary_by = "option", .window_power = 1};
    struct error err = {0};
    *measured = (struct map_characterisation){0};
    if (map_characterise(measured, &map, &record, &(struct spectrum_fit_request){0}, MAP_WHOLE,
                         &err) != 0 ||
        map_report_fill(found, measured, &map, &record, &err) != 0)
        fail_msg("%s", err.text);
}

static size_t place_of(const struct named_values *found, const char *group, const char *name) {
    for (size_t n = 0; n < found->count; n++)
        if (strcmp(found->list[n].group, group) == 0 && strcmp(found->list[n].name, name) == 0)
            return n;
    fail_msg("no %s.%s", group, name);
    return 0;
}

static void errors_behind_values(void **state) {
    (void)state;
    static const char *const NAMES[][3] = {
        {"heights", "rms", "rms_error"},
        {"heights", "skewness", "skewness_error"},
        {"finite_difference", "rms_curvature", "rms_curvature_error"},
        {"interpolated", "m4", "m4_error"},
        {"summits_nine_point", "density", "density_error"},
        {"summits_refined", "height_mean", "height_mean_error"}};
    uint64_t seed = seed_or(14);
    static double z[POINTS];
    static struct map_characterisation measured;
    static struct named_values found;
    noise_fill(&seed, POINTS, z);
    report(z, &measured, &found);
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++) {
        size_t value = place_of(&found, NAMES[n][0], NAMES[n][1]);
        const struct named_value *error = &found.list[value + 1];
        assert_string_equal(error->name, NAMES[n][2]);
        assert_int_equal(error->power, found.list[value].power);
        assert_true(error->value > 0);
    }
    check_relative(named_number(&found, "heights", "rms_error"), sqrt(0.5 / POINTS), 0.7);
    assert_string_equal(named_text(&found, "height_fit", "distribution"), "gaussian");
    const struct named_column *law = named_column_find(&found, "psd", "density_fitted");
    assert_true((law != NULL) == measured.spectra.fit.fitted);
    assert_true(named_number(&found, "height_fit", "p_value") > 1e-4);
    assert_true(named_number(&found, "isotropy", "p_value") > 1e-4);
    assert_true(named_number(&found, "stationarity", "p_value") > 1e-4);
    assert_string_equal(named_text(&found, "uncertainty", "errors"), "standard");
    check_close(named_column_find(&found, "angular_spectrum", "slope")->values[18], 1, 1);
    assert_true(named_column_find(&found, "scales", "rms_slope_error")->values[0] > 0);
    named_values_clear(&found);
    map_characterisation_clear(&measured);
}

/* One wave: nothing in it is independent. */
static void too_few_lengths(void **state) {
    (void)state;
    static double z[POINTS];
    static struct map_characterisation measured;
    static struct named_values found;
    for (size_t point = 0; point < POINTS; point++)
        z[point] = cos(2 * M_PI * (double)(point % SIDE) / SIDE);
    report(z, &measured, &found);
    assert_string_equal(
        named_text(&found, "uncertainty", "errors"),
        "none: along some direction heights stay correlated all over the map, as along grooves");
    for (size_t n = 0; n < found.count; n++)
        assert_null(strstr(found.list[n].name, "rms_error"));
    assert_true(isnan(named_number(&found, "height_fit", "p_value")));
    /* of which the heights are beta's with shapes of 1/2: its density is 1/(pi sqrt(1 - z^2)) */
    assert_string_equal(named_text(&found, "height_fit", "distribution"), "beta");
    check_close(named_number(&found, "height_fit", "shape"), 0.5, 0.05);
    assert_true(named_number(&found, "height_fit", "gaussian_distance") > 0.01);
    assert_true(isnan(named_number(&found, "isotropy", "p_value")));
    assert_true(named_number(&found, "isotropy", "slope_ratio") > 10);
    assert_true(isnan(named_number(&found, "stationarity", "p_value")));
    named_values_clear(&found);
    map_characterisation_clear(&measured);
}

/* Functional parameters are there under the names of surfaces, or of profiles, and agree with the
 * curve beside them. */
static void functional_values_by_name(void **state) {
    (void)state;
    static const char *const NAMES[2][8] = {
        {"Sk", "Spk", "Svk", "Sk_secant", "Vmp", "Vvv", "S10z", "dales"},
        {"Rk", "Rpk", "Rvk", "Rk_secant", "RSm", "RSm_1997", "Rmr1", "RSm_elements"}};
    uint64_t seed = seed_or(15);
    static double z[POINTS];
    for (int profile = 0; profile < 2; profile++) {
        static struct map_functional measured;
        struct summit_list hills = {0};
        static struct named_values found;
        const struct grid grid = {profile == 1 ? POINTS : SIDE, profile == 1 ? 1 : SIDE, 32, 32};
        const struct measured_map map = {&grid, z, BOUNDARY_OPEN};
        found = (struct named_values){0};
        noise_fill(&seed, POINTS, z);
        assert_int_equal(
            map_functional_measure(&measured, &map, profile == 1 ? NULL : &hills, 7, NULL, NULL),
            0);
        functional_report_values(&found, &measured, profile == 1);
        assert_int_equal(functional_report_table(&found, &measured, NULL), 0);
        for (size_t n = 0; n < 8; n++)
            (void)place_of(&found, "functional", NAMES[profile][n]);
        check_relative(named_number(&found, "functional", NAMES[profile][0]), 2.574, 0.1);
        assert_true(isnan(named_number(&found, "functional", NAMES[1 - profile][0])));
        const struct named_column *ratio = named_column_find(&found, "material_ratio", "ratio");
        const struct named_column *height = named_column_find(&found, "material_ratio", "height");
        assert_true(ratio != NULL && height != NULL && height->power == 1);
        for (size_t r = 1; r < ratio->count; r++)
            assert_true(ratio->values[r] > ratio->values[r - 1] &&
                        height->values[r] < height->values[r - 1]);
        assert_true(isnan(named_number(&found, "functional", profile == 1 ? "Rpq" : "Spq")));
        named_values_clear(&found);
    }
}

/* The laws of a stratified face are there where no Gaussian law fits, and not where one does. */
static void stratified_faces_have_two_laws(void **state) {
    (void)state;
    uint64_t seed = seed_or(16);
    static double z[POINTS], valleys[POINTS];
    static struct map_characterisation measured;
    static struct named_values found;
    for (int stratified = 0; stratified < 2; stratified++) {
        found = (struct named_values){0};
        noise_fill(&seed, POINTS, z);
        noise_fill(&seed, POINTS, valleys);
        for (size_t n = 0; n < POINTS && stratified == 1; n++)
            z[n] = fmin(z[n], 6 + 8 * valleys[n]);
        report(z, &measured, &found);
        assert_true(isfinite(named_number(&found, "functional", "Sk")));
        if (stratified == 1) {
            check_relative(named_number(&found, "functional", "Spq"), 1, 0.2);
            check_relative(named_number(&found, "functional", "Svq"), 8, 0.2);
            assert_true(named_number(&found, "functional", "Spq_error") > 0);
            assert_true(named_number(&found, "functional", "Sk_error") > 0);
        } else
            assert_true(isnan(named_number(&found, "functional", "Spq")));
        named_values_clear(&found);
        map_characterisation_clear(&measured);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(errors_behind_values),
                                       cmocka_unit_test(too_few_lengths),
                                       cmocka_unit_test(functional_values_by_name),
                                       cmocka_unit_test(stratified_faces_have_two_laws)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
