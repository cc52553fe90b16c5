/* A result comes back from each of its formats as it went in: JSON, bytes; and its table and report
 * say what it holds. */
#include "core/file/memory_file.h"
#include "schema/result/bytes/bytes.h"
#include "schema/result/bytes/curve_bytes.h"
#include "schema/result/csv.h"
#include "schema/result/report.h"
#include "schema/result/result.h"
#include "schema/result/result_json.h"
#include "tests/support/sample_result.h"
#include <stdlib.h>

static char *print(const struct case_result *result) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    assert_true(result_print(file, result));
    assert_int_equal(fclose(file), 0);
    return text;
}

static const char PRINTED[] =
    "{\"case\":3,\"parameters\":{},\"realisations\":24,\"scalars\":{\"m0\":{\"value\":1,"
    "\"standard_error\":0.5,\"effective_realisations\":5.25,\"cell_error\":null,\"model_error\":-0."
    "5,\"model_bound\":0.25,"
    "\"model_error_standard_error\":0.125,\"total_low\":-0.35660292357302925,"
    "\"total_high\":3.1066029235730293,\"unknown_errors\":[\"cell\"]},\"alpha\":{\"value\":5,"
    "\"standard_error\":"
    "null,"
    "\"theory\":6,\"grid_theory\":5.5,\"total_low\":null,\"total_high\":null,\"unknown_errors\":[],"
    "\"law_difference\":-0.5,\"law_standard_error\":0.125}},"
    "\"curves\":[{\"quantity\":\"q\",\"series\":\"x, \\\"y\\\"\",\"x\":[0.1,2],\"y\":[3,null],"
    "\"standard_error\":[0.1,null],\"discretisation_error\":null,\"total_low\":[2.7931342389580953,"
    "null],"
    "\"total_high\":[3.2068657610419047,null],\"unknown_errors\":[\"discretisation\"],\"theory\":{"
    "\"nayak\":[1."
    "5,2.5]},"
    "\"x_label\":\"z/\302\265m\",\"underflow\":4,\"overflow\":0,\"y_label\":\"density\"},"
    "{\"quantity\":\"joint\",\"series\":\"\",\"x\":[0.1,2],\"x2\":[7,8,9],"
    "\"y\":[[0,2,0],[0,0,6]],\"standard_error\":[[0,0.25,0],[0,0,1]],"
    "\"discretisation_error\":[[null,-0.5,null],[null,null,1]],"
    "\"discretisation_bound\":[[null,0.75,null],[null,null,0]],"
    "\"discretisation_standard_error\":[[null,0.25,null],[null,null,1]],"
    "\"total_low\":[[null,1.2328355973952378,null],[null,null,2.931342389580952]],"
    "\"total_high\":[[null,3.767164402604762,null],[null,null,8.068657610419049]],\"unknown_"
    "errors\":[],"
    "\"theory\":{},\"x_label\":\"z\",\"x2_label\":\"t\","
    "\"y_label\":\"density\"},"
    "{\"quantity\":\"area\",\"series\":\"edges\",\"model\":\"full\",\"level\":8,\"points\":64,"
    "\"kinematics\":\"hencky\",\"pressure\":0.5,\"x\":[0.1,2],\"y\":[1e-300,0.5],"
    "\"standard_error\":[0,0],\"discretisation_error\":[0.25,0.5],\"discretisation_bound\":[0.125,"
    "0],"
    "\"discretisation_standard_error\":[0.01,0.02],\"discretisation_order\":1.5,"
    "\"discretisation_order_from\":\"levels\",\"block_error\":null,\"model_error\":[null,-2],"
    "\"model_error_standard_error\":[0.03,0.04],\"effective_realisations\":[6.5,4],\"total_low\":[-"
    "0.375,0.5],"
    "\"total_high\":[1e-300,2],\"unknown_errors\":[\"block\",\"model\"],\"law_difference\":[0.5,-1]"
    ","
    "\"law_standard_error\":[0.25,0.5],\"theory\":{\"persson\":[3,4]},"
    "\"x_label\":\"load\",\"valueless\":[0,3],\"y_label\":\"A/A0\"}],"
    "\"notes\":{\"count\":2,\"kept\":[{\"realisation\":7,\"text\":\"why\"}]}}";

