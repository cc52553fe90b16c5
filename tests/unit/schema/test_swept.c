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
    struct swept swept;
    size_t n = 0;
    swept_find(study, &swept);
    for (; names[n] != NULL; n++) {
        assert_true(n < swept.count);
        assert_string_equal(swept.columns[n].name, names[n]);
    }
    assert_int_equal(swept.count, n);
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
    struct swept swept;
    swept_find(&study, &swept);
    assert_string_equal(swept.columns[2].pointer, "/block/height/lengths");
    study_result_clear(&study);
}

/* A height that is infinite, or so many lengths: a column of the word, and one of the number. */
static void words_and_objects_are_columns(void **state) {
    (void)state;
    for (size_t first = 0; first < 2; first++) {
        struct study_result study = make("[\"/block/height\"]", 2);
        built_parameter(&study.cases[first], "/block/height", "infinite", NAN);
        built_parameter(&study.cases[1 - first], "/block/height/lengths", NULL, 2);
        check_columns(&study, (const char *[]){"height", "lengths", NULL});
        study_result_clear(&study);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_swept_value_is_a_column),
        cmocka_unit_test(members_of_objects_are_columns),
        cmocka_unit_test(words_and_objects_are_columns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
