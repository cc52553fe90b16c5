#include "schema/store/store_internal.h"
#include "schema/store/store_seal.h"
#include <errno.h>
#include <fcntl.h>
#include <linux/magic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

/* --- opening --- */

static int check_file_system(const struct store *store, struct error *err) {
    const char *path = store->path;
    struct statfs info;
    char folder[4096];
    snprintf(folder, sizeof folder, "%s", path);
    char *slash = strrchr(folder, '/');
    if (slash != NULL)
        slash[slash == folder] = 0;
    if (statfs(slash != NULL ? folder : ".", &info) != 0)
        return store_refused(store, errno, "", err);
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
    sqlite3_busy_handler(db, store_wait, NULL);
}

/* The clock of leases restarts at a reboot: leases of before run out at once. */
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
    /* pauses and notes of workers are void, too */
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

/* --- versions: whose file it is, and how an older one is migrated --- */

/* All files of schema/store/migrations in the order of their names, each ended by a NUL. That of
 * index n makes version n + 1 of version n. Files are added and never edited, as stores of their
 * version exist. */
extern const char _binary_migrations_sql_start[];
extern const char _binary_migrations_sql_end[];
/* What all of them make of an empty file, ended by a NUL: in a tenth of their time. */
extern const char _binary_layout_sql_start[];

/* Returns a migration, or NULL behind the last. */
static const char *migration_at(int64_t version) {
    const char *text = _binary_migrations_sql_start;
    for (int64_t v = 0; v < version && text < _binary_migrations_sql_end; v++)
        text += strlen(text) + 1;
    return text < _binary_migrations_sql_end ? text : NULL;
}

static int64_t version_newest(void) {
    int64_t version = 0;
    while (migration_at(version) != NULL)
        version++;
    return version;
}

static int pragma_integer(struct store *store, const char *sql, int64_t *out, struct error *err) {
    sqlite3_stmt *statement = NULL;
    if (sqlite3_prepare_v2(store->db, sql, -1, &statement, NULL) != 0 ||
        sqlite3_step(statement) != SQLITE_ROW) {
        sqlite3_finalize(statement);
        return store_error(store, err);
    }
    *out = sqlite3_column_int64(statement, 0);
    sqlite3_finalize(statement);
    return 0;
}

static int table_has(struct store *store, const char *table, const char *column, int64_t *out,
                     struct error *err) {
    char sql[160];
    snprintf(sql, sizeof sql, "SELECT count(*) FROM pragma_table_info('%s') WHERE name = '%s'",
             table, column);
    return pragma_integer(store, sql, out, err);
}

/* 001.sql was edited in place before it was frozen. Stores of version 1 may lack columns of
 * published curves, which are added here; those of its first layout are refused. */
static int complete_first_version(struct store *store, struct error *err) {
    static const struct {
        const char *table, *column, *type;
    } LATER[] = {{"curve", "pressure", "REAL"},
                 {"curve", "kinematics", "TEXT"},
                 {"point", "discretisation_error", "REAL"},
                 {"point", "model_error", "REAL"},
                 {"point", "valueless", "INTEGER"}};
    int64_t found = 0;
    int status = table_has(store, "study_source", "source", &found, err);
    if (status == 0 && found == 0)
        return error_set(err, ERROR_INPUT,
                         "database %s has the first layout that a store ever had, which this "
                         "program cannot read; its studies are texts in the column source of its "
                         "table study: submit them again to a new database",
                         store->path);
    for (size_t c = 0; status == 0 && c < sizeof LATER / sizeof *LATER; c++) {
        char sql[160];
        status = table_has(store, LATER[c].table, LATER[c].column, &found, err);
        snprintf(sql, sizeof sql, "ALTER TABLE %s ADD COLUMN %s %s", LATER[c].table,
                 LATER[c].column, LATER[c].type);
        if (status == 0 && found == 0)
            status = store_execute(store, sql, err);
    }
    return status;
}

/* Older stores kept tokens as they are; lease_digest(text) makes digests of them. */
static void lease_digest(sqlite3_context *context, int count, sqlite3_value **values) {
    unsigned char digest[DIGEST_SIZE];
    (void)count;
    const char *text = (const char *)sqlite3_value_text(values[0]);
    if (text == NULL)
        return; /* NULL */
    digest_text(text, digest);
    sqlite3_result_blob(context, digest, sizeof digest, SQLITE_TRANSIENT);
}