static void json_comes_back(void **state) {
    (void)state;
    struct case_result sample, again = {0};
    struct error err = {0};
    sample_result(&sample);
    char *text = print(&sample);
    assert_string_equal(text, PRINTED);
    cJSON *document = cJSON_Parse(text);
    assert_int_equal(result_read(document, &again, &err), 0);
    char *second = print(&again);
    assert_string_equal(second, text);
    assert_int_equal(again.curves[1].cell_count, 2);
    assert_true(again.curves[2].errors[ERROR_DISCRETISATION].order_observed);
    assert_true(isnan(again.curves[0].level));
    free(text);
    free(second);
    cJSON_Delete(document);
    result_clear(&sample);
    result_clear(&again);
}

/* What a document says of totals is not taken from it: they are made anew, as older documents have
 * none, and others may have false ones. */
static void totals_are_not_read(void **state) {
    (void)state;
    static const char *const FALSE_ONES[] = {"[9]", "7", "null", "\"x\"", NULL};
    for (size_t f = 0; f == 0 || FALSE_ONES[f - 1] != NULL; f++) {
        struct case_result again = {0};
        struct error err = {0};
        cJSON *document = cJSON_Parse(PRINTED);
        cJSON *curves = cJSON_GetObjectItem(document, "curves");
        assert_non_null(curves);
        for (cJSON *curve = curves->child; curve != NULL; curve = curve->next) {
            cJSON_DeleteItemFromObject(curve, "total_low");
            cJSON_DeleteItemFromObject(curve, "unknown_errors");
            if (FALSE_ONES[f] != NULL)
                cJSON_AddItemToObject(curve, "total_low", cJSON_Parse(FALSE_ONES[f]));
        }
        assert_int_equal(result_read(document, &again, &err), 0);
        char *text = print(&again);
        assert_string_equal(text, PRINTED);
        free(text);
        cJSON_Delete(document);
        result_clear(&again);
    }
}

/* Each field that is missing or of another type is named; nothing is left behind. */
static void json_that_is_none_is_refused(void **state) {
    (void)state;
    static const struct {
        const char *from, *to, *named;
    } faults[] = {{"\"case\":3", "\"case\":-1", "case"},
                  {"\"realisations\":24", "\"realisations\":\"24\"", "realisations"},
                  {"\"quantity\":\"q\"", "\"quantity\":1", "quantity"},
                  {"\"series\":\"edges\"", "\"series\":null", "series"},
                  {"\"x\":[0.1,2],\"y\":[3,null]", "\"x\":[0.1],\"y\":[3,null]", "y"},
                  {"[[0,2,0],[0,0,6]]", "[[0,2,0],[0,0]]", "y"},
                  {"\"nayak\":[1.5,2.5]", "\"nayak\":[1.5]", "nayak"},
                  {"\"model_error\":[null,-2]", "\"model_error\":[null]", "model_error"},
                  {"\"text\":\"why\"", "\"text\":7", "text"}};
    for (size_t f = 0; f < sizeof faults / sizeof *faults; f++) {
        const char *at = strstr(PRINTED, faults[f].from);
        char text[sizeof PRINTED + 64];
        struct case_result result = {.case_number = 77};
        struct error err = {0};
        assert_non_null(at);
        snprintf(text, sizeof text, "%.*s%s%s", (int)(at - PRINTED), PRINTED, faults[f].to,
                 at + strlen(faults[f].from));
        cJSON *document = cJSON_Parse(text);
        assert_non_null(document);
        assert_int_equal(result_read(document, &result, &err), ERROR_INPUT);
        if (strstr(err.text, faults[f].named) == NULL)
            fail_msg("\"%s\" does not name %s", err.text, faults[f].named);
        assert_int_equal(result.case_number, 77);
        cJSON_Delete(document);
    }
}

