/* Protects: no command overwrites the results of one study with those of another, unless it is
 * asked to; and then no picture of the older one stays beside them. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define PRESSED                                                                                    \
    "{\"name\":\"pressed\",\"kind\":\"contact\",\"seed\":1,\"realisations\":2,\"surface\":{"       \
    "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":4,"                     \
    "\"points_per_wavelength\":8},\"contact\":{\"model\":\"halfspace\",\"levels\":[8],"            \
    "\"pressures\":{\"values\":[0.1]}}}"

static int run(const char *name, const char *file, const char *store, const char *more) {
    return run_rugo(name, (const char *[]){"run", file, "--db", store, "--out", "results",
                                           "--workers", "1", more, NULL});
}

static int start(void **state) {
    (void)state;
    spit("one.json", ONE_CASE);
    spit("pressed.json", PRESSED);
    return run("first", "one.json", "a.db", NULL);
}

static void another_study_is_refused(void **state) {
    (void)state;
    assert_int_equal(run("other", "pressed.json", "a.db", NULL), 2);
    assert_true(
        contains("other.err", "folder results holds the results of another study, \"one\""));
    assert_true(contains("other.err", "--replace"));
    assert_true(contains("results/study.json", "statistics"));
    assert_int_equal(run_rugo("list", (const char *[]){"status", "--db", "a.db", NULL}), 0);
    assert_false(contains("list.out", "pressed")); /* nothing was queued */
    assert_int_equal(
        run_rugo("theory", (const char *[]){"theory", "one.json", "--out", "results", NULL}), 2);
}

/* Also where the store is another, in which the study has another id. */
static void the_same_study_goes_there_again(void **state) {
    (void)state;
    assert_int_equal(run("again", "one.json", "a.db", NULL), 0);
    assert_int_equal(run("elsewhere", "one.json", "b.db", NULL), 0);
    assert_int_equal(run_rugo("curves", (const char *[]){"curves", "--db", "a.db", "one", "--out",
                                                         "results", NULL}),
                     0);
}

static void what_is_replaced_goes(void **state) {
    (void)state;
    spit("results/mine.svg", "<svg/>");
    assert_int_equal(access("results/psd.svg", F_OK), 0);
    assert_int_equal(run("replaced", "pressed.json", "a.db", "--replace"), 0);
    assert_int_not_equal(access("results/psd.svg", F_OK), 0);
    assert_int_equal(access("results/contact_area.svg", F_OK), 0);
    assert_int_equal(access("results/mine.svg", F_OK), 0);
    assert_true(contains("results/study.json", "pressed"));
    assert_int_equal(run("back", "one.json", "a.db", NULL), 2);
    assert_true(contains("back.err", "\"pressed\""));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(another_study_is_refused),
        cmocka_unit_test(the_same_study_goes_there_again),
        cmocka_unit_test(what_is_replaced_goes),
    };
    return cmocka_run_group_tests(tests, start, NULL);
}
