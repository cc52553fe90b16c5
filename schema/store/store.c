#include "schema/store/store_internal.h"
#include <errno.h>
#include <fcntl.h>
#include <linux/magic.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <time.h>
#include <unistd.h>

enum { APPLICATION_ID = 0x5255474f, /* "RUGO" */ SCHEMA_VERSION = 1, BUSY_MS = 30000 };

/* schema/migrations/NNN.sql, linked in as data. */
extern const char _binary_schema_store_migrations_001_sql_start[];
extern const char _binary_schema_store_migrations_001_sql_end[];

static const struct {
    const char *start, *end;
} MIGRATIONS[SCHEMA_VERSION] = {
    {_binary_schema_store_migrations_001_sql_start, _binary_schema_store_migrations_001_sql_end},
};

/* --- small helpers --- */

int store_error(struct store *store, struct error *err) {
    int code = sqlite3_errcode(store->db);
    const char *what = sqlite3_errmsg(store->db);
    switch (code & 0xff) {
    case SQLITE_NOMEM:
        return error_set(err, ERROR_MEMORY, "database %s: out of memory", store->path);
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        return error_set(err, ERROR_SYSTEM,
                         "the database is busy: %s was locked by another process for %d s",
                         store->path, BUSY_MS / 1000);
    case SQLITE_FULL:
        return error_set(err, ERROR_SYSTEM, "the disk of database %s is full", store->path);
    case SQLITE_READONLY:
        return error_set(err, ERROR_SYSTEM, "database %s cannot be written: read-only",
                         store->path);
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
        return error_set(err, ERROR_SYSTEM, "database %s is damaged or no database: %s",
                         store->path, what);
    default:
        return error_set(err, ERROR_SYSTEM, "database %s: %s", store->path, what);
    }
}

