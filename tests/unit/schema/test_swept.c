/* Protects: the columns of what a study sweeps: each swept value is one, each member of a value
 * that is an object another, whichever cases have it, and titles that would be alike are longer. */
#include "schema/result/swept.h"
#include "tests/support/check.h"
#include "tests/support/result_builder.h"
#include <cjson/cJSON.h>

static struct study_result make(const char *swept, size_t cases) {
    struct study_result study = built_study("contact", "heights", cases);
    study.swept = cJSON_Parse(swept);
    return study;
}

static void check_columns(const struct study_result *study, const char *const *names) {
    size_t n = 0;
    for (; names[n] != NULL; n++)
        assert_string_equal(swept_name(study, n), names[n]);
    assert_int_equal(swept_count(study), n);
    assert_null(swept_pointer(study, n));
    assert_null(swept_name(study, n));
}

static void each_swept_value_is_a_column(void **state) {
    (void)state;
    struct study_result study = make("[\"/surface/hurst\",\"/counter/hurst\",\"/a/b\"]", 1);
    built_parameter(&study.cases[0], "/surface/hurst", NULL, 0.2);
    built_parameter(&study.cases[0], "/a/bc", NULL, 1); /* no member of b */
    check_columns(&study, (const char *[]){"surface/hurst", "counter/hurst", "b", NULL});
    study_result_clear(&study);
    study = make("null", 1);
    check_columns(&study, (const char *[]){NULL});
    study_result_clear(&study);
}

static void members_of_objects_are_columns(void **state) {
    (void)state;
    struct study_result study = make("[\"/surface/hurst\",\"/block/height\",\"/mu\"]", 3);
    static const char *const UNITS[] = {"/block/height/rms", "/block/height/lengths",
                                        "/block/height/rms"};
    for (size_t c = 0; c < 3; c++) {
        built_parameter(&study.cases[c], "/surface/hurst", NULL, 0.2);
        built_parameter(&study.cases[c], UNITS[c], NULL, (double)c);
        built_parameter(&study.cases[c], "/mu", NULL, (double)c);
    }
    check_columns(&study, (const char *[]){"hurst", "rms", "lengths", "mu", NULL});
    assert_string_equal(swept_pointer(&study, 2), "/block/height/lengths");
    study_result_clear(&study);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_swept_value_is_a_column),
        cmocka_unit_test(members_of_objects_are_columns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
