/* Protects: the answer of a study that asks for an error agrees within the reported error with
 * plain sampling on long cells and fine meshes: profiles and surfaces, Gaussian and other heights,
 * linear models and full. */
#include "tests/support/check.h"
#include "tests/support/target_coverage.h"
#include <math.h>

#define GAUSSIAN "\"distribution\":\"gaussian\""
#define WEIBULL(shape) "\"distribution\":\"weibull_min\",\"shape\":" shape

/* The reference has a statistical error, too: two of its standard errors. */
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

/* Heights further from Gaussian ones cannot be had of profiles of so few waves: the generation
 * error is a third of their area then. */
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

/* Measures beside those that a target may be of: nodes in contact, stiffness, patches. Their
 * references are of 64 longest waves; the last is reported in cells there, and in longest waves by
 * a target. */
enum { OTHERS = 4 };
static const double WAVES = 64;
static const struct coverage_choice OTHER[OTHERS] = {{"contact_area", "halfspace", "nodes"},
                                                     {"stiffness", "halfspace", ""},
                                                     {"patch_count", "halfspace", "wave"},
                                                     {"patch_mean_area", "halfspace", "wave"}};

/* Reads them all into out[OTHERS]. */
static bool read_others(sqlite3 *db, const struct coverage_choice *choice,
                        struct coverage_points *out) {
    bool done = true;
    (void)choice;
    for (size_t a = 0; a < OTHERS && done; a++) {
        struct coverage_choice in_cell = OTHER[a];
        in_cell.series = "";
        done = coverage_read_curve(db, &OTHER[a], &out[a]) ||
               coverage_read_curve(db, &in_cell, &out[a]);
    }
    return done;
}

static void other_measures_are_within_what_is_told(void **state) {
    (void)state;
    static const struct coverage_scene SCENE = {GAUSSIAN, 1, 0.8, 4, "[0.03,0.1,0.2]"};
    static const char MEASURED[] =
        "\"model\":\"halfspace\",\"estimators\":[\"nodes\"],\"stiffness\":\"measured\"";
    struct coverage_points answer[OTHERS] = {{0}}, reference[OTHERS] = {{0}};
    char text[COVERAGE_TEXT], fine[COVERAGE_TEXT / 4];
    coverage_write_study(&SCENE, 4, "\"target\":{\"error\":0.03}", "", MEASURED, text);
    assert_true(coverage_run_and_read(text, NULL, read_others, answer));
    snprintf(fine, sizeof fine, "%s,\"levels\":[8,16,32],\"tolerance\":1e-6", MEASURED);
    coverage_write_study(&SCENE, COVERAGE_SEED, "\"realisations\":60", ",\"length_ratio\":64", fine,
                         text);
    assert_true(coverage_run_and_read(text, NULL, read_others, reference));
    for (size_t a = 0; a < OTHERS; a++) {
        double unit = strcmp(OTHER[a].quantity, "patch_mean_area") == 0 ? WAVES : 1;
        assert_int_equal(answer[a].count, 3);
        assert_int_equal(reference[a].count, 3);
        for (int k = 0; k < answer[a].count; k++)
            check_close(
                answer[a].y[k], unit * reference[a].y[k],
                hypot(coverage_told(&answer[a], k), unit * coverage_told(&reference[a], k)));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(profiles_are_within_the_error),
                                       cmocka_unit_test(profiles_of_full_are_within_the_error),
                                       cmocka_unit_test(surfaces_are_within_the_error),
                                       cmocka_unit_test(other_measures_are_within_what_is_told)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
