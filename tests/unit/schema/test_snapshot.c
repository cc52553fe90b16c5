/* Protects: a snapshot is the store of one moment, whole, and under its name only then; it ends
 * though others write all the while; what ends it before, a full disk, a stop or a kill, leaves
 * nothing, or something that the next one takes away; no file that was there is touched. */
#include "core/file/part_file.h"
#include "schema/store/store.h"
#include "tests/support/check.h"
#include "tests/support/count_files.h"
#include "tests/support/sql.h"
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

enum { BLOBS = 100 };

/* A store of 10 MB, so that a copy takes several steps. `a` and `b` are equal at every moment. */
static int prepare(void **state) {
    struct store *store = NULL;
    (void)state;
    assert_int_equal(store_open(&store, "store.db", NULL, NULL), 0);
    store_close(&store);
    sqlite3 *db = sql_open("store.db");
    sql_run(db, "CREATE TABLE blobs (id INTEGER PRIMARY KEY, blob BLOB);"
                "CREATE TABLE pair (a INTEGER, b INTEGER); INSERT INTO pair VALUES (0, 0)");
    for (int n = 0; n < BLOBS; n++)
        sql_run(db, "INSERT INTO blobs (blob) VALUES (randomblob(100000))");
    sqlite3_close(db);
    assert_int_equal(
        store_open(&store, "store.db", &(struct store_options){.read_only = true}, NULL), 0);
    *state = store;
    return 0;
}

static int end(void **state) {
    struct store *store = *state;
    store_close(&store);
    unlink("store.db");
    unlink("store.db-wal");
    unlink("store.db-shm");
    return 0;
}

static void check_copy(const char *path) {
    assert_int_equal(sql_integer(path, "SELECT count(*) FROM pragma_integrity_check "
                                       "WHERE integrity_check = 'ok'"),
                     1);
    assert_int_equal(sql_integer(path, "SELECT count(*) FROM blobs"), BLOBS);
    assert_int_equal(sql_integer(path, "SELECT a = b FROM pair"), 1);
}

struct changes {
    atomic_bool ending;
    atomic_int made;
};

static void *change_on(void *context) {
    struct changes *changes = context;
    sqlite3 *db = sql_open("store.db");
    while (!atomic_load(&changes->ending)) {
        sql_run(db, "UPDATE pair SET a = a + 1, b = b + 1");
        atomic_fetch_add(&changes->made, 1);
    }
    sqlite3_close(db);
    return NULL;
}

struct asking {
    struct changes *changes;
    int asked;
};

/* Between two steps comes a change at least, however late the thread of the changes is. */
static bool count_asked(void *context) {
    struct asking *asking = context;
    int before = atomic_load(&asking->changes->made);
    asking->asked++;
    for (int tries = 0; atomic_load(&asking->changes->made) == before; tries++) {
        assert_true(tries < 60000);
        usleep(1000);
    }
    return false;
}

static void copies_one_moment(void **state) {
    struct changes changes = {0};
    struct error err = {0};
    pthread_t thread;
    struct asking asking = {.changes = &changes};
    assert_int_equal(pthread_create(&thread, NULL, change_on, &changes), 0);
    while (atomic_load(&changes.made) == 0)
        sched_yield();
    int before = atomic_load(&changes.made);
    if (store_snapshot(*state, "copy.db", count_asked, &asking, &err) != 0)
        fail_msg("%s", err.text);
    int during = atomic_load(&changes.made) - before;
    atomic_store(&changes.ending, true);
    pthread_join(thread, NULL);
    /* Each change would begin a copy anew that does not hold its moment: of 3 steps and more, with
     * changes between them, none would end in as many questions as it has steps. */
    assert_in_range(asking.asked, 3, 4);
    assert_true(during > 0);
    check_copy("copy.db");
    assert_int_equal(count_files("copy.db?*"), 0);
    /* and it can be read where nothing can be written beside it */
    assert_int_equal(sql_integer("copy.db", "SELECT journal_mode = 'delete' "
                                            "FROM pragma_journal_mode"),
                     1);
    unlink("copy.db");
}

