/* Versions of the store: whose file it is, and what brings an older one up to date. */
#include "schema/store/store_internal.h"
#include <stdio.h>
#include <string.h>

enum { APPLICATION_ID = 0x5255474f /* "RUGO" */ };

/* Every file of schema/store/migrations in the order of their names, each ended by a NUL. That of
 * index n makes version n + 1 of version n. Files are added and never edited: stores of their
 * version exist. */
extern const char _binary_migrations_sql_start[];
extern const char _binary_migrations_sql_end[];

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

/* 001.sql was edited in place before it was frozen: stores of version 1 exist that lack columns of
 * published curves, which are added here, and such of its first layout, which are refused. */
static int mend_first_version(struct store *store, struct error *err) {
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

/* Tokens of older stores, which kept them as they are, become digests: lease_digest(text). */
static void lease_digest(sqlite3_context *context, int count, sqlite3_value **values) {
    unsigned char digest[DIGEST_SIZE];
    (void)count;
    const char *text = (const char *)sqlite3_value_text(values[0]);
    if (text == NULL)
        return; /* NULL */
    digest_text(text, digest);
    sqlite3_result_blob(context, digest, sizeof digest, SQLITE_TRANSIENT);
}

static int migrate(struct store *store, int64_t version, struct error *err) {
    int status = version == 1 ? mend_first_version(store, err) : 0;
    if (status == 0 && sqlite3_create_function(store->db, "lease_digest", 1, SQLITE_UTF8, NULL,
                                               lease_digest, NULL, NULL) != 0)
        status = store_error(store, err);
    for (const char *sql; status == 0 && (sql = migration_at(version)) != NULL; version++) {
        char pragma[96];
        snprintf(pragma, sizeof pragma, "PRAGMA application_id = %d; PRAGMA user_version = %d",
                 APPLICATION_ID, (int)version + 1);
        status = store_execute(store, sql, err);
        if (status == 0)
            status = store_execute(store, pragma, err);
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

/* Whoever only reads has the file brought up to date by a handle that may write. */
static int upgrade_for_reader(struct store *store, struct error *err) {
    struct store_options options = {.existing = true};
    struct store *writer = NULL;
    int status = store_open(&writer, store->path, &options, err);
    store_close(&writer);
    return status != 0 ? error_context(err, "bringing an older database up to date") : 0;
}

int version_bring_up(struct store *store, struct error *err) {
    int64_t version = 0;
    int status = read_version(store, &version, err);
    if (status != 0 || migration_at(version) == NULL)
        return status;
    if (store->options.read_only)
        return upgrade_for_reader(store, err);
    status = change_begin(store, err);
    if (status != 0)
        return status;
    status = read_version(store, &version, err); /* another process may have come first */
    if (status == 0)
        status = migrate(store, version, err);
    return change_end(store, status, err);
}

/* --- the layout --- */

/* One row for each table, index and view: its name, and what it consists of, whichever migrations
 * made it so: of tables what their columns, keys and indices are, in the order of their names. */
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

/* Rows of both are in the order of their names: the first that are not the same tell the fault. */
static int compare_layouts(sqlite3_stmt *store, sqlite3_stmt *fresh, char *fault, size_t size) {
    int code, wanted;
    do {
        code = sqlite3_step(store);
        wanted = sqlite3_step(fresh);
    } while (code == SQLITE_ROW && wanted == SQLITE_ROW && column_is_same(store, fresh, 0) &&
             column_is_same(store, fresh, 1));
    if (wanted != SQLITE_ROW && wanted != SQLITE_DONE)
        return wanted;
    if (code == SQLITE_DONE && wanted == SQLITE_DONE)
        return SQLITE_OK;
    const char *name = (const char *)sqlite3_column_text(wanted == SQLITE_ROW ? fresh : store, 0);
    snprintf(fault, size, "the layout of %s is not that of a store of this program",
             name != NULL ? name : "a table");
    return SQLITE_OK;
}

int version_check_layout(struct store *store, char *fault, size_t size, struct error *err) {
    struct store fresh = {.path = "a new store"};
    sqlite3_stmt *has = NULL, *wants = NULL;
    int status = 0;
    *fault = '\0';
    if (sqlite3_open(":memory:", &fresh.db) != SQLITE_OK)
        status = store_error(&fresh, err);
    if (status == 0)
        status = migrate(&fresh, 0, err);
    if (status == 0 && (sqlite3_prepare_v2(fresh.db, LAYOUT, -1, &wants, NULL) != SQLITE_OK ||
                        sqlite3_prepare_v2(store->db, LAYOUT, -1, &has, NULL) != SQLITE_OK ||
                        compare_layouts(has, wants, fault, size) != SQLITE_OK))
        status = store_error(wants == NULL ? &fresh : store, err);
    sqlite3_finalize(has);
    sqlite3_finalize(wants);
    sqlite3_close(fresh.db);
    return status;
}
