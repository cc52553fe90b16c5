/* Protects: what is reported of a map, by name: errors stand behind the values that they are of, in
 * their units; columns hold what was measured; and a map too small for errors says so and has
 * none. */
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
    if (map_characterise(measured, &map, &record, &(struct spectrum_fit_request){0}, &err) != 0 ||
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
    assert_string_equal(named_text(&found, "uncertainty", "errors"),
                        "none: too few correlation lengths");
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

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(errors_behind_values),
                                       cmocka_unit_test(too_few_lengths)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