static void bytes_come_back(void **state) {
    (void)state;
    struct case_result sample, again = {0};
    sample_result(&sample);
    for (size_t a = 0; a < sample.curve_count; a++) {
        unsigned char *data = NULL;
        size_t size = 0;
        assert_int_equal(curves_encode(&sample.curves[a], 1, &data, &size, NULL), 0);
        assert_int_equal(curves_decode(&again, data, size, NULL), 0);
        free(data);
    }
    assert_int_equal(again.curve_count, 3);
    const struct theory *theory = again.curves != NULL ? again.curves[1].theories : NULL;
    assert_true(theory != NULL && strcmp(theory->name, "nayak") == 0 && theory->y == NULL);
    again.case_number = sample.case_number;
    again.realisations = sample.realisations;
    result_sampled(&again, again.realisations);
    again.notes = sample.notes;
    again.note_count = sample.note_count;
    again.notes_all = sample.notes_all;
    for (size_t s = 0; s < sample.scalar_count; s++)
        assert_int_equal(result_add_scalar(&again, &sample.scalars[s], NULL), 0);
    char *first = print(&sample), *second = print(&again);
    assert_string_equal(second, first);
    free(first);
    free(second);
    result_clear(&sample);
    result_clear(&again);
}

/* A curve of another program may have an error of a source that this one does not know: it is left
 * out, and the curve comes back. */
static void unknown_sources_are_left_out(void **state) {
    (void)state;
    struct case_result sample, again = {0};
    unsigned char *data = NULL;
    size_t size = 0, renamed = 0;
    sample_result(&sample);
    assert_int_equal(curves_encode(&sample.curves[2], 1, &data, &size, NULL), 0);
    for (size_t a = 0; a + 14 < size; a++)
        if (memcmp(data + a, "discretisation", 14) == 0) {
            memcpy(data + a, "generation----", 14);
            renamed++;
        }
    assert_int_equal(renamed, 2); /* the error and its bound */
    uint64_t checksum = hash_bytes(HASH_START, size - 8, data);
    for (size_t a = 0; a < 8; a++)
        data[size - 8 + a] = (unsigned char)(checksum >> 8 * a);
    assert_int_equal(curves_decode(&again, data, size, NULL), 0);
    assert_false(again.curves[0].errors[ERROR_DISCRETISATION].applies);
    assert_true(again.curves[0].errors[ERROR_MODEL].value[1] == -2);
    assert_memory_equal(again.curves[0].y, sample.curves[2].y, 2 * sizeof *again.curves[0].y);
    assert_true(again.curves[0].law_difference[1] == -1);
    free(data);
    result_clear(&sample);
    result_clear(&again);
}

/* Whatever byte is changed, and wherever the bytes end: an error, and no curve. */
static void damaged_bytes_are_refused(void **state) {
    (void)state;
    struct case_result sample, again = {0};
    unsigned char *data = NULL;
    size_t size = 0;
    sample_result(&sample);
    assert_int_equal(curves_encode(&sample.curves[2], 1, &data, &size, NULL), 0);
    for (size_t a = 0; a < size; a++) {
        data[a] ^= 0x10;
        assert_int_equal(curves_decode(&again, data, size, NULL), ERROR_INPUT);
        data[a] ^= 0x10;
        assert_int_equal(curves_decode(&again, data, a, NULL), ERROR_INPUT);
    }
    assert_int_equal(again.curve_count, 0);
    free(data);
    result_clear(&sample);
    result_clear(&again);
}

static char *table_of(const struct case_result *result, struct curve *only) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    struct case_result one = *result;
    struct study_result study = {.case_count = 1, .cases = &one};
    if (only != NULL) {
        one.curves = only;
        one.curve_count = 1;
    }
    assert_true(csv_print(file, &study));
    assert_int_equal(fclose(file), 0);
    return text;
}

