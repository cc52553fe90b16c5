/* Protects: the text of a characterisation: values of a group under each other however long its
 * names, and values about a column in the unit of that. */
#include "server/show/map/named_values.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static char *print(const struct named_values *found) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    named_values_print(file, found);
    assert_int_equal(fclose(file), 0);
    return text;
}

static void values_under_each_other(void **state) {
    (void)state;
    struct named_values found = {.in_metres = true};
    named_values_add(&found, "short", "count", 3);
    named_values_add_length(&found, "long", "curvature_mean", 2e5, -1);
    named_values_add_length(&found, "long", "curvature_mean_error", 5e4, -1);
    named_values_add_text(&found, "long", "by", "summits");
    named_values_add(&found, "long", "nothing", NAN);
    char *text = print(&found);
    assert_string_equal(text, "short\n"
                              "  count              3\n"
                              "long\n"
                              "  curvature_mean       0.200 1/\xc2\xb5m\n"
                              "  curvature_mean_error 0.050 1/\xc2\xb5m\n"
                              "  by                   summits\n"
                              "  nothing              -\n");
    free(text);
    named_values_clear(&found);
}

static void fill_column(struct named_values *found, const char *name, double value, int power) {
    double *values = named_values_column_length(found, "scales", name, 2, power);
    assert_non_null(values);
    values[0] = values[1] = value;
}

static void columns_share_units(void **state) {
    (void)state;
    struct named_values found = {.in_metres = true};
    fill_column(&found, "rms_curvature", 100, -1);
    fill_column(&found, "rms_curvature_error", 0.5, -1);
    fill_column(&found, "rms_curvatures", 0.5, -1); /* another word */
    fill_column(&found, "none", NAN, 1);
    fill_column(&found, "none_error", 2e-9, 1);
    char *text = print(&found);
    assert_non_null(strstr(text, "rms_curvature[1/mm]"));
    assert_non_null(strstr(text, "rms_curvature_error[1/mm]"));
    assert_non_null(strstr(text, "rms_curvatures[1/m]"));
    assert_non_null(strstr(text, "none_error[nm]"));
    assert_non_null(strstr(text, " 0.1 "));
    assert_non_null(strstr(text, " 0.0005 "));
    free(text);
    named_values_clear(&found);
}

/* What is infinite has no value, in a row as by itself, and in JSON, where it is null. */
static void infinite_values_are_none(void **state) {
    (void)state;
    struct named_values found = {0};
    named_values_add(&found, "isotropy", "slope_ratio", INFINITY);
    fill_column(&found, "slope_ratio", INFINITY, 0);
    fill_column(&found, "rms_slope", -INFINITY, 1);
    char *text = print(&found);
    assert_non_null(strstr(text, "slope_ratio        -\n"));
    assert_null(strstr(text, "inf"));
    free(text);
    named_values_clear(&found);
}

/* Two digits of the error, or of half the interval, show how well a value is known. */
static void values_are_rounded_to_errors(void **state) {
    (void)state;
    struct named_values found = {0};
    named_values_add_length(&found, "heights", "mean", -1.7e-15, 1); /* taken out */
    named_values_add_length(&found, "heights", "rms", 128.595011, 1);
    named_values_add_length(&found, "heights", "rms_error", 2.246538, 1);
    named_values_add(&found, "heights", "skewness", 0.9565817917);
    named_values_add(&found, "heights", "skewness_error", 0.0414787);
    named_values_add(&found, "fit", "hurst", 0.6930700654);
    named_values_add(&found, "fit", "hurst_low", 0.6159386475);
    named_values_add(&found, "fit", "hurst_high", 0.7754065923);
    named_values_add(&found, "fit", "amplitude", 172665774.6);
    named_values_add(&found, "fit", "amplitude_error", 9123445.1);
    named_values_add(&found, "fit", "m0", 16536.67685);
    named_values_add(&found, "fit", "m0_error", 577.787);
    named_values_add(&found, "fit", "p_value", 2.924107827e-14);
    named_values_add(&found, "fit", "slope_x", 1.23456e-5);
    named_values_add(&found, "fit", "slope_x_error", 1e-9);
    named_values_add(&found, "fit", "count", 1048576);
    named_values_add(&found, "fit", "nothing", 0);
    named_values_add(&found, "fit", "nothing_error", 0.1);
    char *text = print(&found);
    assert_string_equal(text, "heights\n"
                              "  mean               0\n"
                              "  rms                128.6\n"
                              "  rms_error          2.2\n"
                              "  skewness           0.957\n"
                              "  skewness_error     0.041\n"
                              "fit\n"
                              "  hurst              0.693\n"
                              "  hurst_low          0.616\n"
                              "  hurst_high         0.775\n"
                              "  amplitude          1.73e+08\n"
                              "  amplitude_error    9.1e+06\n"
                              "  m0                 16540\n"
                              "  m0_error           580\n"
                              "  p_value            2.92411e-14\n"
                              "  slope_x            1.235e-05\n"
                              "  slope_x_error      1e-09\n"
                              "  count              1048576\n"
                              "  nothing            0.00\n"
                              "  nothing_error      0.10\n");
    free(text);
}

static void groups_are_kept(void **state) {
    (void)state;
    struct named_values found = {0};
    const char *unknown;
    size_t length;
    named_values_add(&found, "heights", "rms", 1);
    named_values_add(&found, "height", "rms", 2);
    fill_column(&found, "length", 3, 1); /* of scales */
    assert_false(named_values_keep(&found, "heights,scale", &unknown, &length));
    assert_true(length == 5 && strncmp(unknown, "scale", 5) == 0);
    assert_false(named_values_keep(&found, "heights,", &unknown, &length));
    assert_false(named_values_keep(&found, "", &unknown, &length));
    assert_true(named_values_keep(&found, "scales,heights", &unknown, &length));
    assert_true(found.count == 1 && found.column_count == 1 && found.list[0].value == 1);
    assert_true(named_values_keep(&found, "heights", &unknown, &length));
    assert_int_equal(found.column_count, 0);
    named_values_clear(&found);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_under_each_other),  cmocka_unit_test(columns_share_units),
        cmocka_unit_test(infinite_values_are_none), cmocka_unit_test(values_are_rounded_to_errors),
        cmocka_unit_test(groups_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
