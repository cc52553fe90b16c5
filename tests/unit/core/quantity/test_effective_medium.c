/* Protects: the effective medium of mixtures whose equation is solved by hand. */
#include "core/quantity/effective_medium.h"
#include "tests/support/check.h"

enum { N = 1000 };

/* `count` of N parts have a, the others b. */
static double mixture(size_t count, double a, double b) {
    static double s[N];
    for (size_t i = 0; i < N; i++)
        s[i] = i * 7 % N < count ? a : b;
    return effective_medium(N, s);
}

static void mixtures_of_two(void **state) {
    (void)state;
    check_relative(mixture(N, 3, 0), 3, 1e-12);
    /* (a - s)/(a + s) = (s - b)/(s + b): s^2 = a b */
    check_relative(mixture(N / 2, 4, 9), 6, 1e-11);
    check_relative(mixture(N / 2, 1e-6, 1e2), 1e-2, 1e-11);
    /* f (a - s)/(a + s) = 1 - f: s = a (2 f - 1) */
    check_relative(mixture(900, 5, 0), 4, 1e-11);
    check_relative(mixture(501, 1e-15, 0), 2e-18, 1e-9);
    assert_true(mixture(500, 1, 0) == 0);
    assert_true(mixture(0, 1, 0) == 0);
    /* 0.25 (8 - s)/(8 + s) + 0.75 (1 - s)/(1 + s) = 0: s^2 + 3.5 s - 8 = 0 */
    check_relative(mixture(250, 8, 1), -1.75 + sqrt(1.75 * 1.75 + 8), 1e-11);
}

static void few_parts(void **state) {
    (void)state;
    const double one = 2, three[] = {1, 1, 0};
    check_relative(effective_medium(1, &one), 2, 1e-12);
    check_relative(effective_medium(3, three), 1.0 / 3, 1e-11);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mixtures_of_two),
        cmocka_unit_test(few_parts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
