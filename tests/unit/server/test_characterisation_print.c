/* Protects: the text of a characterisation: values of a group under each other however long its
 * names, and what tells of a column in the unit of that. */
#include "server/show/characterisation.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

static char *print(const struct characterisation *found) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    characterisation_print(file, found);
    assert_int_equal(fclose(file), 0);
    return text;
}

static void values_under_each_other(void **state) {
    (void)state;
    struct characterisation found = {.in_metres = true};
    characterisation_add(&found, "short", "count", 3);
    characterisation_add_length(&found, "long", "curvature_mean", 2e5, -1);
    characterisation_add_error(&found, "long", "curvature_mean", "curvature_mean_error", 5e4);
    characterisation_add_text(&found, "long", "by", "summits");
    characterisation_add(&found, "long", "nothing", NAN);
    char *text = print(&found);
    assert_string_equal(text, "short\n"
                              "  count              3\n"
                              "long\n"
                              "  curvature_mean       0.2 1/\xc2\xb5m\n"
                              "  curvature_mean_error 0.05 1/\xc2\xb5m\n"
                              "  by                   summits\n"
                              "  nothing              -\n");
    free(text);
    characterisation_clear(&found);
}

static void fill_column(struct characterisation *found, const char *name, double value, int power) {
    double *values = characterisation_column_length(found, "scales", name, 2, power);
    assert_non_null(values);
    values[0] = values[1] = value;
}

static void columns_share_units(void **state) {
    (void)state;
    struct characterisation found = {.in_metres = true};
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
    characterisation_clear(&found);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_under_each_other),
        cmocka_unit_test(columns_share_units),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
