/* One case less another: what is compared with what, errors of either case put together, pairs
 * where they are known; and a difference comes back from JSON as it went in. */
#include "schema/result/csv.h"
#include "schema/result/difference.h"
#include "schema/result/result_json.h"
#include "tests/support/check.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double X[] = {1, 2, 3}, LATER[] = {2, 3, 4}, FAR[] = {7, 8, 9};
static const double UP[] = {10, 20, 30}, THREE[] = {3, 3, 3}, FOUR[] = {4, 4, 4};
static const double BOUND[] = {0.5, 0.25, 0.125}, VALUE[] = {1, -2, 4};

static struct curve curve_of(const char *quantity, const char *model, double level, const double *x,
                             const double *y, const double *standard_error) {
    struct curve curve = curve_named(quantity, "load", "A/A0");
    curve.model = model;
    curve.level = level;
    curve_set_points(&curve, 3, x, y, standard_error);
    curve.errors[ERROR_SOLVER] = (struct curve_error){
        .applies = true, .value = VALUE, .bound = BOUND, .standard_error = FOUR, .order = NAN};
    return curve;
}

static void add(struct case_result *result, struct curve curve) {
    struct error err = {0};
    assert_int_equal(result_add_curve(result, &curve, &err), 0);
}

static void add_scalar(struct case_result *result, const char *name, double value, double error) {
    struct error err = {0};
    const struct scalar scalar = scalar_named(name, value, error, NAN);
    assert_int_equal(result_add_scalar(result, &scalar, &err), 0);
}

static struct case_result subtract(const struct case_result *a, const struct case_result *b,
                                   const struct difference_pairs *pairs) {
    struct error err = {0};
    struct case_result out = {0};
    if (difference_make(a, b, pairs, &out, &err) != 0)
        fail_msg("%s", err.text);
    return out;
}

/* At 2 and 3 alone, on the finest levels; standard errors 3 and 4 make 5. */
static void errors_are_put_together(void **state) {
    (void)state;
    struct case_result a = {.case_number = 1}, b = {0};
    add(&a, curve_of("area", "full", 4, X, UP, THREE));
    add(&a, curve_of("area", "full", 8, X, UP, THREE));
    add(&b, curve_of("area", "full", 8, LATER, VALUE, FOUR));
    a.curves[1].errors[ERROR_BLOCK].applies = true; /* not known */
    a.curves[1].errors[ERROR_MODEL] = a.curves[1].errors[ERROR_SOLVER];
    struct case_result out = subtract(&a, &b, NULL);
    assert_true(out.difference && out.case_number == 1 && out.less == 0);
    assert_int_equal(out.curve_count, 1);
    const struct curve *curve = &out.curves[0];
    assert_int_equal(curve->n, 2);
    check_close(curve->level, 8, 0);
    check_close(curve->x[0], 2, 0);
    check_close(curve->y[0], 20 - 1, 0);
    check_close(curve->y[1], 30 + 2, 0);
    check_close(curve->minuend[1], 30, 0);
    check_close(curve->subtrahend[1], -2, 0);
    assert_false(curve->paired);
    check_close(curve->standard_error[0], 5, 1e-15);
    check_close(curve->errors[ERROR_SOLVER].value[0], -2 - 1, 0);
    check_close(curve->errors[ERROR_SOLVER].bound[0], 0.25 + 0.5, 0);
    check_close(curve->errors[ERROR_SOLVER].standard_error[0], sqrt(32), 1e-15);
    check_close(curve->errors[ERROR_MODEL].value[1], 4, 0); /* the second case has none */
    assert_true(curve->errors[ERROR_BLOCK].applies && curve->errors[ERROR_BLOCK].value == NULL);
    assert_false(curve->errors[ERROR_CELL].applies);
    assert_string_equal(out.remark, "area has 2 points in common of 3 and 3");
    result_clear(&out);
    result_clear(&a);
    result_clear(&b);
}

static bool point(void *context, const struct curve *minuend, size_t a,
                  const struct curve *subtrahend, size_t b, struct paired_value *out) {
    *out = (struct paired_value){.value = *(const double *)context,
                                 .standard_error = 0.5,
                                 .deviation = 1,
                                 .pairs = 4 - (a == 2),
                                 .lacking = a == 2};
    return strcmp(minuend->quantity, "area") == 0 && subtrahend->x[b] > 0;
}

