/* Protects: what operators do to the files of a store. A copy laid over a killed store, a second
 * name of a store, a log that is gone or a database that was cut while a server runs: each is
 * refused or reported before anything is lost, in words that say what to do; a store that was
 * killed, and one behind a symbolic link, open as ever. */
#include "tests/support/check.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include "tests/support/store_files.h"
#include <signal.h>
#include <sqlite3.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define JSON "Content-Type: application/json\r\n"

static struct process server;
static unsigned port;

static void start(const char *database) {
    port = serve_start(&server, (const char *[]){"--db", database, NULL});
}

static void end(int signal_number) {
    process_kill(&server, signal_number);
    process_wait(&server, 20);
}

static int submit(void) {
    return http_exchange(port, "POST", "/v1/studies", JSON, ONE_CASE, NULL);
}

static int clear(void **state) {
    (void)state;
    remove_store("s.db");
    remove_store("t.db");
    remove("copy.db");
    return 0;
}

/* A server with one study in its snapshot and two more in its log is killed. */
static void kill_a_server_with_a_snapshot(void) {
    start("s.db");
    assert_int_equal(submit(), 201);
    assert_int_equal(run_shell("$RUGO snapshot --db s.db copy.db"), 0);
    assert_int_equal(submit(), 201);
    assert_int_equal(submit(), 201);
    end(SIGKILL);
}

static void a_copy_over_a_killed_store_is_refused(void **state) {
    (void)state;
    kill_a_server_with_a_snapshot();
    assert_int_equal(run_shell("cp s.db kept.db && cp copy.db s.db && cp s.db-wal kept.log"), 0);
    check_shell_refused("timeout 60 $RUGO serve --db s.db --listen 127.0.0.1:0",
                        "s.db-wal and -shm aside");
    check_shell_refused("$RUGO status --db s.db", "s.db-wal is the log of another file");
    check_shell_refused("$RUGO repair --db s.db", "Nothing was changed");
    assert_int_equal(run_shell("cmp s.db copy.db && cmp s.db-wal kept.log"), 0);
    /* the old file is back: nothing was lost */
    assert_int_equal(run_shell("cp s.db fresh.db && cp kept.db s.db"), 0);
    check_study_count("s.db", "3");
    assert_int_equal(run_shell("rm -f s.db*; cp fresh.db s.db"), 0);
    check_study_count("s.db", "1");
    /* a copy that was opened and killed has a log of its own; an empty one is of nobody */
    assert_int_equal(run_shell(": >s.db-wal"), 0);
    start("s.db");
    assert_int_equal(submit(), 201);
    end(SIGKILL);
    check_study_count("s.db", "2");
    unlink("kept.db");
    unlink("kept.log");
    unlink("fresh.db");
}

static void a_log_without_its_database_is_kept(void **state) {
    (void)state;
    kill_a_server_with_a_snapshot();
    assert_int_equal(run_shell("mv s.db t.db"), 0);
    check_shell_refused("timeout 60 $RUGO serve --db s.db --listen 127.0.0.1:0",
                        "there is no database s.db, but its log s.db-wal");
    assert_int_equal(run_shell(": >s.db"), 0);
    check_shell_refused("$RUGO submit --db s.db nothing.json || $RUGO repair --db s.db",
                        "is the log of another");
    assert_int_equal(run_shell("mv t.db s.db"), 0);
    check_study_count("s.db", "3");
}

static void a_store_of_two_names_is_refused(void **state) {
    (void)state;
    start("s.db");
    assert_int_equal(submit(), 201);
    end(SIGTERM);
    assert_int_equal(link("s.db", "t.db"), 0);
    check_shell_refused("$RUGO status --db s.db", "t.db, or copy it");
    check_shell_refused("timeout 60 $RUGO serve --db t.db --listen 127.0.0.1:0",
                        "s.db, or copy it");
    assert_int_equal(unlink("t.db"), 0);
    check_study_count("s.db", "1");
    /* a symbolic link leads to the same files */
    assert_int_equal(symlink("s.db", "t.db"), 0);
    start("t.db");
    assert_int_equal(submit(), 201);
    assert_int_equal(access("s.db-wal", F_OK), 0);
    assert_int_not_equal(access("t.db-wal", F_OK), 0);
    check_study_count("s.db", "2");
    end(SIGKILL);
    check_study_count("s.db", "2");
    check_study_count("t.db", "2");
}

static void check_failing(const char *words) {
    char *body = NULL;
    assert_int_equal(http_exchange(port, "GET", "/healthz", NULL, NULL, &body), 503);
    if (strstr(body, words) == NULL)
        fail_msg("no '%s' in %s", words, body);
    free(body);
}

/* What was acknowledged before is still in the server's hands, which writes it when it ends. */
static void a_log_that_is_gone_is_reported(void **state) {
    static const char *const GONE[] = {"s.db-wal", "s.db-shm"};
    (void)state;
    for (size_t g = 0; g < sizeof GONE / sizeof *GONE; g++) {
        remove_store("s.db");
        start("s.db");
        assert_int_equal(submit(), 201);
        assert_int_equal(unlink(GONE[g]), 0);
        assert_int_equal(submit(), 503);
        check_failing(GONE[g]);
        check_failing("end this program in order");
        assert_int_equal(http_exchange(port, "GET", "/v1/studies", NULL, NULL, NULL), 503);
        end(SIGTERM);
        check_study_count("s.db", "1");
    }
}

static void a_database_that_was_cut_is_reported(void **state) {
    static const long SIZES[] = {0, 4096, 65536};
    (void)state;
    for (size_t s = 0; s < sizeof SIZES / sizeof *SIZES; s++) {
        remove_store("s.db");
        start("s.db");
        end(SIGTERM); /* all is in the database now */
        start("s.db");
        check_study_count("s.db", "0");
        assert_int_equal(truncate("s.db", SIZES[s]), 0);
        check_failing("was cut to");
        assert_int_equal(submit(), 503);
        end(SIGKILL);
    }
}

