/* Values of a case by its table: defaults, faults in words, and a mark that tells cases apart. */
#include "jobs/case_reader.h"
#include "jobs/kind.h"
#include "jobs/value.h"
#include "schema/study/fault.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const struct parameter TABLE[] = {
    {.path = "/a/number",
     .type = PARAMETER_NUMBER,
     .minimum = 0,
     .maximum = 1,
     .above_minimum = true,
     .default_json = "0.25"},
    {.path = "/a/integer", .type = PARAMETER_INTEGER, .minimum = 1, .maximum = 9},
    {.path = "/a/choice",
     .type = PARAMETER_CHOICE,
     .choices = (const char *const[]){"first", "second", NULL},
     .default_json = "\"second\""},
    {.path = "/numbers",
     .type = PARAMETER_NUMBERS,
     .minimum = -1,
     .maximum = 1,
     .items_low = 2,
     .items_high = 3,
     .default_json = "[0, 0.5]"},
    {.path = "/choices",
     .type = PARAMETER_CHOICES,
     .choices = (const char *const[]){"first", "second", "third", NULL},
     .default_json = "\"second\""},
    {.path = "/measure",
     .type = PARAMETER_MEASURE,
     .choices = (const char *const[]){"none", "infinite", NULL},
     .units = (const char *const[]){"metres", "feet", NULL},
     .minimum = 0,
     .maximum = 10,
     .above_minimum = true},
};

static struct case_reader reader_of(const cJSON *parameters, struct fault_list *faults) {
    return (struct case_reader){parameters, TABLE, sizeof TABLE / sizeof *TABLE, faults};
}

static void given_and_default(void **state) {
    (void)state;
    struct fault_list faults = {0};
    cJSON *parameters =
        cJSON_Parse("{\"a\": {\"number\": 1, \"integer\": 9, \"choice\": \"first\"},"
                    " \"numbers\": [-1, 0, 1]}");
    struct case_reader reader = reader_of(parameters, &faults);
    double *numbers;
    size_t n;
    assert_true(case_number(&reader, "/a/number") == 1 && case_number(&reader, "/a/integer") == 9);
    assert_int_equal(case_choice(&reader, "/a/choice"), 0);
    assert_int_equal(case_numbers(&reader, "/numbers", &numbers, &n, NULL), 0);
    assert_true(n == 3 && numbers[0] == -1 && numbers[2] == 1);
    free(numbers);
    cJSON_Delete(parameters);
    parameters = cJSON_Parse("{\"a\": {\"number\": null}}");
    reader = reader_of(parameters, &faults);
    assert_true(case_number(&reader, "/a/number") == 0.25);
    assert_true(isnan(case_number(&reader, "/a/integer")));
    assert_int_equal(case_choice(&reader, "/a/choice"), 1);
    assert_int_equal(case_numbers(&reader, "/numbers", &numbers, &n, NULL), 0);
    assert_true(n == 2 && numbers[1] == 0.5);
    free(numbers);
    cJSON_Delete(parameters);
    assert_int_equal(faults.count, 0);
    assert_int_equal(case_status(&faults, 0, NULL), 0);
}

static void faults_in_words(void **state) {
    (void)state;
    struct fault_list faults = {0};
    struct error err = {0};
    cJSON *parameters = cJSON_Parse("{\"a\": {\"number\": 0, \"integer\": 2.5, \"choice\": 1},"
                                    " \"numbers\": [0, 2]}");
    struct case_reader reader = reader_of(parameters, &faults);
    double *numbers;
    size_t n;
    assert_true(isnan(case_number(&reader, "/a/number")));
    assert_true(isnan(case_number(&reader, "/a/integer")));
    assert_int_equal(case_choice(&reader, "/a/choice"), 0);
    assert_int_equal(case_numbers(&reader, "/numbers", &numbers, &n, NULL), 0);
    assert_null(numbers);
    static const char *const words[] = {"a number in (0, 1]", "an integer in [1, 9]", "\"first\"",
                                        "2 to 3 numbers in [-1, 1]"};
    assert_int_equal(faults.count, 4);
    for (int a = 0; a < 4; a++)
        assert_non_null(strstr(faults.faults[a].detail, words[a]));
    assert_int_equal(case_status(&faults, 0, &err), ERROR_INPUT);
    assert_string_equal(err.text, "/a/number: must be a number in (0, 1]");
    assert_int_equal(case_status(&faults, 4, &err), 0);
    fault_list_clear(&faults);
    cJSON_Delete(parameters);
}

static uint64_t mark_of(const char *text) {
    struct fault_list faults = {0};
    cJSON *parameters = cJSON_Parse(text);
    struct case_reader reader = reader_of(parameters, &faults);
    uint64_t mark = case_fingerprint(&reader);
    cJSON_Delete(parameters);
    return mark;
}

