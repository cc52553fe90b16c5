/* Protects: stored partial results stay readable. Each holds the fingerprint of its case, so that
 * fingerprints of cases that people have computed must not change, by a bit; these here were
 * written down when the first stores were made. */
#include "jobs/kind.h"
#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

#define PLAIN "\"hurst\": 0.8, \"wavelength_ratio\": 4"
#define PROFILE "\"dimension\": 1, \"length_ratio\": 2, " PLAIN
#define CASE(surface, rest) "{\"surface\": {" surface "}" rest "}"

struct marked {
    const char *text;
    uint64_t fingerprint;
};

static uint64_t mark_of(const char *kind, const cJSON *parameters) {
    struct error err = {0};
    uint64_t mark = 0;
    if (kind_fingerprint(kind_find(kind), parameters, &mark, &err) != 0)
        fail_msg("%s", err.text);
    return mark;
}

/* Stores hold effective values, with the defaults of their time written out. */
static void put_old_defaults(cJSON *parameters) {
    cJSON *surface = cJSON_GetObjectItem(parameters, "surface");
    cJSON *heights = cJSON_GetObjectItem(surface, "heights");
    if (heights == NULL)
        heights = cJSON_AddObjectToObject(surface, "heights");
    if (cJSON_GetObjectItem(heights, "iteration") == NULL)
        cJSON_AddStringToObject(heights, "iteration", "relaxed");
}

static void compare(const struct marked *cases, size_t n, const char *kind) {
    int wrong = 0;
    for (size_t c = 0; c < n; c++) {
        cJSON *parameters = cJSON_Parse(cases[c].text);
        assert_non_null(parameters);
        put_old_defaults(parameters);
        uint64_t mark = mark_of(kind, parameters);
        cJSON_Delete(parameters);
        if (mark != cases[c].fingerprint) {
            print_error("%s: UINT64_C(0x%016" PRIx64 ")\n", cases[c].text, mark);
            wrong++;
        }
    }
    assert_int_equal(wrong, 0);
}

static void statistics_cases(void **state) {
    (void)state;
    static const struct marked CASES[] = {
        {CASE(PLAIN, ""), UINT64_C(0xaaae75c7816c81d3)},
        {CASE(PROFILE, ", \"statistics\": {\"summits\": \"five_point\"}"),
         UINT64_C(0xc1f83a51323b5c88)},
        {CASE(PROFILE ", \"rms_slope\": 0.1", ", \"statistics\": {\"summits\": \"refined\","
                                              " \"curvature\": \"spectral\"}"),
         UINT64_C(0x7f90395b5805ae82)},
        {CASE("\"hurst\": 0.6, \"nayak_alpha\": 5, \"alpha_formula\": \"continuous\"", ""),
         UINT64_C(0xd4a2a3389e6454ac)},
        {CASE(PLAIN, ", \"statistics\": {\"bins\": {\"height\": [-4, 8, 120],"
                     " \"curvature\": [-8, 1.5, 40]}}"),
         UINT64_C(0xc5625dd8a8a52b0a)},
        {CASE(PLAIN ", \"heights\": {\"distribution\": \"weibull_max\", \"shape\": 1.5,"
                    " \"keep\": \"heights\", \"relaxed_iterations\": 7}",
              ""),
         UINT64_C(0x68e912ce3818c313)},
        {CASE("\"wavelength_ratio\": 4, \"spectrum\": {\"type\": \"exponential_acf\","
              " \"length\": [2, 3]}",
              ""),
         UINT64_C(0x134ed1ae8317d37a)},
        {CASE("\"wavelength_ratio\": 4, \"spectrum\": {\"type\": \"table\","
              " \"wave_number\": [1, 2, 6], \"density\": [3, 2, 0]}",
              ""),
         UINT64_C(0xf3dba5cc14d49c85)},
        {"{\"surface\":{\"dimension\":2,\"hurst\":0.2,\"nayak_alpha\":5,\"alpha_formula\":"
         "\"continuous\",\"rolloff_ratio\":1,\"length_ratio\":8,\"points_per_wavelength\":8,"
         "\"spectrum\":{\"type\":\"self_affine\"},\"heights\":{\"distribution\":\"gaussian\","
         "\"tolerance\":0.001,\"keep\":\"spectrum\",\"iteration\":\"relaxed\",\"draw\":\"random\","
         "\"stall_gain\":0.050000000000000003,\"stall_iterations\":10,\"max_iterations\":1000}},"
         "\"statistics\":{\"summits\":\"nine_point\",\"curvature\":\"finite_difference\",\"bins\":"
         "{\"height\":[-4,8,240],\"curvature\":[-16,0,160]}}}",
         UINT64_C(0xf1bebb8f8a6c73af)},
    };
    compare(CASES, sizeof CASES / sizeof *CASES, "statistics");
}