static bool scalar(void *context, const char *name, struct paired_value *out) {
    *out = (struct paired_value){.value = *(const double *)context, .standard_error = 0.5};
    return strcmp(name, "kappa") == 0;
}

/* A realisation of four lacks a value at the last point: a quarter of two deviations. */
static void pairs_are_taken(void **state) {
    (void)state;
    double value = 7;
    const struct difference_pairs pairs = {&value, point, scalar};
    struct case_result a = {0}, b = {.case_number = 1};
    add(&a, curve_of("area", "full", 8, X, UP, THREE));
    add(&a, curve_of("count", "full", 8, X, UP, THREE));
    add(&b, curve_of("area", "full", 8, X, VALUE, FOUR));
    add(&b, curve_of("count", "full", 8, X, VALUE, FOUR));
    add_scalar(&a, "kappa", 2, 3);
    add_scalar(&b, "kappa", 1, 4);
    add_scalar(&a, "loads", 5, 0);
    add_scalar(&b, "loads", 3, 0);
    add_scalar(&a, "alone", 5, 0);
    struct case_result out = subtract(&a, &b, &pairs);
    const struct curve *area = &out.curves[0];
    assert_true(area->paired && !out.curves[1].paired);
    check_close(area->y[1], 7, 0);
    check_close(area->standard_error[1], 0.5, 0);
    assert_true(area->errors[ERROR_MISSING].applies);
    check_close(area->errors[ERROR_MISSING].bound[1], 0, 0);
    check_close(area->errors[ERROR_MISSING].bound[2], 0.5, 1e-15);
    check_close(area->valueless[2], 1, 0);
    check_close(out.curves[1].standard_error[0], 5, 1e-15);
    assert_int_equal(out.scalar_count, 2);
    check_close(out.scalars[0].value, 7, 0);
    check_close(out.scalars[0].minuend, 2, 0);
    assert_true(out.scalars[0].paired && out.scalars[1].paired);
    check_close(out.scalars[1].value, 2, 0);
    result_clear(&out);
    result_clear(&a);
    result_clear(&b);
}

/* Bounds are three changes between levels: 3 x 2 and 3 x 1.5 at the first point, where the two
 * changes differ by 0.5, and by 1 at the next one. */
static void meshes_go_together(void **state) {
    (void)state;
    static const double FINE[] = {10, 20, 30}, COARSE[] = {8, 17, 26};
    static const double OTHER_FINE[] = {5, 6, 7}, OTHER_COARSE[] = {3.5, 4, 3};
    static const double ZERO[] = {0, 0, 0}, MESH[] = {6, 9, 12}, OTHER_MESH[] = {4.5, 6, 12};
    static const double EXPECTED[] = {3 * 1, 3 * 1, 3 * 1};
    double value = 7;
    const struct difference_pairs pairs = {&value, point, scalar};
    struct case_result a = {0}, b = {.case_number = 1};
    add(&a, curve_of("area", "full", 8, X, FINE, THREE));
    add(&a, curve_of("area", "full", 4, X, COARSE, THREE));
    add(&b, curve_of("area", "full", 8, X, OTHER_FINE, FOUR));
    add(&b, curve_of("area", "full", 4, X, OTHER_COARSE, FOUR));
    a.curves[0].errors[ERROR_DISCRETISATION] = (struct curve_error){
        .applies = true, .value = ZERO, .bound = MESH, .standard_error = ZERO, .order = NAN};
    b.curves[0].errors[ERROR_DISCRETISATION] = (struct curve_error){
        .applies = true, .value = ZERO, .bound = OTHER_MESH, .standard_error = ZERO, .order = NAN};
    for (int trial = 0; trial < 3; trial++) { /* by pairs; not by pairs; with a signed error */
        if (trial == 2)
            a.curves[0].errors[ERROR_DISCRETISATION].value = VALUE;
        struct case_result out = subtract(&a, &b, trial == 1 ? NULL : &pairs);
        assert_int_equal(out.curve_count, 1);
        for (size_t k = 0; k < 3; k++)
            check_close(out.curves[0].errors[ERROR_DISCRETISATION].bound[k],
                        trial == 0 ? EXPECTED[k] : MESH[k] + OTHER_MESH[k], 1e-14);
        result_clear(&out);
    }
    result_clear(&a);
    result_clear(&b);
}