int64_t store_now(const struct store *store) {
    if (store->options.now_ms)
        return store->options.now_ms(store->options.context);
    struct timespec now;
    clock_gettime(CLOCK_BOOTTIME, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

const char *store_time(struct store *store) {
    time_t now = time(NULL);
    struct tm utc = {0};
    if (now != store->time || !*store->time_text) {
        gmtime_r(&now, &utc);
        strftime(store->time_text, sizeof store->time_text, "%Y-%m-%dT%H:%M:%SZ", &utc);
        store->time = now;
    }
    return store->time_text;
}

int random_text(char *text, size_t digits, struct error *err) {
    unsigned char bytes[32];
    if (digits / 2 > sizeof bytes || getrandom(bytes, digits / 2, 0) != (ssize_t)(digits / 2))
        return error_set(err, ERROR_SYSTEM, "no random numbers from the kernel");
    for (size_t i = 0; i < digits; i++)
        text[i] = "0123456789abcdef"[bytes[i / 2] >> (i % 2 ? 0 : 4) & 15];
    text[digits] = 0;
    return 0;
}

char *column_copy(sqlite3_stmt *statement, int column) {
    const unsigned char *text = sqlite3_column_text(statement, column);
    return strdup(text ? (const char *)text : "");
}

int column_json(sqlite3_stmt *row, int column, cJSON **out, struct error *err) {
    static const struct json_limits limits = {.bytes = SIZE_MAX, .depth = 32, .values = SIZE_MAX};
    const char *text = (const char *)sqlite3_column_text(row, column);
    size_t size = (size_t)sqlite3_column_bytes(row, column);
    int status = json_parse(text != NULL ? text : "", size, &limits, out, err);
    return status != 0 ? error_context(err, "the database holds malformed JSON") : 0;
}

/* --- statements --- */

static int find_statement(struct store *store, const char *sql, sqlite3_stmt **out,
                          struct error *err) {
    for (size_t i = 0; i < store->statement_count; i++)
        if (store->statements[i].sql == sql) {
            *out = store->statements[i].statement;
            sqlite3_reset(*out);
            return 0;
        }
    if (store->statement_count == STATEMENTS)
        return error_set(err, ERROR_SYSTEM, "more than %d statements are prepared", STATEMENTS);
    if (sqlite3_prepare_v3(store->db, sql, -1, SQLITE_PREPARE_PERSISTENT, out, NULL))
        return store_error(store, err);
    store->statements[store->statement_count].sql = sql;
    store->statements[store->statement_count++].statement = *out;
    return 0;
}

static int bind(sqlite3_stmt *statement, sqlite3_destructor_type life, const char *format,
                va_list arguments) {
    int code = SQLITE_OK;
    for (int column = 1; !code && *format; format++, column++) {
        if (*format == 'i') {
            code = sqlite3_bind_int64(statement, column, va_arg(arguments, int64_t));
        } else if (*format == 'd') {
            code = sqlite3_bind_double(statement, column, va_arg(arguments, double));
        } else if (*format == 't') {
            const char *text = va_arg(arguments, const char *);
            code = sqlite3_bind_text(statement, column, text, -1, life);
        } else {
            const void *data = va_arg(arguments, const void *);
            size_t size = va_arg(arguments, size_t);
            code = size ? sqlite3_bind_blob64(statement, column, data, size, life)
                        : sqlite3_bind_zeroblob(statement, column, 0);
        }
    }
    return code;
}

/* life: SQLITE_TRANSIENT copies what is bound, SQLITE_STATIC does not. */
static int query(struct store *store, sqlite3_stmt **out, sqlite3_destructor_type life,
                 struct error *err, const char *sql, const char *format, va_list arguments) {
    int status = find_statement(store, sql, out, err);
    if (!status && bind(*out, life, format, arguments))
        status = store_error(store, err);
    return status;
}

int store_query(struct store *store, sqlite3_stmt **out, struct error *err, const char *sql,
                const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    int status = query(store, out, SQLITE_TRANSIENT, err, sql, format, arguments);
    va_end(arguments);
    return status;
}

int store_step(struct store *store, sqlite3_stmt *statement, struct error *err) {
    int code = sqlite3_step(statement);
    if (code == SQLITE_ROW)
        return 1;
    int status = code == SQLITE_DONE ? 0 : store_error(store, err);
    sqlite3_reset(statement);
    return status;
}

int store_run(struct store *store, struct error *err, const char *sql, const char *format, ...) {
    sqlite3_stmt *statement = NULL;
    va_list arguments;
    va_start(arguments, format);
    int status = query(store, &statement, SQLITE_STATIC, err, sql, format, arguments);
    va_end(arguments);
    if (!status)
        status = store_step(store, statement, err);
    if (status > 0) {
        sqlite3_reset(statement);
        status = 0;
    }
    return status;
}

int store_integer(struct store *store, int64_t *out, struct error *err, const char *sql,
                  const char *format, ...) {
    sqlite3_stmt *statement = NULL;
    va_list arguments;
    va_start(arguments, format);
    int status = query(store, &statement, SQLITE_STATIC, err, sql, format, arguments);
    va_end(arguments);
    if (!status)
        status = store_step(store, statement, err);
    if (status == 0)
        return ERROR_ABSENT;
    if (status < 0)
        return status;
    *out = sqlite3_column_int64(statement, 0);
    sqlite3_reset(statement);
    return 0;
}

/* --- transactions --- */

static int execute(struct store *store, const char *sql, struct error *err) {
    return sqlite3_exec(store->db, sql, NULL, NULL, NULL) ? store_error(store, err) : 0;
}

int change_begin(struct store *store, struct error *err) {
    if (store->options.read_only)
        return error_set(err, ERROR_SYSTEM, "database %s was opened for reading only", store->path);
    return store_run(store, err, store->batch ? "SAVEPOINT change" : "BEGIN IMMEDIATE", "");
}

int change_end(struct store *store, int status, struct error *err) {
    if (!status)
        status = store_run(store, err, store->batch ? "RELEASE change" : "COMMIT", "");
    /* After a full disk SQLite may have rolled back by itself: then there is nothing left to undo.
     */
    if (status && !sqlite3_get_autocommit(store->db)) {
        if (store->batch)
            store_run(store, NULL, "ROLLBACK TO change", "");
        store_run(store, NULL, store->batch ? "RELEASE change" : "ROLLBACK", "");
    }
    return status;
}

int store_begin(struct store *store, struct error *err) {
    int status = change_begin(store, err);
    store->batch = !status;
    return status;
}

int store_commit(struct store *store, struct error *err) {
    store->batch = 0;
    if (sqlite3_get_autocommit(store->db))
        return error_set(err, ERROR_SYSTEM, "database %s: the transaction was rolled back",
                         store->path);
    return change_end(store, 0, err);
}

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
    if (slash)
        slash[slash == folder] = 0;
    if (statfs(slash ? folder : ".", &info))
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

static int pragma_integer(struct store *store, const char *sql, int64_t *out, struct error *err) {
    sqlite3_stmt *statement = NULL;
    if (sqlite3_prepare_v2(store->db, sql, -1, &statement, NULL) ||
        sqlite3_step(statement) != SQLITE_ROW) {
        sqlite3_finalize(statement);
        return store_error(store, err);
    }
    *out = sqlite3_column_int64(statement, 0);
    sqlite3_finalize(statement);
    return 0;
}

static int migrate(struct store *store, int64_t version, struct error *err) {
    int status = 0;
    for (; !status && version < SCHEMA_VERSION; version++) {
        size_t size = (size_t)(MIGRATIONS[version].end - MIGRATIONS[version].start);
        char *sql = strndup(MIGRATIONS[version].start, size);
        char pragma[96];
        snprintf(pragma, sizeof pragma, "PRAGMA application_id = %d; PRAGMA user_version = %d",
                 APPLICATION_ID, (int)version + 1);
        status = sql ? execute(store, sql, err) : error_memory(err, size, "a migration");
        if (!status)
            status = execute(store, pragma, err);
        free(sql);
    }
    return status;
}

/* Reads whose file this is and brings it to the present version, under the write lock if it must.
 */
static int check_version(struct store *store, bool locked, struct error *err) {
    int64_t application = 0, version = 0, tables = 0;
    int status = pragma_integer(store, "PRAGMA application_id", &application, err);
    if (!status)
        status = pragma_integer(store, "PRAGMA user_version", &version, err);
    if (!status)
        status = pragma_integer(store, "SELECT count(*) FROM sqlite_schema", &tables, err);
    if (status)
        return status;
    if (application != APPLICATION_ID && (application != 0 || tables != 0))
        return error_set(err, ERROR_INPUT, "%s is a database of another program", store->path);
    if (version > SCHEMA_VERSION)
        return error_set(err, ERROR_INPUT,
                         "database %s has schema version %lld; this program knows up to %d: use a "
                         "newer rugo",
                         store->path, (long long)version, SCHEMA_VERSION);
    if (version == SCHEMA_VERSION)
        return 0;
    if (store->options.read_only)
        return error_set(err, ERROR_SYSTEM,
                         "database %s has schema version %lld, older than %d, and is opened for "
                         "reading only",
                         store->path, (long long)version, SCHEMA_VERSION);
    if (locked)
        return migrate(store, version, err);
    status = change_begin(store, err);
    return status ? status : change_end(store, check_version(store, true, err), err);
}

static void set_limits(sqlite3 *db) {
    sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
    sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
    sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0, NULL);
    sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, 1); /* VACUUM INTO attaches its target */
    sqlite3_busy_handler(db, wait_politely, NULL);
}

