/* Protects: no command overwrites the results of one study with those of another, unless it is
 * asked to; and then nothing of the older one stays beside them, and all that is somebody's own
 * does. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#define PRESSED                                                                                    \
    "{\"name\":\"pressed\",\"kind\":\"contact\",\"seed\":1,\"realisations\":2,\"surface\":{"       \
    "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":4,"                     \
    "\"points_per_wavelength\":8},\"contact\":{\"model\":\"halfspace\",\"levels\":[8],"            \
    "\"pressures\":{\"values\":[0.1]}}}"
#define KEPT                                                                                       \
    "{\"name\":\"kept\",\"kind\":\"contact\",\"seed\":1,\"realisations\":2,\"surface\":{"          \
    "\"dimension\":1,\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":4,"                     \
    "\"points_per_wavelength\":8},\"contact\":{\"model\":\"halfspace\",\"levels\":[8],"            \
    "\"pressures\":{\"values\":[0.1]},\"keep\":{\"realisations\":[1]}}}"

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

static const char *const EXPORTED[] = {"README.txt", "provenance.json", "scalars.csv", "table.csv",
                                       "report.txt", "report.json",     "report.svg"};
enum { EXPORTED_COUNT = sizeof EXPORTED / sizeof *EXPORTED };

static bool is_there(const char *folder, const char *name) {
    char path[200];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return access(path, F_OK) == 0;
}

/* Nodes under the new study would be taken for its own, and so would tables and the report. */
static void nodes_and_exports_go_with_their_study(void **state) {
    (void)state;
    spit("kept.json", KEPT);
    assert_int_equal(run_rugo("kept", (const char *[]){"run", "kept.json", "--db", "a.db", "--out",
                                                       "kout", "--workers", "1", NULL}),
                     0);
    assert_int_equal(run_rugo("export", (const char *[]){"export", "--db", "a.db", "kept", "--out",
                                                         "kout", NULL}),
                     0);
    for (size_t n = 0; n < EXPORTED_COUNT; n++)
        assert_true(is_there("kout", EXPORTED[n]));
    assert_true(is_there("kout", "nodes/case-0/realisation-1/halfspace/step-1.vtu"));
    assert_int_equal(run_rugo("over", (const char *[]){"curves", "--db", "a.db", "one", "--out",
                                                       "kout", "--replace", NULL}),
                     0);
    for (size_t n = 0; n < EXPORTED_COUNT; n++)
        assert_false(is_there("kout", EXPORTED[n]));
    assert_false(is_there("kout", "nodes"));
    assert_false(is_there("kout", "contact_area.svg"));
    assert_true(is_there("kout", "psd.svg"));
}

static void what_is_somebodys_own_stays(void **state) {
    (void)state;
    assert_int_equal(run_rugo("kept", (const char *[]){"run", "kept.json", "--db", "a.db", "--out",
                                                       "own", "--workers", "1", NULL}),
                     0);
    spit("own/README.txt", "my notes\n");
    spit("own/table.csv", "a,b\n1,2\n");
    spit("own/nodes/case-0/realisation-1/halfspace/notes.txt", "mine\n");
    assert_int_equal(mkdir("own/nodes/case-of-mine", 0700), 0);
    spit("own/nodes/case-of-mine/nodes.csv", "x\n");
    assert_int_equal(run_rugo("over", (const char *[]){"curves", "--db", "a.db", "one", "--out",
                                                       "own", "--replace", NULL}),
                     0);
    assert_true(is_there("own", "README.txt"));
    assert_true(is_there("own", "table.csv"));
    assert_true(is_there("own", "nodes/case-0/realisation-1/halfspace/notes.txt"));
    assert_true(is_there("own", "nodes/case-of-mine/nodes.csv"));
    assert_false(is_there("own", "nodes/case-0/realisation-1/halfspace/nodes.csv"));
    assert_false(is_there("own", "nodes/case-0/realisation-1/halfspace/step-1.vtu"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(another_study_is_refused),
        cmocka_unit_test(the_same_study_goes_there_again),
        cmocka_unit_test(what_is_replaced_goes),
        cmocka_unit_test(nodes_and_exports_go_with_their_study),
        cmocka_unit_test(what_is_somebodys_own_stays),
    };
    return cmocka_run_group_tests(tests, start, NULL);
}
