/* Protects: the table of cases: which rows and columns a request stands for, that every number
 * stands in its row and column in each format, and the message on a name or point that there is
 * not. */
#include "server/show/table/case_rows.h"
#include "server/show/table/case_table.h"
#include "tests/support/check.h"
#include "tests/support/result_builder.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CASES = 4, LOADS = 3 };
static const double HURST[CASES] = {0.2, 0.2, 0.8, 0.8}, X[LOADS] = {0.03, 0.06, 0.1};

/* A value that encodes its case, model, level and point. */
static double value_of(size_t c, const char *model, double level, size_t k) {
    return 1 + (double)c + (strcmp(model, "layered") == 0 ? 0.5 : 0) + level / 100 +
           (double)k / 1000;
}

static void add_area(struct case_result *one, const char *series, const char *model, double level) {
    double y[LOADS], error[LOADS] = {0.25, 0.25, 0.25}, half[LOADS] = {-0.5, -0.5, -0.5};
    for (size_t k = 0; k < LOADS; k++)
        y[k] = value_of((size_t)one->case_number, model, level, k) *
               (strcmp(series, "nodes") == 0 ? -1 : 1);
    struct curve curve = built_points(one, "area", LOADS, X, y, error);
    curve.series = series;
    curve.model = model;
    curve.level = level;
    curve.errors[ERROR_DISCRETISATION] = (struct curve_error){true,
                                                              built_numbers(one, LOADS, half),
                                                              built_numbers(one, LOADS, error),
                                                              built_numbers(one, LOADS, error),
                                                              NAN,
                                                              false};
    curve.errors[ERROR_CELL].applies = true;
    built_theory(one, &curve, "persson", error);
    built_curve(one, &curve);
}

static bool in_units; /* kappa has a unit, by another scale in each case */

/* Two Hurst exponents of two shapes; the last case has not begun. */
static struct study_result study_made(void) {
    struct study_result study = built_study("contact", "four", CASES);
    study.swept = cJSON_Parse("[\"/surface/hurst\",\"/heights/shape\"]");
    study.provenance = cJSON_Parse("{\"seed\":\"5\"}");
    for (size_t c = 0; c < CASES; c++) {
        struct case_result *one = &study.cases[c];
        built_parameter(one, "/surface/hurst", NULL, HURST[c]);
        built_parameter(one, "/heights/shape", c % 2 == 0 ? "a" : "b,c", NAN);
        built_parameter(one, "/young", NULL, 1);
        if (c == CASES - 1) {
            one->realisations = 0;
            continue;
        }
        built_scalar(one, "kappa", 2 + (double)c, 0.125, c == 0 ? 1.5 : (double)NAN);
        if (in_units)
            one->scalars[0].unit = (struct physical_unit){"m", "kappa", 1e-6 * (double)(c + 1)};
        add_area(one, "edges", "halfspace", 16);
        add_area(one, "edges", "halfspace", 8);
        add_area(one, "nodes", "halfspace", 16);
        add_area(one, "edges", "layered", 8);
        add_area(one, "edges", "layered", 16);
    }
    return study;
}

static int results(const void *context, const struct result_filter *filter,
                   struct study_result *out, struct error *err) {
    (void)context;
    *out = study_made();
    for (size_t c = 0; c < CASES; c++)
        result_keep(&out->cases[c], filter->part.quantity, filter->part.scalars_only);
    if (filter->part.quantity == NULL ||
        result_curve(&out->cases[0], filter->part.quantity) != NULL)
        return 0;
    return error_set(err, ERROR_INPUT, "no quantity '%s'", filter->part.quantity);
}

static const struct picture_source SOURCE = {NULL, results, NULL};

static struct case_table made(const char *columns, const char *where) {
    const char *const list[] = {where, NULL};
    const struct table_request request = {columns, list};
    struct case_table table;
    struct error err = {0};
    if (case_table_make(&table, &SOURCE, &request, &err) != 0)
        fail_msg("%s: %s", columns, err.text);
    return table;
}

static void check_format(const struct case_table *table, int format, const char *expected) {
    char *text = NULL;
    size_t size = 0;
    struct error err = {0};
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    assert_int_equal(case_table_print(table, format, file, &err), 0);
    assert_int_equal(fclose(file), 0);
    if (strstr(text, expected) == NULL)
        fail_msg("%s\nhas not\n%s", text, expected);
    free(text);
}