/* Quoting, gaps, matrices by their occupied cells, a column a source and a theory. */
static void csv_is_one_table(void **state) {
    (void)state;
    static const char HEADING[] =
        "case,quantity,series,model,kinematics,level,pressure,x,x2,y,"
        "standard_error,discretisation_error,discretisation_bound,"
        "cell_error,cell_bound,block_error,block_bound,model_error,"
        "model_bound,solver_error,solver_bound,missing_error,"
        "missing_bound,patch_error,patch_bound,valueless,law_difference,law_standard_error";
    static const char LAST[] = ",total_low,total_high,unknown_errors";
    static const char POINTS[] =
        "3,q,\"x, "
        "\"\"y\"\"\",,,,,0.1,,3,0.1,,,,,,,,,,,,,,,,,,1.5,,2.7931342389580953,3.2068657610419047,"
        "discretisation\n"
        "3,q,\"x, \"\"y\"\"\",,,,,2,,,,,,,,,,,,,,,,,,,,,2.5,,,,discretisation\n"
        "3,joint,,,,,,0.1,8,2,0.25,-0.5,0.75,,,,,,,,,,,,,,,,,,1.2328355973952378,3.767164402604762,"
        "\n"
        "3,joint,,,,,,2,9,6,1,1,0,,,,,,,,,,,,,,,,,,2.931342389580952,8.068657610419049,\n"
        "3,area,edges,full,hencky,8,0.5,0.1,,1e-300,0,0.25,0.125,,,,,,,,,,,,,0,0.5,0.25,,3,-0.375,"
        "1e-300,block model\n"
        "3,area,edges,full,hencky,8,0.5,2,,0.5,0,0.5,0,,,,,-2,,,,,,,,3,-1,0.5,,4,0.5,2,block "
        "model\n";
    struct case_result sample;
    char expected[2048];
    sample_result(&sample);
    char *all = table_of(&sample, NULL), *one = table_of(&sample, &sample.curves[1]);
    snprintf(expected, sizeof expected, "%s,theory_nayak,theory_persson%s\n%s", HEADING, LAST,
             POINTS);
    assert_string_equal(all, expected);
    snprintf(expected, sizeof expected,
             "%s,theory_nayak%s\n3,joint,,,,,,0.1,8,2,0.25,-0.5,0.75,,,,,,,,,,,,,,,,,1."
             "2328355973952378,3.767164402604762,\n"
             "3,joint,,,,,,2,9,6,1,1,0,,,,,,,,,,,,,,,,,2.931342389580952,8.068657610419049,\n",
             HEADING, LAST);
    assert_string_equal(one, expected);
    free(all);
    free(one);
    result_clear(&sample);
}

/* However many theories the curves have together, each has its column. */
static void csv_has_all_theories(void **state) {
    (void)state;
    enum { CURVES = 5 };
    static const double one[] = {1};
    char names[CURVES * THEORIES_MOST][16], last[32];
    struct case_result result = {0};
    struct error err = {0};
    for (size_t a = 0; a < CURVES; a++) {
        struct curve curve = curve_named("q", "x", "y");
        curve_set_points(&curve, 1, one, one, one);
        for (size_t t = 0; t < THEORIES_MOST; t++) {
            char *name = names[a * THEORIES_MOST + t];
            snprintf(name, sizeof names[0], "t%zu", a * THEORIES_MOST + t);
            curve.theories[curve.theory_count++] = (struct theory){name, one};
        }
        assert_int_equal(result_add_curve(&result, &curve, &err), 0);
    }
    char *text = table_of(&result, NULL);
    snprintf(last, sizeof last, ",theory_t%d,total_low,", CURVES * THEORIES_MOST - 1);
    assert_non_null(strstr(text, last));
    assert_non_null(strstr(text, ",theory_t16,theory_t17,"));
    free(text);
    result_clear(&result);
}