static void contact_cases(void **state) {
    (void)state;
    static const struct marked CASES[] = {
        {CASE(PLAIN, ""), UINT64_C(0x48e4081b79253873)},
        {CASE(PROFILE, ", \"contact\": {\"model\": \"layered\", \"poisson\": 0.4}"),
         UINT64_C(0x6ace5b117d9816f6)},
        {CASE(PROFILE, ", \"contact\": {\"model\": [\"halfspace\", \"layered\"],"
                       " \"block_height\": {\"lengths\": 2}, \"layer_growth\": 1.2}"),
         UINT64_C(0xe8ba2e0a60bb64d6)},
        {CASE(PROFILE, ", \"contact\": {\"block_height\": \"infinite\"}"),
         UINT64_C(0xea5b85635950e402)},
        {CASE(PROFILE ", \"rms_slope\": 0.1",
              ", \"contact\": {\"model\": [\"layered\", \"full\"],"
              " \"block_height\": {\"rms_heights\": 160}, \"kinematics\": \"small\","
              " \"transition_depth\": 9, \"gap_weighting\": \"dual\"}"),
         UINT64_C(0xd4368dde9a6b8fec)},
        {CASE(PROFILE, ", \"contact\": {\"pressures\": {\"to\": 0.2, \"steps\": 7},"
                       " \"estimators\": \"nodes\", \"tolerance\": 1e-6}"),
         UINT64_C(0x3e82d9e4cef3b4e2)},
        {CASE(PROFILE, ", \"contact\": {\"pressures\": {\"values\": [0.01, 0.1]},"
                       " \"estimators\": [\"nodes\", \"edges\"], \"levels\": [4, 8, 16],"
                       " \"pressure_pdf\": {\"at\": [0.1], \"bins\": [0, 2, 20]}}"),
         UINT64_C(0xd7d1dc7b4422e5a1)},
        {CASE(PLAIN ", \"heights\": {\"distribution\": \"weibull_min\", \"shape\": 2}",
              ", \"contact\": {\"young\": 7, \"pressures\": {\"steps\": 3}}"),
         UINT64_C(0x4450fda27e2ea4da)},
    };
    compare(CASES, sizeof CASES / sizeof *CASES, "contact");
}

static const struct parameter OLD[] = {
    {.path = "/a/b", .type = PARAMETER_NUMBER, .minimum = -9, .maximum = 9, .default_json = "2"},
    {.path = "/a/c", .type = PARAMETER_INTEGER, .minimum = -9, .maximum = 9},
};
static const struct parameter NEW[] = {
    {.path = "/a/b", .type = PARAMETER_NUMBER, .minimum = -9, .maximum = 9, .default_json = "2"},
    {.path = "/a/d",
     .type = PARAMETER_NUMBER,
     .minimum = -9,
     .maximum = 9,
     .default_json = "4",
     .later = true},
    {.path = "/a/e", .type = PARAMETER_NUMBER, .minimum = -9, .maximum = 9, .later = true},
    {.path = "/a/c", .type = PARAMETER_INTEGER, .minimum = -9, .maximum = 9},
};
static const struct parameter_table OLD_TABLE = {"a", OLD, 2}, NEW_TABLE = {"a", NEW, 4};
static const struct parameter_table *const OLD_TABLES[] = {&OLD_TABLE, NULL};
static const struct parameter_table *const NEW_TABLES[] = {&NEW_TABLE, NULL};

static uint64_t table_mark(const char *text, const struct parameter_table *const *tables) {
    cJSON *parameters = cJSON_Parse(text);
    struct values *values = NULL;
    assert_int_equal(values_create(&values, parameters, tables, NULL, NULL), 0);
    uint64_t mark = case_fingerprint(values, tables);
    values_destroy(&values);
    cJSON_Delete(parameters);
    return mark;
}

/* The same whatever the order of keys and whether a default is written out; rows added later count
 * where they are used, and only there. */
static void rule(void **state) {
    (void)state;
    uint64_t mark = table_mark("{\"a\": {\"b\": 2, \"c\": 3}}", OLD_TABLES);
    assert_true(mark == table_mark("{\"a\": {\"c\": 3}}", OLD_TABLES));
    assert_true(mark == table_mark("{\"a\": {\"c\": 3, \"b\": 2}}", OLD_TABLES));
    assert_true(mark != table_mark("{\"a\": {\"c\": 2, \"b\": 3}}", OLD_TABLES));
    assert_true(mark != table_mark("{\"a\": {\"b\": 3}}", OLD_TABLES));
    assert_true(mark == table_mark("{\"a\": {\"c\": 3}}", NEW_TABLES));
    assert_true(mark == table_mark("{\"a\": {\"c\": 3, \"d\": 4}}", NEW_TABLES));
    uint64_t used = table_mark("{\"a\": {\"c\": 3, \"d\": 5}}", NEW_TABLES);
    assert_true(used != mark);
    assert_true(used != table_mark("{\"a\": {\"c\": 3, \"e\": 5}}", NEW_TABLES));
    assert_true(used != table_mark("{\"a\": {\"c\": 3, \"d\": 6}}", NEW_TABLES));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(statistics_cases),
        cmocka_unit_test(contact_cases),
        cmocka_unit_test(rule),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
