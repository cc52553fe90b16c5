/* Protects: backups and what is restored from them. Snapshots in a folder are verified, and only
 * old ones of the same store go. A restore refuses what is in use or not whole, keeps what was
 * there, says which studies the backup lacks, and wherever it was killed the next one ends it. */
#include "tests/support/check.h"
#include "tests/support/count_files.h"
#include "tests/support/process.h"
#include "tests/support/small_studies.h"
#include "tests/support/sql.h"
#include "tests/support/store_files.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct process server;
static unsigned port;

static void start(void) {
    port = serve_start(&server, (const char *[]){"--db", "s.db", NULL});
}

static void end(int signal_number) {
    process_kill(&server, signal_number);
    process_wait(&server, 20);
}

static void submit(void) {
    assert_int_equal(http_exchange(port, "POST", "/v1/studies",
                                   "Content-Type: application/json\r\n", ONE_CASE, NULL),
                     201);
}

static int clear(void **state) {
    (void)state;
    remove_store("s.db");
    return run_shell("rm -rf copy.db* s.db.before-restore-* n.db* f link.db");
}

/* One study in the backup, two more in the log of a server that was killed. */
static void kill_a_server_after_a_backup(void) {
    start();
    submit();
    check_shell("$RUGO snapshot --db s.db copy.db");
    submit();
    submit();
    check_shell_refused("$RUGO restore copy.db --db s.db", "rugo: end it first");
    check_shell("$RUGO restore copy.db --db s.db --dry-run");
    end(SIGKILL);
}