/* Cases of one model each are compared whatever these are; with several, each with its own. */
static void models_find_their_partners(void **state) {
    (void)state;
    struct case_result a = {0}, b = {.case_number = 1};
    add(&a, curve_of("area", "full", 8, X, UP, THREE));
    add(&b, curve_of("area", "layered", 16, X, VALUE, FOUR));
    struct case_result out = subtract(&a, &b, NULL);
    assert_int_equal(out.curve_count, 1);
    assert_string_equal(out.curves[0].model, "full less layered");
    assert_true(isnan(out.curves[0].level));
    assert_null(out.remark);
    result_clear(&out);
    add(&b, curve_of("area", "full", 16, X, UP, FOUR));
    add(&b, curve_of("area", "halfspace", 16, FAR, UP, FOUR));
    out = subtract(&a, &b, NULL);
    assert_int_equal(out.curve_count, 1);
    assert_string_equal(out.curves[0].model, "full");
    check_close(out.curves[0].y[0], 0, 0);
    assert_string_equal(out.remark, "area by layered is of the second case alone; area by "
                                    "halfspace is of the second case alone");
    result_clear(&out);
    add(&a, curve_of("area", "halfspace", 8, X, UP, THREE));
    add(&a, curve_of("area", "springs", 8, X, UP, THREE));
    out = subtract(&a, &b, NULL);
    assert_int_equal(out.curve_count, 1);
    assert_string_equal(out.remark, "area has no load in common; area by springs is of the first "
                                    "case alone; area by layered is of the second case alone");
    result_clear(&out);
    result_clear(&a);
    result_clear(&b);
}

static void parameters_tell_what_differs(void **state) {
    (void)state;
    struct result_parameter one[] = {{.pointer = "/hurst", .number = 0.8},
                                     {.pointer = "/type", .text = "a", .number = NAN},
                                     {.pointer = "/own", .number = 2}};
    struct result_parameter other[] = {{.pointer = "/type", .text = "a", .number = NAN},
                                       {.pointer = "/hurst", .number = 0.25}};
    struct case_result a = {.parameter_count = 3, .parameters = one};
    struct case_result b = {.parameter_count = 2, .parameters = other};
    struct case_result out = subtract(&a, &b, NULL);
    assert_int_equal(out.parameter_count, 3);
    assert_string_equal(out.parameters[0].text, "0.8 less 0.25");
    assert_string_equal(out.parameters[1].text, "a");
    assert_string_equal(out.parameters[2].text, "2 less -");
    result_clear(&out);
}

static char *print(const struct case_result *result, bool csv) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    struct case_result one = *result;
    const struct study_result study = {.case_count = 1, .cases = &one};
    assert_true(csv ? csv_print(file, &study) : result_print(file, result));
    assert_int_equal(fclose(file), 0);
    return text;
}

static void formats_hold_it(void **state) {
    (void)state;
    double value = 7;
    struct error err = {0};
    const struct difference_pairs pairs = {&value, point, scalar};
    struct case_result a = {.case_number = 4}, b = {.case_number = 2}, back = {0};
    add(&a, curve_of("area", "full", 8, X, UP, THREE));
    add(&b, curve_of("area", "full", 8, LATER, VALUE, FOUR));
    add_scalar(&a, "kappa", 2, 3);
    add_scalar(&b, "kappa", 1, 4);
    struct case_result out = subtract(&a, &b, &pairs);
    char *text = print(&out, false), *table = print(&out, true);
    assert_non_null(strstr(text, "{\"case\":4,\"less\":2,\"remark\":\"area has 2 points"));
    assert_non_null(strstr(text, "\"minuend\":[20,30],\"subtrahend\":[1,-2],\"paired\":true"));
    assert_non_null(strstr(text, "\"minuend\":2,\"subtrahend\":1,\"paired\":true"));
    cJSON *document = cJSON_Parse(text);
    assert_int_equal(result_read(document, &back, &err), 0);
    char *again = print(&back, false);
    assert_string_equal(text, again);
    assert_non_null(strstr(table, ",law_standard_error,less,minuend,subtrahend,paired,total_low,"));
    assert_non_null(strstr(table, ",0,,,2,20,1,true,6.02,11.73,\n"));
    cJSON_Delete(document);
    free(text);
    free(table);
    free(again);
    result_clear(&back);
    result_clear(&out);
    result_clear(&a);
    result_clear(&b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_put_together),
        cmocka_unit_test(pairs_are_taken),
        cmocka_unit_test(meshes_go_together),
        cmocka_unit_test(models_find_their_partners),
        cmocka_unit_test(parameters_tell_what_differs),
        cmocka_unit_test(formats_hold_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
