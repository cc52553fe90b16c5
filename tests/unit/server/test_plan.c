/* Between what seconds a study may take, where some of its realisations take far longer. */
#include "server/show/summary/plan.h"
#include "tests/support/check.h"
#include <math.h>

/* Of 2 s a realisation, `rare` are what only some take: one in so many. */
static struct study_case jumping(uint64_t realisations, double rare, double one_in) {
    return (struct study_case){.realisations = realisations,
                               .cost = {.seconds = 2,
                                        .rare_seconds = rare,
                                        .rare_variance = 2 * rare * rare * one_in,
                                        .rare_most = INFINITY}};
}

/* Seconds that are known have no range, nor those of which little is rare. */
static void what_is_known_has_no_range(void **state) {
    (void)state;
    struct study_case one = jumping(20, 0, 1);
    const struct study study = {.case_count = 1, .cases = &one};
    assert_true(plan_seconds(&study) == 40);
    assert_true(isnan(plan_range(&study).least) && isnan(plan_range(&study).most));
    one = jumping(20, 0.02, 2);
    assert_true(isnan(plan_range(&study).most));
}

/* The range holds what is expected, and from what is taken without jumps on. More realisations
 * narrow it, but not below what is unknown of their mean. */
static void more_realisations_narrow_the_range(void **state) {
    (void)state;
    double wide = INFINITY;
    for (uint64_t realisations = 1; realisations <= 1000000; realisations *= 10) {
        const struct study_case one = jumping(realisations, 1.5, 4);
        const struct plan_range range = plan_case_range(&one);
        const double seconds = plan_case_seconds(&one), times = range.most / range.least;
        assert_true(range.least > 0.1 * seconds && range.least < seconds);
        assert_true(seconds < range.most && times <= wide);
        wide = times;
    }
    assert_true(wide > 2 && wide < 5);
}

/* Times are drawn as they are assumed: Poisson numbers of jumps, each with an exponential time. One
 * in eight at most is outside of the range, which is to hold nine of ten. */
static void the_range_covers_what_is_drawn(void **state) {
    (void)state;
    enum { STUDIES = 4000 };
    for (uint64_t realisations = 2; realisations <= 32; realisations *= 4) {
        const double one_in = 3, rare = 1.5;
        const struct study_case one = jumping(realisations, rare, one_in);
        const struct plan_range range = plan_case_range(&one);
        uint64_t seed = 20261129;
        size_t outside = 0;
        for (size_t s = 0; s < STUDIES; s++) {
            double seconds = (2 - rare) * (double)realisations;
            for (double passed = 0;;) { /* between jumps */
                double drawn[2];
                for (size_t d = 0; d < 2; d++) {
                    seed = seed * 6364136223846793005U + 1442695040888963407U;
                    drawn[d] = -log(((double)(seed >> 11) + 0.5) / 0x1p53);
                }
                passed += drawn[0] * one_in;
                if (passed > (double)realisations)
                    break;
                seconds += drawn[1] * rare * one_in;
            }
            outside += seconds < range.least || seconds > range.most;
        }
        if (outside > STUDIES / 8)
            fail_msg(
                "seed 20261129, %llu realisations: %zu of %d studies are outside of %g to %g s",
                (unsigned long long)realisations, outside, STUDIES, range.least, range.most);
    }
}

/* A study has the range of all its cases: one that jumps makes it wider by its share alone. */
static void cases_are_added_up(void **state) {
    (void)state;
    struct study_case cases[] = {jumping(5, 1.9, 3), jumping(5, 0, 1)};
    const struct study study = {.case_count = 2, .cases = cases};
    const struct plan_range one = plan_case_range(cases), all = plan_range(&study);
    assert_true(isnan(plan_case_range(&cases[1]).most));
    assert_true(all.least < plan_seconds(&study) && plan_seconds(&study) < all.most);
    assert_true(all.most / plan_seconds(&study) < one.most / plan_case_seconds(cases));
}

/* Where a limit bounds what some take, the range ends there, and holds what is expected. */
static void a_limit_ends_the_range(void **state) {
    (void)state;
    for (double rare = 0.5; rare <= 1.5; rare += 0.25) {
        struct study_case one = jumping(3, rare, 4);
        const struct plan_range free = plan_case_range(&one);
        one.cost.rare_most = 1.5;
        one.cost.rare_variance = 1.5 * 1.5 / 4;
        const struct plan_range bound = plan_case_range(&one);
        assert_true(bound.most < free.most && bound.most <= 3 * (1.5 * (2 - rare) + 1.5));
        assert_true(bound.least < 3 * 2 && 3 * 2 < bound.most);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_known_has_no_range),
        cmocka_unit_test(more_realisations_narrow_the_range),
        cmocka_unit_test(the_range_covers_what_is_drawn),
        cmocka_unit_test(cases_are_added_up),
        cmocka_unit_test(a_limit_ends_the_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
