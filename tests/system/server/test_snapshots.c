/* Protects: a snapshot that is killed at any moment, and a server that is killed while it makes
 * one, leave no file that looks whole and is not, and nothing at all after the next; a disk that is
 * full is reported. */
#include "tests/support/check.h"
#include "tests/support/count_files.h"
#include "tests/support/process.h"
#include "tests/support/seed.h"
#include "tests/support/sql.h"
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum { KILLS = 16, MEGABYTES = 60 };

static const char STUDY[] =
    "{\"name\":\"kept\",\"kind\":\"statistics\",\"seed\":1,\"realisations\":10,\"surface\":{"
    "\"hurst\":0.8,\"wavelength_ratio\":4,\"length_ratio\":4,\"points_per_wavelength\":4}}";

/* A store with results, and so large that copying it takes a while. */
static int prepare(void **state) {
    sqlite3 *db = NULL;
    (void)state;
    spit("kept.json", STUDY);
    assert_int_equal(run_rugo("run", (const char *[]){"run", "--db", "kept.db", "kept.json", NULL}),
                     0);
    assert_int_equal(sqlite3_open("kept.db", &db), SQLITE_OK);
    sql_run(db, "CREATE TABLE ballast (bytes BLOB); BEGIN");
    for (int n = 0; n < MEGABYTES; n++)
        sql_run(db, "INSERT INTO ballast VALUES (zeroblob(1000000))");
    sql_run(db, "COMMIT");
    sqlite3_close(db);
    return 0;
}

static bool is_whole(const char *path) {
    sqlite3 *db = NULL;
    sqlite3_stmt *row = NULL;
    assert_int_equal(sqlite3_open_v2(path, &db, SQLITE_OPEN_READONLY, NULL), SQLITE_OK);
    bool whole =
        sqlite3_prepare_v2(db,
                           "SELECT (SELECT integrity_check = 'ok' FROM pragma_integrity_check) AND "
                           "(SELECT count(*) = 60 FROM ballast) AND "
                           "(SELECT state = 'done' FROM study_progress WHERE name = 'kept')",
                           -1, &row, NULL) == SQLITE_OK &&
        sqlite3_step(row) == SQLITE_ROW && sqlite3_column_int(row, 0) == 1;
    sqlite3_finalize(row);
    sqlite3_close(db);
    return whole;
}

static void killed_snapshots_leave_no_half(void **state) {
    static const char *const SNAPSHOT[] = {"snapshot", "--db", "kept.db", "copy.db", NULL};
    (void)state;
    uint64_t seed = seed_of_now();
    size_t cut = 0, left = 0;
    int kills = 0;
    /* from the start of the program to beyond the end of the copy; at least once in between */
    for (; kills < KILLS || (left == 0 && kills < 10 * KILLS); kills++) {
        struct process process;
        process_start(&process, "snapshot", SNAPSHOT);
        if (left == 0)
            process_wait_for_file(&process, "copy.db.part-*");
        else
            usleep((useconds_t)(next_word(&seed) % 120000));
        process_kill(&process, SIGKILL);
        cut += process_wait(&process, 20) != 0;
        left += count_files("copy.db.part-*") > 0;
        if (access("copy.db", F_OK) == 0) {
            assert_true(is_whole("copy.db"));
            unlink("copy.db");
        }
    }
    print_message("%zu of %d were killed before their end, %zu in the midst of it\n", cut, kills,
                  left);
    assert_true(left > 0);
    assert_int_equal(run_rugo("snapshot", SNAPSHOT), 0);
    assert_true(is_whole("copy.db"));
    assert_int_equal(count_files("copy.db?*"), 0);
    unlink("copy.db");
}

/* Ctrl-C in the midst leaves nothing. */
static void stopped_snapshot_leaves_nothing(void **state) {
    struct process process;
    (void)state;
    process_start(&process, "stop",
                  (const char *[]){"snapshot", "--db", "kept.db", "copy.db", NULL});
    process_wait_for_file(&process, "copy.db.part-*");
    process_kill(&process, SIGINT);
    int status = process_wait(&process, 20);
    assert_true(status == 0 || status == 130);
    assert_int_equal(count_files("copy.db?*"), 0);
    assert_int_equal(count_files("copy.db"), status == 0);
    unlink("copy.db");
}

static void restarted_server_clears_up(void **state) {
    static const char *const PLACE[] = {"--db", "kept.db", NULL};
    struct process server;
    (void)state;
    size_t left = 0;
    for (int n = 0; n < 20 && left == 0; n++) {
        int connection = http_connect(serve_start(&server, PLACE));
        static const char REQUEST[] = "GET /v1/snapshot HTTP/1.1\r\nHost: localhost\r\n\r\n";
        assert_int_equal(write(connection, REQUEST, sizeof REQUEST - 1), sizeof REQUEST - 1);
        /* seldom, the copy is done before it is seen */
        for (int tries = 0; tries < 20000 && count_files("kept.db.snapshot.part-*") == 0; tries++)
            usleep(500);
        process_kill(&server, SIGKILL);
        assert_int_equal(process_wait(&server, 20), 128 + SIGKILL);
        close(connection);
        left = count_files("kept.db.snapshot*");
    }
    assert_true(left > 0);
    /* as programs before named them: of a process that is gone, and of one that is not */
    spit("kept.db.snapshot-999999999-0x7f", "");
    char living[64];
    snprintf(living, sizeof living, "kept.db.snapshot-%d-0x7f", (int)getpid());
    spit(living, "");
    serve_start(&server, PLACE);
    assert_int_equal(count_files("kept.db.snapshot*"), 1);
    assert_int_equal(count_files(living), 1);
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
    unlink(living);
}

static void full_disk_is_told(void **state) {
    struct process server;
    struct rlimit before, low;
    char url[64];
    (void)state;
    snprintf(url, sizeof url, "http://127.0.0.1:%u",
             serve_start(&server, (const char *[]){"--db", "kept.db", NULL}));
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    low = before;
    low.rlim_cur = 20 << 20;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &low), 0);
    int local = run_rugo("local", (const char *[]){"snapshot", "--db", "kept.db", "copy.db", NULL});
    int remote = run_rugo("remote", (const char *[]){"snapshot", "--server", url, "copy.db", NULL});
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(local, 1);
    assert_true(contains("local.err", "copy.db"));
    assert_int_equal(remote, 1);
    assert_true(contains("remote.err", "rugo snapshot: "));
    assert_int_equal(count_files("copy.db*"), 0);
    assert_int_equal(
        run_rugo("remote", (const char *[]){"snapshot", "--server", url, "copy.db", NULL}), 0);
    assert_true(is_whole("copy.db"));
    assert_int_equal(count_files("copy.db?*") + count_files("kept.db.snapshot*"), 0);
    unlink("copy.db");
    process_kill(&server, SIGTERM);
    assert_int_equal(process_wait(&server, 20), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(killed_snapshots_leave_no_half),
        cmocka_unit_test(stopped_snapshot_leaves_nothing),
        cmocka_unit_test(restarted_server_clears_up),
        cmocka_unit_test(full_disk_is_told),
    };
    return cmocka_run_group_tests(tests, prepare, NULL);
}
