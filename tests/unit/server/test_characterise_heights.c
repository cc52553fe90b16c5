/* Protects: what characterise tells of chance in a map: errors behind their values, the fit of the
 * heights, isotropy and stationarity; and that a map too small for it says so and tells none. */
#include "server/show/characterise_heights.h"
#include "tests/support/check.h"
#include "tests/support/noise.h"
#include <stdlib.h>
#include <string.h>

enum { SIDE = 64, POINTS = SIDE * SIDE };
static const struct grid GRID = {SIDE, SIDE, 32, 32};

static void characterise(const double *z, struct characterisation *out) {
    const struct measured_map map = {&GRID, z, BOUNDARY_OPEN};
    struct map_chance *chance = NULL;
    assert_int_equal(map_chance_create(&chance, &map, NULL), 0);
    assert_int_equal(characterise_open(out, &map, chance, NULL), 0);
    assert_int_equal(characterise_chance(out, &map, chance, NULL), 0);
    assert_int_equal(characterise_scales(out, &map, chance, NULL), 0);
    map_chance_destroy(&chance);
}

static size_t place_of(const struct characterisation *found, const char *group, const char *name) {
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
    static struct characterisation found;
    noise_fill(&seed, POINTS, z);
    characterise(z, &found);
    for (size_t n = 0; n < sizeof NAMES / sizeof *NAMES; n++) {
        size_t value = place_of(&found, NAMES[n][0], NAMES[n][1]);
        const struct characteristic *error = &found.list[value + 1];
        assert_string_equal(error->name, NAMES[n][2]);
        assert_int_equal(error->power, found.list[value].power);
        assert_true(error->value > 0);
    }
    check_relative(characterisation_value(&found, "heights", "rms_error"), sqrt(0.5 / POINTS), 0.7);
    assert_string_equal(characterisation_text(&found, "height_fit", "distribution"), "gaussian");
    assert_true(characterisation_value(&found, "height_fit", "p_value") > 1e-4);
    assert_true(characterisation_value(&found, "isotropy", "p_value") > 1e-4);
    assert_true(characterisation_value(&found, "stationarity", "p_value") > 1e-4);
    assert_string_equal(characterisation_text(&found, "uncertainty", "errors"), "standard");
    check_close(characterisation_find_column(&found, "angular_spectrum", "slope")->values[18], 1,
                1);
    assert_true(characterisation_find_column(&found, "scales", "rms_slope_error")->values[0] > 0);
    characterisation_clear(&found);
}

/* One wave: nothing in it is independent. */
static void too_few_lengths(void **state) {
    (void)state;
    static double z[POINTS];
    static struct characterisation found;
    for (size_t point = 0; point < POINTS; point++)
        z[point] = cos(2 * M_PI * (double)(point % SIDE) / SIDE);
    characterise(z, &found);
    assert_string_equal(characterisation_text(&found, "uncertainty", "errors"),
                        "none: too few correlation lengths");
    for (size_t n = 0; n < found.count; n++)
        assert_null(strstr(found.list[n].name, "rms_error"));
    assert_true(isnan(characterisation_value(&found, "height_fit", "p_value")));
    assert_true(characterisation_value(&found, "height_fit", "distance") > 0.01);
    assert_true(isnan(characterisation_value(&found, "isotropy", "p_value")));
    assert_true(characterisation_value(&found, "isotropy", "slope_ratio") > 10);
    assert_true(isnan(characterisation_value(&found, "stationarity", "p_value")));
    characterisation_clear(&found);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(errors_behind_values),
                                       cmocka_unit_test(too_few_lengths)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
