/* Protects: an error of a store says why the disk took nothing, which SQLite calls "disk I/O error"
 * alone, and whether it can pass. */
#include "schema/store/store.h"
#include "tests/support/check.h"
#include <errno.h>
#include <sqlite3.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

static int reason; /* of each write of SQLite */

static ssize_t fail_write(int file, const void *bytes, size_t size) {
    (void)file, (void)bytes, (void)size;
    errno = reason;
    return -1;
}

static ssize_t fail_write_at(int file, const void *bytes, size_t size, off_t at) {
    (void)at;
    return fail_write(file, bytes, size);
}

/* Writes of SQLite fail from here on, or work again. */
static void set_writes(bool fail) {
    sqlite3_vfs *vfs = sqlite3_vfs_find(NULL);
    sqlite3_syscall_ptr write_call = fail ? (sqlite3_syscall_ptr)fail_write : NULL;
    sqlite3_syscall_ptr at_call = fail ? (sqlite3_syscall_ptr)fail_write_at : NULL;
    vfs->xSetSystemCall(vfs, "write", write_call);
    vfs->xSetSystemCall(vfs, "pwrite", at_call);
    vfs->xSetSystemCall(vfs, "pwrite64", at_call);
}

static int probe(struct store *store, struct error *err) {
    int status = store_begin(store, err);
    if (status != 0)
        return status;
    status = store_probe(store, err);
    int end = store_commit(store, err);
    return status != 0 ? status : end;
}

static void set_limit(rlim_t bytes) {
    struct rlimit limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    limit.rlim_cur = bytes;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

static void a_disk_that_takes_nothing_is_named(void **state) {
    (void)state;
    static const struct {
        rlim_t limit;
        const char *text;
        int reason, code;
    } CASES[] = {
        {RLIM_INFINITY, "the disk of database s.db is full", ENOSPC, ERROR_SYSTEM},
        {RLIM_INFINITY, "is used up: database s.db cannot grow", EDQUOT, ERROR_SYSTEM},
        {RLIM_INFINITY, "the disk quota of user ", EDQUOT, ERROR_SYSTEM},
        {RLIM_INFINITY, "database s.db: disk I/O error", EIO, ERROR_SYSTEM},
        {1 << 30, "database s.db: disk I/O error", EIO, ERROR_SYSTEM},
        {RLIM_INFINITY, "its file system has no larger files", EFBIG, ERROR_SYSTEM},
        {1 << 30, "may write files of up to 1073741824 bytes (ulimit -f)", EFBIG, ERROR_LIMIT},
    };
    struct store *store = NULL;
    struct error err = {0};
    assert_int_equal(store_open(&store, "s.db", NULL, &err), 0);
    for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
        reason = CASES[c].reason;
        set_limit(CASES[c].limit);
        set_writes(true);
        int status = probe(store, &err);
        set_writes(false);
        set_limit(RLIM_INFINITY);
        assert_int_equal(status, CASES[c].code);
        assert_int_equal(err.code, CASES[c].code);
        if (strstr(err.text, CASES[c].text) == NULL)
            fail_msg("no '%s' in %s", CASES[c].text, err.text);
        assert_int_equal(probe(store, &err), 0); /* the store can be used again */
    }
    store_close(&store);
    unlink("s.db");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_disk_that_takes_nothing_is_named)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
