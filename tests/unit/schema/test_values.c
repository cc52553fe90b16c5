/* Protects: values of a case are read as they were given or as their defaults; what does not fit is
 * refused in the words of the one validator; and a reader that asks for what no table has fails. */
#include "schema/study/values.h"
#include "tests/support/check.h"
#include <stdlib.h>
#include <string.h>

enum colour { RED = 7, GREEN = 3, BLUE = 5 };
static const struct choice COLOURS[] = {{"red", RED}, {"green", GREEN}, {"blue", BLUE}, {0}};
static const struct choice DEPTHS[] = {{"none", 4}, {"infinite", 9}, {0}};
static const struct choice UNITS[] = {{"metres", 2}, {"feet", 6}, {0}};

static const struct parameter FIRST[] = {
    {.path = "/a/number",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 1,
     .above_minimum = true,
     .default_json = "0.25"},
    {.path = "/a/integer", .type = PARAMETER_INTEGER, .minimum = 1, .maximum = 9},
    {.path = "/a/choice",
     .type = PARAMETER_CHOICE,
     .choices = COLOURS,
     .default_json = "\"green\""},
};
static const struct parameter SECOND[] = {
    {.path = "/numbers",
     .type = PARAMETER_NUMBERS,
     .minimum = -1,
     .maximum = 10,
     .items_low = 2,
     .items_high = 3,
     .default_json = "[0, 0.5, 4]"},
    {.path = "/choices",
     .type = PARAMETER_CHOICES,
     .choices = COLOURS,
     .default_json = "\"green\""},
    {.path = "/flag", .type = PARAMETER_FLAG},
    {.path = "/measure",
     .type = PARAMETER_MEASURE,
     .choices = DEPTHS,
     .units = UNITS,
     .minimum = 0,
     .maximum = 10,
     .above_minimum = true},
};
static const struct parameter_table TABLE_A = {"a", FIRST, sizeof FIRST / sizeof *FIRST};
static const struct parameter_table TABLE_B = {"b", SECOND, sizeof SECOND / sizeof *SECOND};
static const struct parameter_table *const TABLES[] = {&TABLE_A, &TABLE_B, NULL};

/* The values of a text; parameters must outlive them. */
static struct values *values_of(const char *text, cJSON **parameters, struct fault_list *faults) {
    struct values *values = NULL;
    struct error err = {0};
    *parameters = cJSON_Parse(text);
    assert_non_null(*parameters);
    if (values_create(&values, *parameters, TABLES, faults, &err) != 0)
        fail_msg("%s: %s", text, err.text);
    return values;
}

static void given(void **state) {
    (void)state;
    cJSON *parameters;
    struct values *values =
        values_of("{\"a\": {\"number\": 1, \"integer\": 9, \"choice\": \"red\"},"
                  " \"numbers\": [-1, 0, 1], \"choices\": [\"blue\", \"red\"],"
                  " \"measure\": {\"feet\": 3}, \"flag\": true}",
                  &parameters, NULL);
    double *numbers;
    size_t n;
    int chosen[3], unit;
    assert_true(values_number(values, "/a/number") == 1 &&
                values_number(values, "/a/integer") == 9);
    assert_int_equal(values_choice(values, "/a/choice"), RED);
    assert_true(values_flag(values, "/flag"));
    assert_int_equal(values_numbers(values, "/numbers", &numbers, &n, NULL), 0);
    assert_true(n == 3 && numbers[0] == -1 && numbers[2] == 1);
    free(numbers);
    assert_int_equal(values_choices(values, "/choices", chosen), 2);
    assert_true(chosen[0] == BLUE && chosen[1] == RED);
    assert_true(values_measure(values, "/measure", &unit) == 3);
    assert_int_equal(unit, 6);
    assert_int_equal(values_status(values, NULL), 0);
    values_destroy(&values);
    assert_null(values);
    cJSON_Delete(parameters);
}

