/* Protects: librugo reads, writes and prints numbers with a decimal point within a program whose
 * locale has a comma, and leaves the program's locale as it was. */
#include "core/rugo.h"
#include "tests/support/check.h"
#include "tests/support/comma_locale.h"
#include <locale.h>
#include <stdio.h>
#include <string.h>

static const struct rugo_grid GRID = {4, 2, 2, 1};
static const double HEIGHTS[8] = {0.5, -1.25, 1e-6, 0, 3.75, 1234567.125, -0.1, 0.3};

/* This program's numbers have a comma now; skips the test where there is no such locale. */
static void take_comma(void) {
    char half[8];
    if (!comma_locale_make()) {
        print_message("skipped: localedef makes no locale here\n");
        skip();
    }
    assert_non_null(setlocale(LC_ALL, "comma"));
    snprintf(half, sizeof half, "%g", 0.5);
    assert_string_equal(half, "0,5");
}

static int give_back(void **state) {
    (void)state;
    setlocale(LC_ALL, "C");
    return 0;
}

static void check_comma_stays(locale_t before) {
    assert_string_equal(localeconv()->decimal_point, ",");
    assert_true(uselocale((locale_t)0) == before);
}

static void check_same_files(const char *a, const char *b) {
    char *first = slurp(a), *second = slurp(b);
    assert_string_equal(first, second);
    free(first);
    free(second);
}

/* Each format of text comes back to the bit, of a file written in either locale. */
static void maps_have_a_point(void **state) {
    (void)state;
    static const char *const ENDINGS[] = {"csv", "xyz"};
    struct rugo_error err = {0};
    char name[2][16];
    for (size_t e = 0; e < sizeof ENDINGS / sizeof *ENDINGS; e++) {
        struct rugo_map map = {.z = NULL};
        snprintf(name[0], sizeof name[0], "point.%s", ENDINGS[e]);
        snprintf(name[1], sizeof name[1], "comma.%s", ENDINGS[e]);
        setlocale(LC_ALL, "C");
        assert_int_equal(rugo_map_write(name[0], &GRID, HEIGHTS, &err), 0);
        take_comma();
        assert_int_equal(rugo_map_write(name[1], &GRID, HEIGHTS, &err), 0);
        check_same_files(name[0], name[1]);
        assert_int_equal(rugo_map_read(&map, name[0], 0.5, &err), 0);
        check_comma_stays(LC_GLOBAL_LOCALE);
        assert_int_equal(map.grid.nx, GRID.nx);
        check_close(map.grid.lx, GRID.lx, 1e-15);
        assert_memory_equal(map.z, HEIGHTS, sizeof HEIGHTS);
        rugo_map_clear(&map);
    }
}

static void messages_have_a_point(void **state) {
    (void)state;
    struct rugo_block block = rugo_block_defaults(RUGO_LAYERED, &GRID);
    struct rugo_contact *contact = NULL;
    struct rugo_map map = {.z = NULL};
    struct rugo_error err = {0};
    double ratio;
    take_comma();
    assert_int_equal(rugo_ratio_of_alpha(2, 1.5, 1, 10, &ratio, &err), RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "hurst must be in [0, 1], not 1.5"));
    block.poisson = 0.75;
    assert_int_equal(rugo_contact_create(&contact, &GRID, &block, &err), RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "0.75"));
    spit("bent.xyz", "0 0 1.5\n0.5 0 1\n0 0.5 2\n0.75 0.5 1\n"); /* context is put in front */
    assert_int_equal(rugo_map_read(&map, "bent.xyz", 0, &err), RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "bent.xyz: point 4 is at (0.75, 0.5), not at (0.5, 0.5)"));
    check_comma_stays(LC_GLOBAL_LOCALE);
}

/* A thread of the program may have a locale of its own. */
static void a_thread_keeps_its_locale(void **state) {
    (void)state;
    struct rugo_map map = {.z = NULL};
    struct rugo_error err = {0};
    take_comma();
    locale_t own = duplocale(LC_GLOBAL_LOCALE); /* newlocale loses memory with LOCPATH */
    setlocale(LC_ALL, "C");
    assert_true(own != (locale_t)0);
    uselocale(own);
    spit("row.csv", "0.5,0.25\n");
    assert_int_equal(rugo_map_read(&map, "row.csv", 0, &err), 0);
    assert_true(map.z[0] == 0.5 && map.z[1] == 0.25);
    assert_int_equal(rugo_map_read(&map, "row.csv", -0.5, &err), RUGO_ERROR_INPUT);
    assert_non_null(strstr(err.text, "not -0.5"));
    check_comma_stays(own);
    rugo_map_clear(&map);
    uselocale(LC_GLOBAL_LOCALE);
    freelocale(own);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(maps_have_a_point, give_back),
        cmocka_unit_test_teardown(messages_have_a_point, give_back),
        cmocka_unit_test_teardown(a_thread_keeps_its_locale, give_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
