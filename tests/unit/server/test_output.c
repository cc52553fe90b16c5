/* Protects: the folder of a run has every curve under a name of its own, a picture a quantity and
 * unit, and a document that reads back to the same results. */
#include "schema/json/json.h"
#include "schema/result/result_json.h"
#include "server/show/output.h"
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/result_builder.h"
#include <stdio.h>
#include <unistd.h>

static const double X[] = {0.1, 0.2}, Y[] = {0.25, 0.5}, ERROR[] = {0.01, NAN};

static void add_curve(struct case_result *one, const char *quantity, const char *series,
                      const char *y_label, double level) {
    struct curve curve = built_points(one, quantity, 2, X, Y, ERROR);
    curve.series = series;
    curve.y_label = y_label;
    curve.model = isnan(level) ? NULL : "full";
    curve.kinematics = isnan(level) ? NULL : "small";
    curve.level = level;
    curve.points = 64;
    curve.pressure = isnan(level) ? 0.25 : (double)NAN;
    built_theory(one, &curve, "line", Y);
    built_curve(one, &curve);
}

/* The first case has not begun. */
static struct study_result study_of_two(void) {
    struct study_result study = built_study("contact", "two", 2);
    struct case_result *one = &study.cases[1];
    study.cases[0].realisations = 0;
    add_curve(one, "contact_area", "edges", "A/A0", 8);
    add_curve(one, "contact_area", "edges", "A/A0", 4);
    add_curve(one, "patch_count", "cell", "in the cell", 8);
    add_curve(one, "patch_count", "wave", "per wave", 8);
    add_curve(one, "contact_pressure_pdf", "", "density", NAN);
    return study;
}

static void check_text(const char *file, const char *expected) {
    char *text = slurp(file);
    assert_string_equal(text, expected);
    free(text);
}

static void every_curve_has_its_lines(void **state) {
    (void)state;
    static const char *const FILES[] = {
        "out/curves.csv",
        "out/contact_area.svg",
        "out/contact_area-light.svg", /* the view of the kind asks for it */
        "out/patch_count.svg",
        "out/patch_count-wave.svg",
        "out/contact_pressure_pdf.svg",
        "out/curves.json"};
    struct study_result study = study_of_two();
    struct error err = {0};
    assert_int_equal(output_write(&study, "out", &err), 0);
    assert_int_equal(output_write(&study, "out", &err), 0); /* replaces what was there */
    check_text(
        FILES[0],
        "case,quantity,series,model,kinematics,level,pressure,x,x2,y,"
        "standard_error,discretisation_error,discretisation_bound,cell_error,"
        "cell_bound,block_error,block_bound,model_error,model_bound,"
        "solver_error,solver_bound,"
        "missing_error,missing_bound,patch_error,patch_bound,valueless,law_difference,law_standard_"
        "error,"
        "theory_line,total_low,total_high,unknown_errors\n"
        "1,contact_area,edges,full,small,8,,0.1,,0.25,0.01,,,,,,,,,,,,,,,,,,0.25,0.2304,0.2696,\n"
        "1,contact_area,edges,full,small,8,,0.2,,0.5,,,,,,,,,,,,,,,,,,,0.5,,,\n"
        "1,contact_area,edges,full,small,4,,0.1,,0.25,0.01,,,,,,,,,,,,,,,,,,0.25,0.2304,0.2696,\n"
        "1,contact_area,edges,full,small,4,,0.2,,0.5,,,,,,,,,,,,,,,,,,,0.5,,,\n"
        "1,patch_count,cell,full,small,8,,0.1,,0.25,0.01,,,,,,,,,,,,,,,,,,0.25,0.2304,0.2696,\n"
        "1,patch_count,cell,full,small,8,,0.2,,0.5,,,,,,,,,,,,,,,,,,,0.5,,,\n"
        "1,patch_count,wave,full,small,8,,0.1,,0.25,0.01,,,,,,,,,,,,,,,,,,0.25,0.2304,0.2696,\n"
        "1,patch_count,wave,full,small,8,,0.2,,0.5,,,,,,,,,,,,,,,,,,,0.5,,,\n"
        "1,contact_pressure_pdf,,,,,0.25,0.1,,0.25,0.01,,,,,,,,,,,,,,,,,,0.25,0.2304,0.2696,\n"
        "1,contact_pressure_pdf,,,,,0.25,0.2,,0.5,,,,,,,,,,,,,,,,,,,0.5,,,\n");
    char *text = slurp("out/curves.json");
    struct study_result read = {0};
    cJSON *document = NULL;
    assert_int_equal(json_parse(text, strlen(text) - 1, NULL, &document, &err), 0);
    assert_int_equal(study_result_read(document, &read, &err), 0);
    assert_int_equal(read.cases[1].curve_count, 5);
    assert_true(curve_same_series(&read.cases[1].curves[4], &study.cases[1].curves[4]));
    for (size_t n = 0; n < sizeof FILES / sizeof *FILES; n++)
        if (remove(FILES[n]) != 0)
            fail_msg("%s is not there", FILES[n]);
    assert_int_equal(rmdir("out"), 0); /* nothing else was in it */
    cJSON_Delete(document);
    free(text);
    study_result_clear(&read);
    study_result_clear(&study);
}

/* A quantity without a value has curves, and no picture, also where an earlier run drew one; that
 * is no failure. */
static void quantities_without_values_have_no_picture(void **state) {
    (void)state;
    static const double NONE[] = {NAN, NAN};
    struct study_result study = study_of_two();
    struct case_result *one = &study.cases[1];
    struct error err = {0};
    one->curve_count = 1;
    one->curves[0].theory_count = 0;
    char picture[100];
    snprintf(picture, sizeof picture, "out/%s.svg", one->curves[0].quantity);
    if (output_write(&study, "out", &err) != 0)
        fail_msg("%s", err.text);
    assert_int_equal(access(picture, F_OK), 0);
    one->curves[0].y = built_numbers(one, 2, NONE);
    if (output_write(&study, "out", &err) != 0)
        fail_msg("%s", err.text);
    assert_int_equal(remove("out/curves.csv"), 0);
    assert_int_equal(remove("out/curves.json"), 0);
    assert_int_equal(rmdir("out"), 0); /* nothing else was in it */
    study_result_clear(&study);
}

static void a_folder_that_cannot_be_is_told(void **state) {
    (void)state;
    struct study_result study = study_of_two();
    struct error err = {0};
    assert_int_not_equal(output_write(&study, "no/such/folder", &err), 0);
    assert_string_equal(err.text, "cannot make folder no/such/folder: No such file or directory");
    study_result_clear(&study);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_curve_has_its_lines),
        cmocka_unit_test(quantities_without_values_have_no_picture),
        cmocka_unit_test(a_folder_that_cannot_be_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