/* --- messages, as somebody who may not write; root becomes nobody --- */

/* Runs the program in a folder that its user may not write. */
#define AS_NOBODY                                                                                  \
    "chmod 755 $d; cp s.db $d; cp $RUGO $d/rugo; chmod 644 $d/s.db; chmod 555 $d; "                \
    "as=; [ $(id -u) -ne 0 ] || as='setpriv --reuid=65534 --regid=65534 --clear-groups'; "         \
    "$as $d/rugo status --db $d/s.db; status=$?; chmod 755 $d; rm -r $d; exit $status"

static void kill_in_a_change(void) {
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        sqlite3 *db = NULL;
        sqlite3_open("s.db", &db);
        sqlite3_exec(db,
                     "PRAGMA journal_mode = DELETE; PRAGMA cache_size = 1; BEGIN; CREATE TABLE x "
                     "AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n LIMIT "
                     "2000) SELECT zeroblob(4000) FROM n",
                     NULL, NULL, NULL);
        raise(SIGKILL);
    }
    assert_int_equal(waitpid(child, NULL, 0), child);
}

static void readers_are_given_the_reason(void **state) {
    (void)state;
    start("s.db");
    end(SIGTERM);
    check_shell_refused("d=$(mktemp -d /tmp/rugo-closed-XXXXXX); " AS_NOBODY,
                        "-wal and -shm beside it");
    /* a change that was killed, in the mode of a snapshot and of rugo repair */
    kill_in_a_change();
    assert_int_equal(access("s.db-journal", F_OK), 0);
    check_shell_refused("$RUGO status --db s.db", "which has to be undone first from s.db-journal");
    assert_int_equal(run_shell("$RUGO repair --db s.db"), 0);
    check_study_count("s.db", "0");
    /* three repairs, mostly within a second, keep three copies */
    assert_int_equal(run_shell("$RUGO repair --db s.db && $RUGO repair --db s.db"), 0);
    assert_int_equal(run_shell("test $(ls s.db.before-repair-* | wc -l) = 3"), 0);
    assert_int_equal(run_shell("rm -f s.db.before-*"), 0);
}

/* Makes a folder for somebody who may write nothing of it but `own`; its name stands in
 * plain.folder. as_plain runs a command in it, without a home; root becomes nobody. */
static const char MAKE_PLAIN[] =
    "set -e; d=$(mktemp -d /tmp/rugo-plain-XXXXXX); echo $d >plain.folder; cp $RUGO $d/rugo\n"
    "cp one.json $d; mkdir $d/ro $d/closed $d/own; for f in ro/s.db ro/secret.db closed/s.db "
    "own/s.db; do cp s.db $d/$f; done; : >$d/own/s.db-wal; chmod 444 $d/one.json $d/ro/s.db; "
    "chmod 666 $d/own/s.db; chmod 0 $d/own/s.db-wal $d/ro/secret.db $d/closed; chmod 777 $d/own; "
    "chmod 755 $d; chmod 555 $d/ro\n";
static const char AS_PLAIN[] =
    "cd $(cat plain.folder); as=\n"
    "[ $(id -u) -ne 0 ] || as='setpriv --reuid=65534 --regid=65534 --clear-groups'\n"
    "env -u HOME $as ./rugo $*\n";

/* SQLite says "unable to open database file" of all of them. */
static void who_may_not_is_given_the_reason(void **state) {
    (void)state;
    static const struct {
        const char *command, *words;
    } REFUSED[] = {
        {"submit --db none/s.db one.json", "database none/s.db: there is no folder none/"},
        {"submit --db ro/new.db one.json", "may not make files in folder ro/, which belongs to"},
        {"submit --db ro/s.db one.json", "database ro/s.db: user "},
        {"submit --db ro/s.db one.json", " may not write ro/s.db, which belongs to user "},
        {"status --db ro/secret.db", " may not read ro/secret.db, which belongs to user "},
        {"status --db closed/s.db", " cannot enter folder closed/: Permission denied"},
        {"work --db closed/s.db", " cannot enter folder closed/: Permission denied"},
        {"submit --db own/s.db one.json", " may not write own/s.db-wal, which belongs to user "},
        {"run --db own/new.db one.json --out ro/out", "cannot make folder ro/out: Permission"},
    };
    start("s.db");
    end(SIGTERM);
    spit("one.json", ONE_CASE);
    spit("make_plain", MAKE_PLAIN);
    spit("as_plain", AS_PLAIN);
    check_shell("sh ./make_plain");
    for (size_t r = 0; r < sizeof REFUSED / sizeof *REFUSED; r++) {
        char line[100];
        snprintf(line, sizeof line, "sh ./as_plain %s", REFUSED[r].command);
        check_shell_refused(line, REFUSED[r].words);
    }
    check_shell(
        "d=$(cat plain.folder); chmod -R u+rwx $d; rm -r $d plain.folder make_plain as_plain");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_copy_over_a_killed_store_is_refused, clear),
        cmocka_unit_test_setup(a_log_without_its_database_is_kept, clear),
        cmocka_unit_test_setup(a_store_of_two_names_is_refused, clear),
        cmocka_unit_test_setup(a_log_that_is_gone_is_reported, clear),
        cmocka_unit_test_setup(a_database_that_was_cut_is_reported, clear),
        cmocka_unit_test_setup_teardown(readers_are_given_the_reason, clear, clear),
        cmocka_unit_test_setup_teardown(who_may_not_is_given_the_reason, clear, clear),
    };
    return cmocka_run_group_tests(tests, NULL, clear);
}