static void keeps_what_is_there(void **state) {
    struct error err = {0};
    FILE *file = fopen("copy.db", "w");
    assert_non_null(file);
    fputs("mine", file);
    fclose(file);
    assert_int_equal(store_snapshot(*state, "copy.db", NULL, NULL, &err), ERROR_INPUT);
    assert_non_null(strstr(err.text, "copy.db exists; a new file is needed"));
    /* and what comes while it is made */
    struct part_file part;
    assert_int_equal(part_file_create(&part, "late.db", &err), 0);
    assert_int_equal(rename("copy.db", "late.db"), 0);
    assert_int_equal(part_file_publish(&part, &err), ERROR_INPUT);
    struct stat info;
    assert_int_equal(stat("late.db", &info), 0);
    assert_int_equal(info.st_size, 4);
    assert_int_equal(count_files("late.db?*"), 0);
    unlink("late.db");
}

static void full_disk_leaves_nothing(void **state) {
    struct error err = {0};
    struct rlimit before, low;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    low = before;
    low.rlim_cur = 6000000;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &low), 0);
    int status = store_snapshot(*state, "copy.db", NULL, NULL, &err);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(status, ERROR_LIMIT);
    assert_non_null(strstr(err.text, "copy.db"));
    assert_int_equal(count_files("copy.db*"), 0);
    assert_int_equal(store_snapshot(*state, "copy.db", NULL, NULL, NULL), 0);
    check_copy("copy.db");
    unlink("copy.db");
    assert_int_equal(store_snapshot(*state, "no/folder.db", NULL, NULL, &err), ERROR_SYSTEM);
    assert_non_null(strstr(err.text, "no/folder.db"));
}

static bool stop_at_third(void *context) {
    int *asked = context;
    return ++*asked == 3;
}

static void stops_when_asked(void **state) {
    int asked = 0;
    struct error err = {0};
    if (store_snapshot(*state, "copy.db", stop_at_third, &asked, &err) != ERROR_STOPPED)
        fail_msg("%s", err.text);
    assert_int_equal(asked, 3);
    assert_int_equal(count_files("copy.db*"), 0);
    assert_int_equal(store_snapshot(*state, "copy.db", NULL, NULL, NULL),
                     0); /* the handle goes on */
    unlink("copy.db");
}

/* What nobody holds was left by the dead; what someone holds, and what is only named like it,
 * stays. */
static void takes_away_what_was_left(void **state) {
    static const char *const FILES[] = {"[a]*.db.part-00000f", "[a]*.db.part-mine",
                                        "a.db.part-00000f"};
    struct part_file held;
    for (size_t f = 0; f < sizeof FILES / sizeof *FILES; f++) {
        FILE *file = fopen(FILES[f], "w");
        assert_non_null(file);
        fclose(file);
    }
    assert_int_equal(part_file_create(&held, "[a]*.db", NULL), 0);
    assert_int_equal(access(held.path, F_OK), 0);
    assert_int_not_equal(access(FILES[0], F_OK), 0);
    assert_int_equal(store_snapshot(*state, "[a]*.db", NULL, NULL, NULL), 0);
    assert_int_equal(access(held.path, F_OK), 0);
    part_file_destroy(&held);
    assert_int_equal(access(FILES[1], F_OK), 0);
    assert_int_equal(access(FILES[2], F_OK), 0);
    assert_int_equal(count_files("*.part-*"), 2);
    check_copy("[a]*.db");
    unlink(FILES[1]);
    unlink(FILES[2]);
    unlink("[a]*.db");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(copies_one_moment),        cmocka_unit_test(keeps_what_is_there),
        cmocka_unit_test(full_disk_leaves_nothing), cmocka_unit_test(stops_when_asked),
        cmocka_unit_test(takes_away_what_was_left),
    };
    return cmocka_run_group_tests(tests, prepare, end);
}