static void names_choose_columns(void **state) {
    (void)state;
    static const struct {
        const char *columns;
        const char *names[3];
        double first[2]; /* row 0, without what is swept */
    } CHOICES[] = {
        {"kappa", {"kappa"}, {2}},
        {"area@0.06", {"area:halfspace@0.06", "area:layered@0.06"}, {1.161, 1.661}},
        {"area:layered@0.1,kappa", {"area:layered@0.1", "kappa"}, {1.662, 2}},
        {"area:8@0.030000000001", {"area:halfspace:8@0.03", "area:layered:8@0.03"}, {1.08, 1.58}},
        {"area:nodes@0.1", {"area:nodes@0.1"}, {-1.162}},
        {"area:16:edges:layered@1e-1", {"area:16:edges:layered@0.1"}, {1.662}},
    };
    for (size_t n = 0; n < sizeof CHOICES / sizeof *CHOICES; n++) {
        struct case_table table = made(CHOICES[n].columns, NULL);
        assert_int_equal(table.row_count, CASES);
        assert_string_equal(table.columns[0].name, "hurst");
        assert_string_equal(table.columns[1].name, "shape");
        size_t count = 0;
        for (; CHOICES[n].names[count] != NULL && count < 2; count++) {
            const struct table_column *column = &table.columns[2 + count];
            assert_string_equal(column->name, CHOICES[n].names[count]);
            check_close(column->values[0].value, CHOICES[n].first[count], 1e-12);
            assert_true(isnan(column->values[CASES - 1].value)); /* not begun */
        }
        assert_int_equal(table.column_count, 2 + count);
        case_table_clear(&table);
    }
}

static void errors_stand_beside_values(void **state) {
    (void)state;
    struct case_table table = made("area:layered@0.06", NULL);
    const struct table_column *column = &table.columns[2];
    check_close(column->values[1].standard_error, 0.25, 0);
    check_close(column->values[1].error, 0.75, 0); /* |value| + bound */
    check_close(column->values[1].theory, 0.25, 0);
    assert_string_equal(column->theory, "persson");
    assert_true(column->unknown[ERROR_CELL] && !column->unknown[ERROR_DISCRETISATION]);
    assert_string_equal(column->unit, "y");
    case_table_clear(&table);
}

static void conditions_choose_rows(void **state) {
    (void)state;
    static const struct {
        const char *where;
        size_t count, first;
    } CHOICES[] = {{"hurst=0.8", 2, 2},
                   {"surface/hurst=0.2,shape=a", 1, 0},
                   {"/surface/hurst=0.80000000001,shape=a", 1, 2},
                   {"hurst=0.2,hurst=0.8,young=1", 4, 0}};
    for (size_t n = 0; n < sizeof CHOICES / sizeof *CHOICES; n++) {
        struct case_table table = made("kappa", CHOICES[n].where);
        assert_int_equal(table.row_count, CHOICES[n].count);
        assert_int_equal(table.rows[0]->case_number, CHOICES[n].first);
        case_table_clear(&table);
    }
}

static void what_there_is_not_is_told(void **state) {
    (void)state;
    static const struct {
        const char *columns, *where, *text;
    } FAULTS[] = {
        {"kapa", NULL,
         "columns: no case has a scalar \"kapa\" (did you mean kappa?); a value of a curve is "
         "named as "
         "QUANTITY@X, "
         "scalars are: kappa"},
        {"area@0.07", NULL, "columns: area has no value at 0.07; it is known at 0.03, 0.06, 0.1"},
        {"gap@0.1", NULL, "no quantity 'gap'"},
        {"area:full@0.1", NULL, "its words are halfspace, edges, 16, 8, nodes, layered"},
        {"area@x", NULL, "\"x\" is no number"},
        {"area@0.1.foo", NULL,
         "\"0.1.foo\" is no number behind @; allowed behind one: .theory, .grid, .law, "},
        {"area:edges", NULL, "neither a scalar nor QUANTITY@X"},
        {"kappa,", NULL, "is no name"},
        {NULL, "hurst", "\"hurst\" is not NAME=VALUE"},
        {NULL, "H=1", "\"H\" is no parameter of the study's cases (did you mean hurst?)"},
        {NULL, "hurst=", "/surface/hurst has no value behind the =; there is 0.2, 0.8"},
        {NULL, "hurst=0.5", "no case has /surface/hurst = 0.5; there is 0.2, 0.8"},
        {NULL, "hurst=0.5x", "no case has /surface/hurst = 0.5x"},
    };
    for (size_t n = 0; n < sizeof FAULTS / sizeof *FAULTS; n++) {
        const char *const where[] = {FAULTS[n].where, NULL};
        const struct table_request request = {FAULTS[n].columns, where};
        struct case_table table;
        struct error err = {0};
        assert_int_equal(case_table_make(&table, &SOURCE, &request, &err), ERROR_INPUT);
        if (strstr(err.text, FAULTS[n].text) == NULL)
            fail_msg("%s, without %s", err.text, FAULTS[n].text);
    }
}