/* Lines of comment in front, a column for each swept parameter, whose name is no other column's. */
static void csv_tells_the_study(void **state) {
    (void)state;
    static const double one[] = {0.06};
    struct case_result result = {0};
    struct curve curve = curve_named("q", "x", "y");
    cJSON *parameters = cJSON_Parse("{\"s\":{\"hurst\":0.8,\"x\":\"a,b\"},\"t\":{\"n\":[1,2]},"
                                    "\"u\":{\"n\":3}}");
    struct study_result study = {
        .id = (char *)"0123456789abcdef",
        .name = (char *)"two\nlines",
        .kind = (char *)"contact",
        .state = (char *)"done",
        .swept = cJSON_Parse("[\"/s/hurst\",\"/s/x\",\"/t/n\",\"/u/n\",\"/s/gone\"]"),
        .provenance = cJSON_Parse(
            "{\"seed\":\"7\",\"program\":null,\"created\":\"2026-01-02T03:04:05Z\",\"finished\":"
            "null,\"runs\":[{\"host\":\"h\",\"program\":\"0.1.0+c0ffee\",\"jobs\":3,\"first\":"
            "\"2026-01-02T03:04:06Z\",\"last\":\"2026-01-02T03:05:00Z\"}]}"),
        .case_count = 1,
        .cases = &result};
    assert_int_equal(result_set_parameters(&result, parameters, NULL), 0);
    curve_set_points(&curve, 1, one, one, one);
    assert_int_equal(result_add_curve(&result, &curve, NULL), 0);
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_true(file != NULL && csv_print(file, &study));
    assert_int_equal(fclose(file), 0);
    static const char HEAD[] = "# study: two?lines, contact 0123456789abcdef, done, seed 7\n"
                               "# queued: 2026-01-02T03:04:05Z\n"
                               "# computed: 3 jobs on h by rugo 0.1.0+c0ffee, 2026-01-02T03:04:06Z "
                               "to 2026-01-02T03:05:00Z\n"
                               "case,hurst,s/x,t/n,u/n,gone,quantity,series,";
    assert_memory_equal(text, HEAD, sizeof HEAD - 1);
    assert_non_null(strstr(text, "\n0,0.8,\"a,b\",\"[1,2]\",3,,q,,,,,,0.06,,0.06,0.06,"));
    free(text);
    cJSON_Delete(parameters);
    cJSON_Delete(study.swept);
    cJSON_Delete(study.provenance);
    result_clear(&result);
}

static char *print_report(const struct case_report *report) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    assert_non_null(file);
    assert_true(case_report_print(file, report));
    assert_int_equal(fclose(file), 0);
    return text;
}

