#include "schema/store/store_internal.h"
#include "schema/store/store_seal.h"
#include <errno.h>
#include <fcntl.h>
#include <linux/magic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <time.h>
#include <unistd.h>

/* --- opening --- */

/* Others hold the lock for a fraction of a millisecond: short random sleeps starve nobody. */
static int wait_politely(void *context, int tries) {
    (void)context;
    unsigned nanoseconds;
    if (getrandom(&nanoseconds, sizeof nanoseconds, 0) < 0)
        nanoseconds = 0;
    struct timespec pause = {0, 100000 + (long)(nanoseconds % 400000)};
    nanosleep(&pause, NULL);
    return tries < BUSY_MS * 10 / 3; /* a pause is 0.3 ms on average */
}

static int check_file_system(const char *path, struct error *err) {
    struct statfs info;
    char folder[4096];
    snprintf(folder, sizeof folder, "%s", path);
    char *slash = strrchr(folder, '/');
    if (slash != NULL)
        slash[slash == folder] = 0;
    if (statfs(slash != NULL ? folder : ".", &info) != 0)
        return error_set(err, ERROR_SYSTEM, "database %s: %s", path, strerror(errno));
    static const long NETWORK[] = {NFS_SUPER_MAGIC,
                                   SMB_SUPER_MAGIC,
                                   0xff534d42 /* cifs */,
                                   0xfe534d42 /* smb2 */,
                                   AFS_SUPER_MAGIC,
                                   CODA_SUPER_MAGIC,
                                   V9FS_MAGIC};
    for (size_t i = 0; i < sizeof NETWORK / sizeof *NETWORK; i++)
        if ((info.f_type & 0xffffffff) == NETWORK[i])
            return error_set(err, ERROR_SYSTEM,
                             "database %s is on a network file system, whose locks cannot be "
                             "trusted; put it on a local disk and let workers come over HTTP",
                             path);
    return 0;
}

static void set_limits(sqlite3 *db) {
    sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
    sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
    sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0, NULL);
    sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, 1); /* VACUUM attaches its target */
    sqlite3_busy_handler(db, wait_politely, NULL);
}

/* After a reboot the clock of the leases began anew: those given before run out at once. */
static int void_old_leases(struct store *store, struct error *err) {
    int64_t known = 0;
    int status = store_integer(store, &known, err, "SELECT count(*) FROM boot WHERE id = ?", "t",
                               store->boot);
    if (status != 0 || known != 0)
        return status;
    status = change_begin(store, err);
    if (status != 0)
        return status;
    /* another process may have come first, and given leases of this boot */
    status = store_run(store, err,
                       "UPDATE job SET lease_until = 0 WHERE state = 'running' AND NOT EXISTS "
                       "(SELECT 1 FROM boot WHERE id = ?)",
                       "t", store->boot);
    /* so are pauses, and when workers were seen */
    if (status == 0)
        status = store_run(store, err,
                           "UPDATE job SET not_before = 0 WHERE state = 'waiting' AND not_before > "
                           "0 AND NOT EXISTS (SELECT 1 FROM boot WHERE id = ?)",
                           "t", store->boot);
    if (status == 0)
        status = store_run(store, err,
                           "DELETE FROM seen WHERE NOT EXISTS (SELECT 1 FROM boot WHERE id = ?)",
                           "t", store->boot);
    if (status == 0)
        status = store_run(store, err, "DELETE FROM boot", "");
    if (status == 0)
        status = store_run(store, err, "INSERT INTO boot (id) VALUES (?)", "t", store->boot);
    return change_end(store, status, err);
}

static int configure(struct store *store, struct error *err) {
    set_limits(store->db);
    /* Of a file without tables yet, which then gives single pages back; of others when written
     * anew. */
    int status = seal_functions(store, err);
    if (status == 0 && !store->options.read_only)
        status = store_execute(store, "PRAGMA auto_vacuum = INCREMENTAL", err);
    if (status == 0)
        status = version_bring_up(store, err);
    if (status == 0 && !store->options.read_only)
        status = store_execute(store,
                               "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL;"
                               "PRAGMA journal_size_limit = 67108864",
                               err);
    if (status == 0)
        status = store_execute(store,
                               "PRAGMA foreign_keys = ON; PRAGMA cache_size = -16384;"
                               "PRAGMA temp_store = MEMORY",
                               err);
    if (status == 0 && !store->options.read_only)
        status = void_old_leases(store, err);
    return status;
}

static void read_boot(char *boot) {
    int file = open("/proc/sys/kernel/random/boot_id", O_RDONLY | O_CLOEXEC);
    ssize_t length = file < 0 ? -1 : read(file, boot, BOOT_SIZE - 1);
    if (file >= 0)
        close(file);
    if (length < 0)
        length = 0;
    boot[length] = 0;
    boot[strcspn(boot, "\n")] = 0;
}

static int open_file(struct store *store, struct error *err) {
    int flags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE;
    flags |= store->options.read_only ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE;
    struct stat info;
    bool exists = stat(store->path, &info) == 0;
    if (!exists && (store->options.read_only || store->options.existing))
        return error_set(err, ERROR_ABSENT, "there is no database %s", store->path);
    if (exists && !S_ISREG(info.st_mode))
        return error_set(err, ERROR_INPUT, "database %s is not a file", store->path);
    if (!exists)
        flags |= SQLITE_OPEN_CREATE;
    int status = check_file_system(store->path, err);
    if (status != 0)
        return status;
    int code = sqlite3_open_v2(store->path, &store->db, flags, NULL);
    if (code != SQLITE_OK)
        return error_set(err, code == SQLITE_NOMEM ? ERROR_MEMORY : ERROR_SYSTEM,
                         "database %s cannot be opened: %s", store->path, sqlite3_errstr(code));
    return configure(store, err);
}

int store_open(struct store **out, const char *path, const struct store_options *options,
               struct error *err) {
    struct store *store = array_create(1, sizeof *store);
    if (store == NULL)
        return error_memory(err, sizeof *store, "a store");
    if (options != NULL)
        store->options = *options;
    if (store->options.lease_ms <= 0)
        store->options.lease_ms = 60000;
    read_boot(store->boot);
    store->path = strdup(path);
    int status =
        store->path != NULL ? open_file(store, err) : error_memory(err, strlen(path), "a path");
    if (status != 0) {
        store_close(&store);
        return status;
    }
    *out = store;
    return 0;
}

void store_close(struct store **store) {
    struct store *s = *store;
    if (s == NULL)
        return;
    for (size_t i = 0; i < s->statement_count; i++)
        sqlite3_finalize(s->statements[i].statement);
    sqlite3_close(s->db);
    free(s->path);
    free(s);
    *store = NULL;
}
