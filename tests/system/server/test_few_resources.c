/* Protects: a process that is given too little says so or gets along, and a terminal that closes
 * costs nothing that was computed. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include "tests/support/sql.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { END_S = 60 };

/* Many seconds of work. */
static const char LONG[] =
    "{\"name\":\"long\",\"kind\":\"statistics\",\"seed\":7,\"realisations\":1000000,\"surface\":{"
    "\"hurst\":0.5,\"wavelength_ratio\":8,\"length_ratio\":4,\"points_per_wavelength\":8}}";

static void few_files_are_refused_by_a_server(void **state) {
    (void)state;
    static const char *const LIMITS[] = {"16", "24", "40", "127"};
    for (size_t n = 0; n < sizeof LIMITS / sizeof *LIMITS; n++) {
        char line[200];
        snprintf(line, sizeof line, "ulimit -n %s; $RUGO serve --db few.db --listen 127.0.0.1:0",
                 LIMITS[n]);
        assert_int_equal(run_shell(line), 1);
        assert_true(contains("shell.err", "open files are too few for a server"));
    }
}

/* A soft limit of the stack is raised, a hard one named. */
static void a_small_stack_is_no_crash(void **state) {
    (void)state;
    spit("one.json", ONE_CASE);
    assert_int_equal(run_shell("ulimit -S -s 64; $RUGO run --db stack.db --workers 2 one.json"), 0);
    assert_int_equal(run_shell("ulimit -s 64; $RUGO run --db small.db --workers 2 one.json"), 1);
    assert_true(contains("shell.err", "ulimit -s"));
}

/* A file's length runs into its limit as the store is made, and again as it grows. */
static void a_limit_of_file_length_is_named(void **state) {
    (void)state;
    spit("one.json", ONE_CASE);
    assert_int_equal(run_shell("ulimit -f 4; $RUGO run --db short.db one.json"), 1);
    assert_true(contains("shell.err", "ulimit -f"));
    assert_int_equal(run_shell("ulimit -f 4; $RUGO serve --db low.db --listen 127.0.0.1:0"), 1);
    assert_true(contains("shell.err", "ulimit -f"));
}

/* A full disk may get room again, and is waited for; the limit of a process stays. */
static void a_limit_that_stays_ends_the_work(void **state) {
    (void)state;
    static const char WORDS[] = "grown.db cannot grow: this process may write files of up to";
    spit("blocks.json", SEVERAL_BLOCKS);
    assert_int_equal(run_shell("$RUGO submit --db grown.db blocks.json"), 0);
    assert_int_equal(
        run_shell("ulimit -f 800; timeout 60 $RUGO work --db grown.db --workers 2 --drain"), 1);
    assert_true(contains("shell.err", "rugo work: database") && contains("shell.err", WORDS));
    assert_int_equal(
        run_shell("ulimit -f 800; timeout 60 $RUGO run --db grown.db --workers 2 blocks.json"), 1);
    assert_true(contains("shell.err", "rugo run: database") && contains("shell.err", WORDS));
}

static void wait_for_result(const char *database) {
    for (int tries = 0;; tries++) {
        assert_true(tries < 1200);
        sleep_ms(50);
        if (access(database, R_OK) == 0 &&
            sql_integer(database, "SELECT count(*) FROM sqlite_schema WHERE name = 'job'") == 1 &&
            sql_integer(database, "SELECT count(*) FROM job WHERE state = 'running'") > 0)
            return;
    }
}

static void a_hangup_ends_like_a_stop(void **state) {
    (void)state;
    struct process process;
    spit("long.json", LONG);
    process_start(
        &process, "run",
        (const char *[]){"run", "--db", "hangup.db", "--workers", "2", "long.json", NULL});
    for (int command = 0; command < 2; command++) {
        wait_for_result("hangup.db");
        int64_t before = sql_integer("hangup.db", "SELECT count(*) FROM result");
        process_kill(&process, SIGHUP);
        assert_int_equal(process_wait(&process, END_S), command == 0 ? 130 : 0);
        assert_int_equal(
            sql_integer("hangup.db", "SELECT count(*) FROM job WHERE state = 'running'"), 0);
        assert_true(sql_integer("hangup.db", "SELECT count(*) FROM result") > before);
        if (command == 0)
            process_start(&process, "work",
                          (const char *[]){"work", "--db", "hangup.db", "--workers", "2", NULL});
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(few_files_are_refused_by_a_server),
                                       cmocka_unit_test(a_small_stack_is_no_crash),
                                       cmocka_unit_test(a_limit_of_file_length_is_named),
                                       cmocka_unit_test(a_limit_that_stays_ends_the_work),
                                       cmocka_unit_test(a_hangup_ends_like_a_stop)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