static void report_measures_and_comes_back(void **state) {
    (void)state;
    struct case_result sample;
    struct case_report report, again;
    struct error err = {0};
    const struct work_time time = {.seconds = 10, .cpu_seconds = 4, .jobs_without_cpu = 1};
    sample_result(&sample);
    assert_int_equal(case_report_make(&report, &sample, &err), 0);
    assert_int_equal(report.curve_count, 3);
    assert_ptr_equal(report.main, &report.curves[0]);
    /* one point is known: 0.1/3, |3 - 1.5|/1.5 */
    assert_true(fabs(report.curves[0].statistical - 0.1 / 3) <= 1e-15);
    assert_true(fabs(report.curves[0].theories[0].deviation - 1) <= 1e-15);
    /* cells 2 +- 0.25 and 6 +- 1 */
    assert_true(fabs(report.curves[1].statistical - sqrt((0.0625 + 1) / 40)) <= 1e-15);
    /* the limits are 1e-300 - 0.25 and 0.5 - 0.5, the bounds 0.125 and 0 */
    assert_true(fabs(report.curves[2].errors[ERROR_DISCRETISATION] - 2.5) <= 1e-12);
    /* of one point, or at all, not known: so there is no total */
    assert_true(isnan(report.curves[2].errors[ERROR_MODEL]) &&
                report.curves[2].applies[ERROR_MODEL]);
    assert_true(report.curves[2].applies[ERROR_BLOCK] && isnan(report.curves[2].total));
    /* limits 2.5 and 5, from which the cells are 0.5 and 1; bounds 0.75 and 0 */
    assert_true(fabs(report.curves[1].errors[ERROR_DISCRETISATION] -
                     sqrt((1.25 * 1.25 + 1) / (2.5 * 2.5 + 25))) <= 1e-15);
    assert_true(report.curves[1].total > report.curves[1].statistical);
    assert_false(report.curves[2].applies[ERROR_CELL]);
    assert_true(report.curves[2].valueless == 3);
    assert_true(isnan(report.curves[0].valueless));
    assert_true(isnan(report.curves[0].law));
    assert_true(fabs(report.curves[2].law - sqrt(1.25) / 0.5) <= 1e-12);
    assert_true(report.scalars[0].statistical == 0.5);
    assert_false(report.scalars[0].has_theory);
    assert_true(fabs(report.scalars[1].deviation - 1.0 / 6) <= 1e-15);
    case_report_spend(&report, &time);
    assert_true(case_report_seconds_to_halve(&report) == 12);
    assert_true(report.curves[0].seconds == 2.5 * report.curves[0].cpu_seconds);
    char *first = print_report(&report);
    cJSON *document = cJSON_Parse(first);
    assert_int_equal(case_report_read(document, &again, &err), 0);
    assert_ptr_equal(again.main, &again.curves[0]);
    char *second = print_report(&again);
    assert_string_equal(second, first);
    free(second);
    case_report_clear(&again);
    /* an older program counted a source that is none now */
    cJSON *curve = cJSON_GetArrayItem(cJSON_GetObjectItem(document, "curves"), 1);
    assert_true(cJSON_AddNumberToObject(curve, "generation_error", 9) != NULL);
    cJSON_SetNumberValue(cJSON_GetObjectItem(curve, "total_error"), 9.5);
    assert_int_equal(case_report_read(document, &again, &err), 0);
    second = print_report(&again);
    assert_string_equal(second, first);
    free(first);
    free(second);
    cJSON_Delete(document);
    case_report_clear(&report);
    case_report_clear(&again);
    result_clear(&sample);
}

static void parameters_are_told_by_pointer(void **state) {
    (void)state;
    cJSON *parameters = cJSON_Parse(
        "{\"a\":{\"b/c\":1,\"d~\":\"x\"},\"list\":[1,0.06],\"e\":{\"f\":{\"g\":-2.5}}}");
    struct case_result result = {0};
    assert_int_equal(result_set_parameters(&result, parameters, NULL), 0);
    assert_int_equal(result.parameter_count, 4);
    assert_true(result_parameter(&result, "/a/b~1c")->number == 1);
    assert_string_equal(result_parameter(&result, "/a/d~0")->text, "x");
    assert_true(result_parameter(&result, "/e/f/g")->number == -2.5);
    const struct result_parameter *list = result_parameter(&result, "/list");
    assert_true(list != NULL && list->list && strcmp(list->text, "[1,0.06]") == 0);
    struct memory_file memory;
    assert_true(memory_file_open(&memory));
    assert_true(result_print_parameters(memory.file, result.parameter_count, result.parameters));
    char *text = memory_file_close(&memory, NULL);
    cJSON *printed = cJSON_Parse(text); /* which reads back, the list as a list */
    struct case_result again = {0};
    assert_int_equal(result_read_parameters(&again, printed, NULL), 0);
    assert_int_equal(again.parameter_count, 4);
    assert_string_equal(result_parameter(&again, "/list")->text, "[1,0.06]");
    assert_true(cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(printed, "/list")));
    cJSON_Delete(printed);
    free(text);
    result_clear(&again);
    result_clear(&result);
    cJSON_Delete(parameters);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(json_comes_back),
        cmocka_unit_test(totals_are_not_read),
        cmocka_unit_test(json_that_is_none_is_refused),
        cmocka_unit_test(bytes_come_back),
        cmocka_unit_test(unknown_sources_are_left_out),
        cmocka_unit_test(damaged_bytes_are_refused),
        cmocka_unit_test(csv_is_one_table),
        cmocka_unit_test(csv_has_all_theories),
        cmocka_unit_test(csv_tells_the_study),
        cmocka_unit_test(report_measures_and_comes_back),
        cmocka_unit_test(parameters_are_told_by_pointer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
