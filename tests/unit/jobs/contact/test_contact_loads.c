/* Protects: loads are the numbers that a person would write, are printed with all digits, and those
 * of studies that an older program stored stay as they were. */
#include "jobs/contact/case/contact_case_read.h"
#include "jobs/contact/case/contact_loads.h"
#include "schema/json/json.h"
#include "tests/support/check.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Steps of 1 / 10^digits up to each of these: the k-th one is an integer over a power of ten, which
 * reads back as the nearest double. */
static void loads_are_the_nearest_doubles(void **state) {
    (void)state;
    static const struct {
        double to;
        long last; /* in units of 10^-digits */
        int digits;
    } CASES[] = {{0.3, 30, 2}, {0.3, 300, 3}, {0.07, 7, 2}, {1.1, 11, 1}, {0.1, 1000, 4}};
    size_t mended = 0;
    for (size_t n = 0; n < sizeof CASES / sizeof *CASES; n++)
        for (long k = 0; k < CASES[n].last; k++) {
            char text[40];
            snprintf(text, sizeof text, "%lde-%d", k + 1, CASES[n].digits);
            double load = contact_load(CASES[n].to, (size_t)k, (size_t)CASES[n].last);
            if (load != strtod(text, NULL))
                fail_msg("load %ld of %ld up to %g is %.17g, not %s", k, CASES[n].last, CASES[n].to,
                         load, text);
            mended += load != CASES[n].to * (double)(k + 1) / (double)CASES[n].last;
        }
    assert_true(mended > 10); /* the plain quotient is another double so often */
}

static void loads_rise_up_to_the_highest(void **state) {
    (void)state;
    static const double HIGHEST[] = {1e-300, 0.1 + 0.2, 1.0 / 3, 1e6};
    for (size_t n = 0; n < sizeof HIGHEST / sizeof *HIGHEST; n++)
        for (size_t k = 0; k < 1000; k++) {
            double load = contact_load(HIGHEST[n], k, 1000);
            assert_true(load > (k > 0 ? contact_load(HIGHEST[n], k - 1, 1000) : 0));
            check_relative(load, HIGHEST[n] * (double)(k + 1) / 1000, 1e-14);
        }
    assert_true(contact_load(0.1 + 0.2, 6, 7) == 0.1 + 0.2);
}

/* What a case's parameters become, as text; the caller frees. */
static char *filled(const char *document, const char *parameters) {
    cJSON *study = cJSON_Parse(document), *one = cJSON_Parse(parameters);
    assert_true(study != NULL && one != NULL);
    assert_int_equal(contact_loads_fill(study, one, NULL), 0);
    char *text = json_print(one);
    cJSON_Delete(study);
    cJSON_Delete(one);
    assert_non_null(text);
    return text;
}

static void loads_are_written_out(void **state) {
    (void)state;
    static const struct {
        const char *document, *parameters, *filled;
    } CASES[] = {
        {"{}", "{\"contact\":{\"pressures\":{\"to\":0.3,\"steps\":3}}}",
         "{\"contact\":{\"pressures\":{\"values\":[0.1,0.2,0.3]}}}"},
        {"{\"contact\":{\"pressures\":{\"to\":[0.3,0.6]}}}",
         "{\"contact\":{\"pressures\":{\"to\":0.6,\"steps\":2}}}",
         "{\"contact\":{\"pressures\":{\"to\":0.6,\"values\":[0.3,0.6]}}}"},
        {"{}", "{\"contact\":{\"pressures\":{\"values\":[0.05]}}}",
         "{\"contact\":{\"pressures\":{\"values\":[0.05]}}}"},
    };
    for (size_t n = 0; n < sizeof CASES / sizeof *CASES; n++) {
        char *text = filled(CASES[n].document, CASES[n].parameters);
        assert_string_equal(text, CASES[n].filled);
        free(text);
    }
    char *usual = filled("{}", "{}");
    assert_non_null(strstr(usual, "[0.01,0.02,0.03,0.04,0.05,0.06,0.07,"));
    assert_non_null(strstr(usual, ",0.29,0.3]"));
    free(usual);
}

#define CASE(pressures)                                                                            \
    "{\"surface\":{\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4},\"contact\":{"            \
    "\"pressures\":{" pressures "}}}"

static void check_load(const char *parameters, size_t k, double expected) {
    struct contact_case one_case;
    cJSON *object = cJSON_Parse(parameters);
    assert_non_null(object);
    assert_int_equal(contact_case_read(&one_case, object, 0, NULL, NULL), 0);
    assert_true(k < one_case.load_count && one_case.loads[k] == expected);
    contact_case_clear(&one_case);
    cJSON_Delete(object);
}

/* A store of an older program has cases without the list, whose blocks are of these loads. */
static void stored_cases_keep_their_loads(void **state) {
    (void)state;
    const volatile double to = 0.3; /* so that the product is that of doubles */
    assert_true(to * 6 / 30 != 0.06);
    check_load(CASE("\"to\":0.3,\"steps\":30"), 5, to * 6 / 30);
    check_load(CASE(""), 5, to * 6 / 30);
    check_load(CASE("\"values\":[0.03,0.06],\"to\":0.06"), 1, 0.06); /* where "to" was swept */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loads_are_the_nearest_doubles),
        cmocka_unit_test(loads_rise_up_to_the_highest),
        cmocka_unit_test(loads_are_written_out),
        cmocka_unit_test(stored_cases_keep_their_loads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