/* Writes what says that a file is a store of a version. */
static int stamp_version(struct store *store, int64_t version, struct error *err) {
    char sql[96];
    snprintf(sql, sizeof sql, "PRAGMA application_id = %d; PRAGMA user_version = %d",
             APPLICATION_ID, (int)version);
    return store_execute(store, sql, err);
}

/* Makes the layout of the newest version in an empty file. */
static int lay_out(struct store *store, struct error *err) {
    int status = store_execute(store, _binary_layout_sql_start, err);
    return status == 0 ? stamp_version(store, version_newest(), err) : status;
}

/* Brings a store of a version up to the newest one. */
static int migrate(struct store *store, int64_t version, struct error *err) {
    int status = version == 1 ? complete_first_version(store, err) : 0;
    if (status == 0 && sqlite3_create_function(store->db, "lease_digest", 1, SQLITE_UTF8, NULL,
                                               lease_digest, NULL, NULL) != 0)
        status = store_error(store, err);
    for (const char *sql; status == 0 && (sql = migration_at(version)) != NULL; version++) {
        status = store_execute(store, sql, err);
        if (status == 0)
            status = stamp_version(store, version + 1, err);
    }
    return status;
}

static int read_version(struct store *store, int64_t *version, struct error *err) {
    int64_t application = 0, tables = 0, newest = version_newest();
    int status = pragma_integer(store, "PRAGMA application_id", &application, err);
    if (status == 0)
        status = pragma_integer(store, "PRAGMA user_version", version, err);
    if (status == 0)
        status = pragma_integer(store, "SELECT count(*) FROM sqlite_schema", &tables, err);
    if (status != 0)
        return status;
    if (application != APPLICATION_ID && (application != 0 || tables != 0))
        return error_set(err, ERROR_INPUT, "%s is a database of another program", store->path);
    if (*version > newest)
        return error_set(err, ERROR_INPUT,
                         "database %s has schema version %lld; this program knows up to %lld: use "
                         "a newer rugo",
                         store->path, (long long)*version, (long long)newest);
    return 0;
}

/* Has the file migrated for a handle that only reads, by one that may write. */
static int upgrade_for_reader(struct store *store, struct error *err) {
    struct store_options options = {.existing = true};
    struct store *writer = NULL;
    int status = store_open(&writer, store->path, &options, err);
    store_close(&writer);
    return status != 0 ? error_context(err, "bringing an older database up to date") : 0;
}

/* Migrates an older store; refuses a file that is no store, or one of a newer program. */
static int version_bring_up(struct store *store, struct error *err) {
    int64_t version = 0;
    int status = read_version(store, &version, err);
    if (status != 0 || migration_at(version) == NULL)
        return status;
    if (store->options.as_it_is)
        return error_set(err, ERROR_STATE, "database %s is of an older program", store->path);
    if (store->options.read_only)
        return upgrade_for_reader(store, err);
    status = change_begin(store, err);
    if (status != 0)
        return status;
    status = read_version(store, &version, err); /* another process may have come first */
    if (status == 0)
        status = version == 0 ? lay_out(store, err) : migrate(store, version, err);
    return change_end(store, status, err);
}

/* --- the layout --- */

/* One row for each table, index and view: its name and its definition, whichever migrations made
 * it. A table is defined by its columns, keys and indices, in the order of their names. */
static const char LAYOUT[] =
    "SELECT type || ' ' || name, CASE type WHEN 'table' THEN (SELECT group_concat(one, ', ') FROM "
    "(SELECT name || ' ' || type || ' ' || \"notnull\" || ' ' || coalesce(dflt_value, '') || ' ' "
    "|| "
    "pk || ' ' || hidden AS one FROM pragma_table_xinfo(s.name) UNION ALL SELECT 'refers ' || "
    "\"from\" || ' ' || \"table\" || ' ' || coalesce(\"to\", '') || ' ' || on_delete FROM "
    "pragma_foreign_key_list(s.name) UNION ALL SELECT 'index ' || l.name || ' ' || \"unique\" || ' "
    "' "
    "|| (SELECT group_concat(coalesce(x.name, ''), ' ') FROM pragma_index_xinfo(l.name) x) FROM "
    "pragma_index_list(s.name) l UNION ALL SELECT 'table ' || wr || ' ' || strict FROM "
    "pragma_table_list WHERE schema = 'main' AND name = s.name ORDER BY one)) ELSE sql END FROM "
    "sqlite_schema s WHERE name NOT LIKE 'sqlite_stat%' ORDER BY 1";

