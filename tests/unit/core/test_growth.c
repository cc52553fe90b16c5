/* Protects: the exponents and numbers in tables of growth (tests/support/growth.h), which pages
 * hold. */
#include "tests/support/check.h"
#include "tests/support/growth.h"

static void test_exponent_of_a_power(void **state) {
    const double sizes[] = {128, 512, 4096, 1e6};
    double values[4], noisy[4], part[4];
    (void)state;
    for (size_t n = 0; n < 4; n++) {
        values[n] = 3e-4 * pow(sizes[n], 1.25);
        part[n] = n == 2 ? 0 : values[n]; /* not measured */
        noisy[n] = values[n] * (n % 2 == 0 ? 1.01 : 1 / 1.01);
    }
    check_close(growth_exponent(sizes, values, 4), 1.25, 1e-12);
    check_close(growth_exponent(sizes, part, 4), 1.25, 1e-12);
    assert_true(isnan(growth_exponent(sizes, values, 1)));
    /* 1 % up and down over four decades */
    check_close(growth_exponent(sizes, noisy, 4), 1.25, 0.01);
}

static void test_numbers_of_tables(void **state) {
    static const struct {
        double value;
        const char *text;
    } ROWS[] = {{0, "-"},
                {0.004567, "0.00457"},
                {1.2344, "1.23"},
                {99.94, "99.9"},
                {99.96, "100"},
                {9999.4, "9999"},
                {9999.6, "10 000"},
                {16384, "16 384"},
                {1000001, "1 000 001"},
                {999999.6, "1 000 000"},
                {100000, "100 000"},
                {12045006, "12 045 006"}};
    char text[GROWTH_TEXT_SIZE];
    (void)state;
    for (size_t n = 0; n < sizeof ROWS / sizeof *ROWS; n++)
        assert_string_equal(growth_text(text, ROWS[n].value), ROWS[n].text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exponent_of_a_power),
        cmocka_unit_test(test_numbers_of_tables),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
