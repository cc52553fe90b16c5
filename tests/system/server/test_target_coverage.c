/* Protects: what a study that asks for an error tells is within the error that it tells of plain
 * sampling on long cells and fine meshes: profiles and surfaces, Gaussian and other heights, linear
 * models and full. */
#include "tests/support/check.h"
#include "tests/support/target_coverage.h"
#include <math.h>

#define GAUSSIAN "\"distribution\":\"gaussian\""
#define WEIBULL(shape) "\"distribution\":\"weibull_min\",\"shape\":" shape

/* The reference errs too: by chance, two of its standard errors. */
static void check_question(const struct coverage_question *question, int seed,
                           const struct coverage_effort *effort) {
    struct coverage_points answer = {.work = 0}, reference = {.work = 0};
    assert_true(coverage_ask(question, seed, &answer));
    assert_true(coverage_reference(question, effort, &reference));
    assert_true(answer.count > 1 && answer.count == reference.count);
    print_message("%s, %dD: error asked %g, reached %.3g\n", question->model,
                  question->scene->dimension + 1, question->error, answer.reached);
    for (int k = 0; k < answer.count; k++)
        check_close(answer.y[k], reference.y[k],
                    answer.reached * reference.y[k] + 2 * reference.standard_error[k]);
    assert_true(answer.reached < 1.5 * question->error);
}

static void profiles_are_within_the_error(void **state) {
    (void)state;
    static const struct coverage_scene SMOOTH = {GAUSSIAN, 1, 0.8, 2, "[0.03,0.1,0.2]"},
                                       ROUGH = {GAUSSIAN, 1, 0.5, 2, "[0.1,0.2]"},
                                       LOW = {WEIBULL("2"), 1, 0.8, 4, "[0.1,0.2]"};
    static const struct coverage_effort EFFORT = {16, 40, 0, 512, 64, 0, "[8]", "[8,16,32]", ""};
    check_question(&(struct coverage_question){&SMOOTH, "halfspace", NULL, 0.03}, 1, &EFFORT);
    check_question(&(struct coverage_question){&ROUGH, "layered", NULL, 0.05}, 2, &EFFORT);
    check_question(&(struct coverage_question){&LOW, "halfspace", NULL, 0.05}, 3, &EFFORT);
}

/* Heights further from Gaussian ones cannot be had of profiles of so few waves: what the surfaces
 * owe to the way they are found is a third of their area then. */
static void profiles_of_full_are_within_the_error(void **state) {
    (void)state;
    static const struct coverage_scene LOW = {WEIBULL("3.602"), 1, 0.8, 2, "[0.1,0.2]"};
    static const struct coverage_effort EFFORT = {16, 40,    10,          512,       64,
                                                  8,  "[8]", "[8,16,32]", "[4,8,16]"};
    check_question(&(struct coverage_question){&LOW, "full", NULL, 0.03}, 1, &EFFORT);
}

static void surfaces_are_within_the_error(void **state) {
    (void)state;
    static const struct coverage_scene SURFACE = {GAUSSIAN, 2, 0.8, 2, "[0.1,0.2]"};
    static const struct coverage_effort EFFORT = {16, 6, 0, 8, 4, 0, "[4]", "[4,8,16]", ""};
    check_question(&(struct coverage_question){&SURFACE, "halfspace", NULL, 0.05}, 1, &EFFORT);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(profiles_are_within_the_error),
                                       cmocka_unit_test(profiles_of_full_are_within_the_error),
                                       cmocka_unit_test(surfaces_are_within_the_error)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