/* After a reboot the clock of the leases began anew: those given before run out at once. */
static int void_old_leases(struct store *store, struct error *err) {
    int64_t known = 0;
    int status = store_integer(store, &known, err, "SELECT count(*) FROM boot WHERE id = ?", "t",
                               store->boot);
    if (status || known)
        return status;
    status = change_begin(store, err);
    if (status)
        return status;
    /* another process may have come first, and given leases of this boot */
    status = store_run(store, err,
                       "UPDATE job SET lease_until = 0 WHERE state = 'running' AND NOT EXISTS "
                       "(SELECT 1 FROM boot WHERE id = ?)",
                       "t", store->boot);
    if (!status)
        status = store_run(store, err, "DELETE FROM boot", "");
    if (!status)
        status = store_run(store, err, "INSERT INTO boot (id) VALUES (?)", "t", store->boot);
    return change_end(store, status, err);
}

static int configure(struct store *store, struct error *err) {
    set_limits(store->db);
    int status = check_version(store, false, err);
    if (!status && !store->options.read_only)
        status = execute(store,
                         "PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL;"
                         "PRAGMA journal_size_limit = 67108864",
                         err);
    if (!status)
        status = execute(store,
                         "PRAGMA foreign_keys = ON; PRAGMA cache_size = -16384;"
                         "PRAGMA temp_store = MEMORY",
                         err);
    if (!status && !store->options.read_only)
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
    if (status)
        return status;
    if (sqlite3_open_v2(store->path, &store->db, flags, NULL))
        return error_set(err, ERROR_SYSTEM, "database %s cannot be opened: %s", store->path,
                         store->db ? sqlite3_errmsg(store->db) : "out of memory");
    return configure(store, err);
}

int store_open(struct store **out, const char *path, const struct store_options *options,
               struct error *err) {
    struct store *store = array_create(1, sizeof *store);
    if (!store)
        return error_memory(err, sizeof *store, "a store");
    if (options)
        store->options = *options;
    if (store->options.lease_ms <= 0)
        store->options.lease_ms = 60000;
    read_boot(store->boot);
    store->path = strdup(path);
    int status = store->path ? open_file(store, err) : error_memory(err, strlen(path), "a path");
    if (status) {
        store_close(&store);
        return status;
    }
    *out = store;
    return 0;
}

void store_close(struct store **store) {
    struct store *s = *store;
    if (!s)
        return;
    for (size_t i = 0; i < s->statement_count; i++)
        sqlite3_finalize(s->statements[i].statement);
    sqlite3_close(s->db);
    free(s->path);
    free(s);
    *store = NULL;
}