static bool column_is_same(sqlite3_stmt *one, sqlite3_stmt *other, int column) {
    const char *a = (const char *)sqlite3_column_text(one, column);
    const char *b = (const char *)sqlite3_column_text(other, column);
    return a == b || (a != NULL && b != NULL && strcmp(a, b) == 0);
}

/* Finds the first row that differs. Rows of both are in the order of their names. */
static int compare_layouts(struct store *store, sqlite3_stmt *has, struct store *fresh,
                           sqlite3_stmt *wants, char *fault, size_t size, struct error *err) {
    int found, wanted;
    do {
        found = store_step(store, has, err);
        wanted = found >= 0 ? store_step(fresh, wants, err) : 0;
    } while (found > 0 && wanted > 0 && column_is_same(has, wants, 0) &&
             column_is_same(has, wants, 1));
    if (found < 0 || wanted < 0)
        return found < 0 ? found : wanted;
    if (found > 0 || wanted > 0)
        snprintf(fault, size, "the layout of %s is not that of a store of this program",
                 (const char *)sqlite3_column_text(wanted > 0 ? wants : has, 0));
    return 0;
}

int version_check_layout(struct store *store, char *fault, size_t size, struct error *err) {
    struct store fresh = {.path = "a new store"};
    sqlite3_stmt *has = NULL, *wants = NULL;
    int status = 0;
    *fault = '\0';
    if (sqlite3_open(":memory:", &fresh.db) != SQLITE_OK)
        status = store_error(&fresh, err);
    if (status == 0)
        status = lay_out(&fresh, err);
    if (status == 0 && sqlite3_prepare_v2(fresh.db, LAYOUT, -1, &wants, NULL) != SQLITE_OK)
        status = store_error(&fresh, err);
    if (status == 0 && sqlite3_prepare_v2(store->db, LAYOUT, -1, &has, NULL) != SQLITE_OK)
        status = store_error(store, err);
    if (status == 0)
        status = compare_layouts(store, has, &fresh, wants, fault, size, err);
    sqlite3_finalize(has);
    sqlite3_finalize(wants);
    sqlite3_close(fresh.db);
    return status;
}

static int configure(struct store *store, struct error *err) {
    set_limits(store->db);
    /* A file without tables yet frees single pages from now on; other files when they are
     * rewritten. */
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
    if (!exists && errno != ENOENT)
        return store_refused(store, errno, "", err);
    if (!exists && (store->options.read_only || store->options.existing))
        return error_set(err, ERROR_ABSENT, "there is no database %s", store->path);
    if (exists && !S_ISREG(info.st_mode))
        return error_set(err, ERROR_INPUT, "database %s is not a file", store->path);
    if (!exists)
        flags |= SQLITE_OPEN_CREATE;
    int status = check_file_system(store, err);
    if (status == 0)
        status = files_check_before(store->path, err);
    bool moved = true;
    for (int tries = 0; status == 0 && moved && tries < 10; tries++) {
        sqlite3_close(store->db);
        store->db = NULL;
        int code = sqlite3_open_v2(store->path, &store->db, flags, NULL);
        if (code == SQLITE_NOMEM)
            return error_memory(err, sizeof *store, "a database");
        if (code != SQLITE_OK)
            return store_refused(store, sqlite3_system_errno(store->db), sqlite3_errstr(code), err);
        status = files_check_opened(store, &moved, err);
    }
    if (status == 0)
        status = configure(store, err);
    if (status == 0)
        files_note(store);
    return status;
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
    queue_line_destroy(&s->line);
    free(s->path);
    free(s);
    *store = NULL;
}