static void defaults(void **state) {
    (void)state;
    cJSON *parameters;
    struct values *values = values_of("{\"a\": {}, \"b\": 3}", &parameters, NULL);
    struct bins bins;
    int chosen[3], unit;
    assert_true(values_number(values, "/a/number") == 0.25);
    assert_true(isnan(values_number(values, "/a/integer")));
    assert_int_equal(values_choice(values, "/a/choice"), GREEN);
    assert_int_equal(values_choices(values, "/choices", chosen), 1);
    assert_int_equal(chosen[0], GREEN);
    assert_true(isnan(values_measure(values, "/measure", &unit)));
    values_bins(values, "/numbers", 4, &bins);
    assert_true(bins.low == 0 && bins.high == 0.5 && bins.count == 4);
    assert_null(values_json(values, 1));
    assert_true(values_json(values, 0)->valuedouble == 0.25);
    assert_null(values_json(values, 6));
    assert_int_equal(values_status(values, NULL), 0);
    values_bins(values, "/numbers", 3, &bins);
    struct error err = {0};
    assert_int_equal(values_status(values, &err), ERROR_INPUT);
    assert_string_equal(err.text, "/numbers: the count, 4, must be an integer in [1, 3]");
    values_destroy(&values);
    cJSON_Delete(parameters);
}

static void measures_without_number(void **state) {
    (void)state;
    cJSON *parameters;
    struct values *values =
        values_of("{\"measure\": \"infinite\", \"choices\": \"red\"}", &parameters, NULL);
    int chosen[3], unit;
    assert_true(values_measure(values, "/measure", &unit) == INFINITY);
    assert_int_equal(unit, 9);
    assert_int_equal(values_choices(values, "/choices", chosen), 1);
    assert_int_equal(chosen[0], RED);
    values_destroy(&values);
    cJSON_Delete(parameters);
}

/* All of them at once, behind what the list has already. */
static void faults_in_words(void **state) {
    (void)state;
    static const char *const WORDS[][2] = {
        {"/a/number", "0 is not in (0, 1]"},
        {"/a/integer", "2.5 is not an integer"},
        {"/a/choice", "1 is not one of \"red\", \"green\", \"blue\""},
        {"/numbers/1", "20 is not in [-1, 10]"},
        {"/choices/1", "\"red\" is there already"},
        {"/measure", "null is not one of \"none\", \"infinite\", nor an object of one number "
                     "named \"metres\", \"feet\""},
    };
    enum { FAULTS = sizeof WORDS / sizeof *WORDS };
    struct fault_list faults = {0};
    struct error err = {0};
    struct values *values = NULL;
    cJSON *parameters = cJSON_Parse(
        "{\"a\": {\"number\": 0, \"integer\": 2.5, \"choice\": 1}, \"numbers\": [0, 20],"
        " \"choices\": [\"red\", \"red\"], \"measure\": null}");
    fault_add(&faults, "", "of another");
    assert_int_equal(values_create(&values, parameters, TABLES, &faults, &err), ERROR_INPUT);
    assert_null(values);
    assert_string_equal(err.text, "/a/number: 0 is not in (0, 1]");
    assert_int_equal(faults.count, 1 + FAULTS);
    for (size_t f = 0; f < FAULTS; f++) {
        assert_string_equal(faults.faults[1 + f].pointer, WORDS[f][0]);
        assert_string_equal(faults.faults[1 + f].detail, WORDS[f][1]);
    }
    assert_int_equal(values_create(&values, parameters, TABLES, NULL, &err), ERROR_INPUT);
    fault_list_clear(&faults);
    cJSON_Delete(parameters);
}

/* Of paths and of types: nothing is read silently as absent. */
static void reading_what_no_table_has_fails(void **state) {
    (void)state;
    for (int way = 0; way < 6; way++) {
        cJSON *parameters;
        struct error err = {0};
        struct values *values = values_of("{}", &parameters, NULL);
        struct bins bins;
        int unit;
        if (way == 0)
            (void)values_number(values, "/a/numbr");
        if (way == 1)
            (void)values_number(values, "/a/choice");
        if (way == 2)
            (void)values_choice(values, "/choices");
        if (way == 3)
            (void)values_measure(values, "/a/number", &unit);
        if (way == 4)
            values_bins(values, "/a/integer", 5, &bins);
        if (way == 5)
            values_fault(values, "/a/numbr", "is wrong");
        assert_int_equal(values_status(values, &err), ERROR_STATE);
        assert_non_null(strstr(err.text, "no table has"));
        values_destroy(&values);
        cJSON_Delete(parameters);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(given),
        cmocka_unit_test(defaults),
        cmocka_unit_test(measures_without_number),
        cmocka_unit_test(faults_in_words),
        cmocka_unit_test(reading_what_no_table_has_fails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