static void each_format_has_every_number(void **state) {
    (void)state;
    struct case_table table = made("kappa,area:layered@0.1", "shape=a");
    check_format(
        &table, TABLE_CSV,
        "# study: four, contact 0123456789abcdef, done, seed 5\n# queued:\n"
        "case,realisations,hurst,shape,kappa,kappa_standard_error,kappa_error,kappa_theory,"
        "kappa_total_low,kappa_total_high,"
        "area:layered@0.1,area:layered@0.1_standard_error,area:layered@0.1_error,"
        "area:layered@0.1_theory,area:layered@0.1_total_low,area:layered@0.1_total_high\n"
        "0,4,0.2,\"a\",2,0.125,,1.5,1.755,2.245,1.662,0.25,0.75,0.25,1.172,2.902\n"
        "2,4,0.8,\"a\",4,0.125,,,3.755,4.245,3.662,0.25,0.75,0.25,3.1719999999999997,4.902\n");
    check_format(&table, TABLE_JSON,
                 "\"columns\":[{\"name\":\"hurst\",\"type\":\"parameter\",\"pointer\":"
                 "\"/surface/hurst\",\"unit\":null},");
    check_format(&table, TABLE_JSON,
                 "\"rows\":[{\"case\":0,\"realisations\":4,\"values\":[0.2,\"a\",2,1.662],"
                 "\"standard_errors\":[null,null,0.125,0.25],\"errors\":[null,null,null,0.75],"
                 "\"theory\":[null,null,1.5,0.25],\"total_low\":[null,null,1.755,1.172],"
                 "\"total_high\":[null,null,2.245,2.902]},{\"case\":2,");
    check_format(&table, TABLE_TEXT,
                 "case  n  hurst  shape         kappa  total %  area:layered@0.1  total %\n"
                 "   0  4    0.2  a      2.00 +- 0.12       12      1.66 +- 0.25  >75\n");
    check_format(&table, TABLE_MARKDOWN,
                 "| case | n | hurst | shape | kappa | total % | area:layered@0.1 | total % |\n"
                 "| ---: | ---: | ---: | --- | ---: | ---: | ---: | --- |\n"
                 "| 0 | 4 | 0.2 | a | 2.00 +- 0.12 | 12 | 1.66 +- 0.25 | >75 |\n");
    check_format(&table, TABLE_TEXT,
                 "area:layered@0.1: y, edges at x; errors other than statistical up to ");
    check_format(&table, TABLE_TEXT, "Errors not known: cell of area:layered@0.1.\n");
    case_table_clear(&table);
}

static void what_stands_beside_a_value_is_a_column(void **state) {
    (void)state;
    struct case_table table =
        made("kappa,kappa.theory,area:layered@0.1.theory,area:layered@0.1.discretisation,kappa.law",
             "shape=a");
    check_format(&table, TABLE_MARKDOWN,
                 "| kappa | total % | kappa.theory | area:layered@0.1.theory | "
                 "area:layered@0.1.discretisation | kappa.law |\n");
    check_format(&table, TABLE_MARKDOWN, /* nothing is known of the other law */
                 "| 0 | 4 | 0.2 | a | 2.00 +- 0.12 | 12 | 1.5 | 0.25 | -0.50 +- 0.25 | - |\n");
    case_table_clear(&table);
}

static void units_stand_beside_values(void **state) {
    (void)state;
    in_units = true;
    struct case_table table = made("kappa", "shape=a");
    check_format(&table, TABLE_TEXT,
                 "case  n  hurst  shape         kappa          in \xc2\xb5m  total %\n"
                 "   0  4    0.2  a      2.00 +- 0.12   2.00 +- 0.12       12\n"
                 "   2  4    0.8  a      4.00 +- 0.12  12.00 +- 0.38      6.1\n");
    check_format(&table, TABLE_CSV,
                 "kappa_theory,kappa in m,kappa_total_low,kappa_total_high\n"
                 "0,4,0.2,\"a\",2,0.125,,1.5,2e-06,1.755,2.245\n");
    check_format(&table, TABLE_JSON, "\"unit\":null,\"physical_unit\":\"m\"}");
    check_format(&table, TABLE_JSON, "\"physical\":[null,null,2e-06]");
    case_table_clear(&table);
    in_units = false;
}

/* Of a kind whose view shows another quantity: what it names and is there, or has a theory. */
static void without_names_the_view_chooses(void **state) {
    (void)state;
    struct case_table table;
    struct error err = {0};
    assert_int_equal(case_table_make(&table, &SOURCE, &(struct table_request){0}, &err),
                     ERROR_INPUT);
    assert_non_null(strstr(err.text, "contact_area")); /* of which this source knows nothing */
}

/* A value that is part of another one is listed, too. */
static void all_values_are_told(void **state) {
    (void)state;
    static const double VALUES[] = {0.85, 0.8, 0.5};
    const char *const where[] = {"hurst=0.9", NULL};
    struct study_result study = built_study("statistics", "three", 3);
    const struct case_result *rows[3];
    struct error err = {0};
    size_t count;
    for (size_t c = 0; c < 3; c++)
        built_parameter(&study.cases[c], "/surface/hurst", NULL, VALUES[c]);
    assert_int_equal(case_rows_choose(&study, where, rows, &count, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "there is 0.85, 0.8, 0.5"));
    study_result_clear(&study);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_choose_columns),
        cmocka_unit_test(errors_stand_beside_values),
        cmocka_unit_test(conditions_choose_rows),
        cmocka_unit_test(what_there_is_not_is_told),
        cmocka_unit_test(all_values_are_told),
        cmocka_unit_test(each_format_has_every_number),
        cmocka_unit_test(what_stands_beside_a_value_is_a_column),
        cmocka_unit_test(units_stand_beside_values),
        cmocka_unit_test(without_names_the_view_chooses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
