/* Protects: what a study that asks for an error tells is within that error of plain sampling on
 * long cells and fine meshes, for Gaussian and other heights. */
#include "tests/support/check.h"
#include "tests/support/target_coverage.h"

enum { REFERENCES = 60 };

/* The reference errs too: by chance, two of its standard errors. */
static void points_are_within_the_error(void **state) {
    (void)state;
    static const struct coverage_question QUESTIONS[] = {
        {"\"distribution\":\"gaussian\"", "halfspace", 0.8, 0.03, 1},
        {"\"distribution\":\"gaussian\"", "layered", 0.5, 0.05, 2},
        {"\"distribution\":\"weibull_min\",\"shape\":2", "halfspace", 0.8, 0.05, 3}};
    for (size_t a = 0; a < sizeof QUESTIONS / sizeof *QUESTIONS; a++) {
        struct coverage_points answer = {.work = 0}, reference = {.work = 0};
        assert_true(coverage_ask(&QUESTIONS[a], 0, &answer));
        assert_true(coverage_ask(&QUESTIONS[a], REFERENCES, &reference));
        print_message("study %zu: error asked %g, reached %.3g\n", a, QUESTIONS[a].error,
                      answer.reached);
        for (int k = 0; k < COVERAGE_LOADS; k++)
            check_close(answer.y[k], reference.y[k],
                        fmax(QUESTIONS[a].error, answer.reached) * reference.y[k] +
                            2 * reference.error[k]);
        assert_true(answer.reached < 1.5 * QUESTIONS[a].error);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(points_are_within_the_error)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
