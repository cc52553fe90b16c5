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
                              "  curvature_mean       0.2 1/\xc2\xb5m\n"
                              "  curvature_mean_error 0.05 1/\xc2\xb5m\n"
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_under_each_other),
        cmocka_unit_test(columns_share_units),
        cmocka_unit_test(infinite_values_are_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