static void a_backup_becomes_the_store(void **state) {
    (void)state;
    kill_a_server_after_a_backup();
    assert_int_equal(chmod("s.db", 0640), 0);
    check_shell("$RUGO restore -n copy.db --db s.db >lacks");
    check_study_count("s.db", "3");
    assert_int_equal(count_files("s.db.before-restore-*"), 0);
    check_shell("$RUGO restore copy.db --db s.db >lacks");
    check_shell("test $(grep -c '^[0-9a-f]\\{16\\}  20' lacks) = 2");
    check_study_count("s.db", "1");
    struct stat info;
    assert_int_equal(stat("s.db", &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
    start();
    submit();
    end(SIGTERM);
    check_study_count("s.db", "2");
    /* and back: nothing of the old store is lost */
    check_shell("rm -f s.db s.db-wal s.db-shm && mv s.db.before-restore-*/s.db* .");
    check_study_count("s.db", "3");
    assert_int_equal(count_files("s.db*part*"), 0);
}

static void a_new_machine_gets_the_store(void **state) {
    (void)state;
    kill_a_server_after_a_backup();
    check_shell("$RUGO restore copy.db --db n.db >lacks && ! grep -q lacks lacks");
    check_study_count("n.db", "1");
    assert_int_equal(count_files("n.db.before-restore-*"), 0);
    check_shell("ln -s s.db link.db && $RUGO restore copy.db --db link.db && test -L link.db");
    check_study_count("s.db", "1");
}

static void what_is_no_whole_backup_is_refused(void **state) {
    static const struct {
        const char *line, *words;
    } CASES[] = {
        {"$RUGO restore s.db --db s.db", "is the database s.db itself"},
        {"cp s.db n.db; cp s.db-wal n.db-wal; $RUGO restore n.db --db s.db", "has a log beside it"},
        {"rm n.db*; head -c 9000 copy.db >n.db; $RUGO restore n.db --db s.db", "it is not whole"},
        {"echo '{}' >n.db; $RUGO restore n.db --db s.db", "no database"},
        {"$RUGO restore f --db s.db", "backup f: No such file"},
        {"mkdir f; $RUGO restore f --db s.db", "is not a file"},
    };
    (void)state;
    kill_a_server_after_a_backup();
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++)
        check_shell_refused(CASES[c].line, CASES[c].words);
    check_shell("cp copy.db n.db");
    sql_change("n.db", "UPDATE study_case SET seal = 0");
    check_shell_refused("$RUGO restore n.db --db s.db", "is not whole, and was not restored");
    check_shell_refused("ulimit -f 100; $RUGO restore copy.db --db s.db", "File too large");
    check_study_count("s.db", "3");
    assert_int_equal(count_files("s.db.before-restore-*"), 0);
}

/* The states that a kill leaves, made by hand: a half copy, and logs that were still to be moved.
 */
static void a_killed_restore_is_ended(void **state) {
    (void)state;
    kill_a_server_after_a_backup();
    check_shell("mkdir s.db.before-restore-20200101T000000Z && "
                "cp copy.db s.db.before-restore-20200101T000000Z/s.db.part-0a1b2c");
    check_shell("$RUGO restore copy.db --db s.db");
    assert_int_equal(count_files("s.db.before-restore-2020*"), 0);
    assert_int_equal(count_files("s.db.before-restore-*"), 1);
    check_shell("mv s.db.before-restore-*/s.db-wal . && mv s.db.before-restore-* f && "
                "mv f s.db.before-restore-20210101T000000Z");
    check_shell_refused("$RUGO status --db s.db", "is the log of another file");
    check_shell("$RUGO restore copy.db --db s.db");
    check_study_count("s.db", "1");
    check_study_count("s.db.before-restore-2021*/s.db", "3");
}

static void damaged_stores_are_replaced_too(void **state) {
    (void)state;
    kill_a_server_after_a_backup();
    check_shell("head -c 20000 /dev/urandom >s.db");
    check_shell("$RUGO restore copy.db --db s.db >lacks && grep -q 'is not known' lacks");
    check_study_count("s.db", "1");
}

static void a_folder_keeps_the_newest(void **state) {
    (void)state;
    start();
    submit();
    check_shell("mkdir f && cd f && touch s-mine.db t-20200101T000000Z.db s-20200101T000000Z.db "
                "s-20200101T000000Z-2.db s-20210101T000000Z.db s-20210101T000000Z.db.gz "
                "s-20220101T000000Z.db.unverified");
    check_shell("$RUGO snapshot --db s.db f/ --keep 3 | grep whole");
    assert_int_equal(count_files("f/s-202?0101*.db"), 2);
    check_shell("$RUGO snapshot --db s.db f --keep 1");
    assert_int_equal(count_files("f/s-2*.db"), 1);
    assert_int_equal(count_files("f/*"), 4); /* three are no snapshots of this store */
    check_shell("$RUGO restore --dry-run f/s-2*Z*.db --db s.db");
    check_shell_refused("$RUGO snapshot --db s.db copy.db --keep 2", "--keep is for a folder");
    /* one that cannot be removed is reported, and older ones go all the same */
    check_shell("mkdir f/s-20210101T000000Z.db && touch f/s-20200101T000000Z.db");
    check_shell_refused("$RUGO snapshot --db s.db f --keep 1",
                        "the older snapshot f/s-20210101T000000Z.db is not removed");
    assert_int_equal(count_files("f/s-2*.db"), 2);
    check_shell("rmdir f/s-20210101T000000Z.db");
    end(SIGTERM);
    /* a store with a flaw makes no snapshot, and takes none */
    sql_change("s.db", "UPDATE study_case SET seal = 0");
    check_shell_refused("$RUGO snapshot --db s.db f --keep 1", "has flaws");
    assert_int_equal(count_files("f/s-2*.db"), 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_backup_becomes_the_store, clear),
        cmocka_unit_test_setup(a_new_machine_gets_the_store, clear),
        cmocka_unit_test_setup(what_is_no_whole_backup_is_refused, clear),
        cmocka_unit_test_setup(a_killed_restore_is_ended, clear),
        cmocka_unit_test_setup(damaged_stores_are_replaced_too, clear),
        cmocka_unit_test_setup(a_folder_keeps_the_newest, clear),
    };
    return cmocka_run_group_tests(tests, NULL, clear);
}