/* In the order given; one alone; the default; and what does not fit. */
static void choices_and_measures(void **state) {
    (void)state;
    static const struct {
        const char *text;
        size_t n, first;
        double measure;
        size_t unit, faults;
    } CASES[] = {
        {"{}", 1, 1, NAN, 0, 0},
        {"{\"choices\": [\"third\", \"first\"], \"measure\": {\"feet\": 3}}", 2, 2, 3, 1, 0},
        {"{\"choices\": \"first\", \"measure\": \"infinite\"}", 1, 0, INFINITY, 1, 0},
        {"{\"choices\": [\"first\", \"first\"], \"measure\": {\"miles\": 3}}", 0, 0, NAN, 0, 2},
        {"{\"choices\": [\"fourth\"], \"measure\": {\"feet\": 0}}", 0, 0, NAN, 0, 2},
        {"{\"choices\": [], \"measure\": {\"feet\": 1, \"metres\": 1}}", 0, 0, NAN, 0, 2},
        {"{\"choices\": 3, \"measure\": 3}", 0, 0, NAN, 0, 2},
        {"{\"choices\": [3], \"measure\": {}}", 0, 0, NAN, 0, 2},
    };
    for (size_t a = 0; a < sizeof CASES / sizeof *CASES; a++) {
        struct fault_list faults = {0};
        cJSON *parameters = cJSON_Parse(CASES[a].text);
        struct case_reader reader = reader_of(parameters, &faults);
        size_t chosen[3] = {0}, unit;
        assert_int_equal(case_choices(&reader, "/choices", chosen), CASES[a].n);
        assert_true(CASES[a].n == 0 || chosen[0] == CASES[a].first);
        double measure = case_measure(&reader, "/measure", &unit);
        assert_true(measure == CASES[a].measure || (isnan(measure) && isnan(CASES[a].measure)));
        assert_int_equal(unit, CASES[a].unit);
        assert_int_equal(faults.count, CASES[a].faults);
        fault_list_clear(&faults);
        cJSON_Delete(parameters);
    }
}

/* The same whatever the order of keys and whether a default is written out; else another. */
static void fingerprints(void **state) {
    (void)state;
    uint64_t mark = mark_of("{\"a\": {\"number\": 0.25, \"integer\": 3}}");
    assert_true(mark == mark_of("{\"a\": {\"integer\": 3}, \"numbers\": [0, 0.5]}"));
    assert_true(mark != mark_of("{\"a\": {\"integer\": 4}}"));
    assert_true(mark != mark_of("{\"a\": {\"integer\": 3, \"number\": 3}}"));
    assert_true(mark != mark_of("{\"a\": {\"integer\": 3}, \"numbers\": [0, 0.5, 0]}"));
    assert_true(mark != mark_of("{\"a\": {\"integer\": 3, \"choice\": \"first\"}}"));
    assert_true(mark == mark_of("{\"a\": {\"integer\": 3}, \"choices\": \"second\"}"));
    assert_true(mark != mark_of("{\"a\": {\"integer\": 3}, \"choices\": [\"first\"]}"));
    assert_true(mark_of("{\"measure\": {\"feet\": 1}}") !=
                mark_of("{\"measure\": {\"metres\": 1}}"));
    assert_true(mark_of("{\"measure\": {\"feet\": 1}}") != mark_of("{\"measure\": {\"feet\": 2}}"));
}

static void values(void **state) {
    (void)state;
    cJSON *object = cJSON_Parse("{\"a\": {\"bc\": 1, \"b\": {\"c\": 2}}, \"A\": 3}");
    assert_true(value_at(object, "/a/b/c")->valuedouble == 2);
    assert_true(value_at(object, "/a/bc")->valuedouble == 1);
    assert_true(value_at(object, "/A")->valuedouble == 3);
    assert_ptr_equal(value_at(object, ""), object);
    assert_null(value_at(object, "/a/bcd"));
    assert_null(value_at(object, "/a/bc/d"));
    cJSON_Delete(object);
    const double numbers[] = {1, NAN, INFINITY, -2};
    cJSON *matrix = value_matrix(2, 2, numbers);
    char *text = cJSON_PrintUnformatted(matrix);
    assert_string_equal(text, "[[1,null],[null,-2]]");
    free(text);
    cJSON_Delete(matrix);
    assert_false(value_put(NULL, "x", cJSON_CreateNull()));
}

static void kinds(void **state) {
    (void)state;
    assert_non_null(kind_find("statistics"));
    assert_non_null(kind_find("contact"));
    assert_null(kind_find("statistic"));
    for (size_t a = 0; a < JOB_KIND_COUNT; a++) {
        assert_ptr_equal(kind_find(JOB_KINDS[a]->name), JOB_KINDS[a]);
        for (size_t b = 0; b < JOB_KINDS[a]->parameter_count; b++) {
            const struct parameter *row = &JOB_KINDS[a]->parameters[b];
            assert_true(row->path[0] == '/' && strlen(row->help) > 0);
            bool named = row->type == PARAMETER_CHOICE || row->type == PARAMETER_CHOICES ||
                         row->type == PARAMETER_MEASURE;
            assert_true(named == (row->choices != NULL));
            assert_true((row->type == PARAMETER_MEASURE) == (row->units != NULL));
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(given_and_default),
        cmocka_unit_test(faults_in_words),
        cmocka_unit_test(choices_and_measures),
        cmocka_unit_test(fingerprints),
        cmocka_unit_test(values),
        cmocka_unit_test(kinds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
