/* Calls of SQLite: errors, statements prepared once, transactions. */
#include "schema/store/store_internal.h"
#include <errno.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

int store_error(struct store *store, struct error *err) {
    int reason = errno, code = sqlite3_errcode(store->db);
    const char *what = sqlite3_errmsg(store->db);
    switch (code & 0xff) {
    case SQLITE_NOMEM:
        return error_set(err, ERROR_MEMORY, "database %s: out of memory", store->path);
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        return error_set(err, ERROR_SYSTEM,
                         "the database is busy: %s was locked by another process for %d s",
                         store->path, BUSY_MS / 1000);
    case SQLITE_INTERRUPT:
        return error_set(err, ERROR_STOPPED, "reading the database was stopped");
    case SQLITE_FULL:
        return error_set(err, ERROR_SYSTEM, "the disk of database %s is full", store->path);
    case SQLITE_IOERR:
        return disk_error(reason, store->path, what, err);
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
        if (code == SQLITE_READONLY_ROLLBACK)
            return error_set(err, ERROR_SYSTEM,
                             "database %.150s was left in the midst of a change, which has to be "
                             "undone first from %.150s-journal: open it once by a command that "
                             "writes, such as rugo repair --db %.150s",
                             store->path, store->path, store->path);
        return store_refused(store, reason == EMFILE || reason == ENFILE ? reason : 0,
                             "it is read-only", err);
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
        return error_set(err, ERROR_SYSTEM, "database %s is damaged or no database: %s",
                         store->path, what);
    default:
        return error_set(err, ERROR_SYSTEM, "database %s: %s", store->path, what);
    }
}

int64_t store_now(const struct store *store) {
    if (store->options.now_ms != NULL)
        return store->options.now_ms(store->options.context);
    struct timespec now;
    clock_gettime(CLOCK_BOOTTIME, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

const char *store_time(struct store *store) {
    time_t now = time(NULL);
    struct tm utc = {0};
    if (now != store->time || *store->time_text == '\0') {
        gmtime_r(&now, &utc);
        strftime(store->time_text, sizeof store->time_text, "%Y-%m-%dT%H:%M:%SZ", &utc);
        store->time = now;
    }
    return store->time_text;
}

char *column_copy(sqlite3_stmt *statement, int column) {
    const unsigned char *text = sqlite3_column_text(statement, column);
    return strdup(text != NULL ? (const char *)text : "");
}

enum study_random column_random(sqlite3_stmt *row, int column) {
    const char *name = (const char *)sqlite3_column_text(row, column);
    const struct choice *choice = choice_find(STUDY_RANDOM, name);
    return choice != NULL ? (enum study_random)choice->value : RANDOM_INDEPENDENT;
}

int column_json(sqlite3_stmt *row, int column, cJSON **out, struct error *err) {
    static const struct json_limits limits = {.bytes = SIZE_MAX, .depth = 32, .values = SIZE_MAX};
    bool packed = sqlite3_column_type(row, column) == SQLITE_BLOB;
    bool held = sqlite3_column_type(row, column) != SQLITE_NULL;
    const void *data = packed ? sqlite3_column_blob(row, column) : sqlite3_column_text(row, column);
    struct packed_bytes text = {data, (size_t)sqlite3_column_bytes(row, column), NULL};
    if (held && data == NULL)
        return error_set(err, ERROR_MEMORY, "no memory left to read a document of the database");
    int status = packed ? bytes_unpack(&text, data, text.size, err) : 0;
    if (status == 0)
        status = json_parse(held ? (const char *)text.data : "", text.size, &limits, out, err);
    packed_bytes_clear(&text);
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
    if (sqlite3_prepare_v3(store->db, sql, -1, SQLITE_PREPARE_PERSISTENT, out, NULL) != 0)
        return store_error(store, err);
    store->statements[store->statement_count].sql = sql;
    store->statements[store->statement_count++].statement = *out;
    return 0;
}

static int bind(sqlite3_stmt *statement, sqlite3_destructor_type life, const char *format,
                va_list arguments) {
    int code = SQLITE_OK;
    for (int column = 1; code == 0 && *format != '\0'; format++, column++) {
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
            code = size > 0 ? sqlite3_bind_blob64(statement, column, data, size, life)
                            : sqlite3_bind_zeroblob(statement, column, 0);
        }
    }
    return code;
}

/* life: SQLITE_TRANSIENT copies what is bound, SQLITE_STATIC does not. */
static int query(struct store *store, sqlite3_stmt **out, sqlite3_destructor_type life,
                 struct error *err, const char *sql, const char *format, va_list arguments) {
    int status = find_statement(store, sql, out, err);
    if (status == 0 && bind(*out, life, format, arguments) != 0)
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

void store_set_stop(struct store *store, int (*stop)(void *context), void *context) {
    enum { OPERATIONS = 10000 }; /* some tenths of a millisecond */
    store->stop = stop;
    store->stop_context = context;
    sqlite3_progress_handler(store->db, stop != NULL ? OPERATIONS : 0, stop, context);
}

int row_step(sqlite3_stmt *row) {
    int code = sqlite3_step(row);
    for (int column = 0; code == SQLITE_ROW && column < sqlite3_data_count(row); column++)
        if (sqlite3_column_type(row, column) == SQLITE_TEXT &&
            sqlite3_column_text(row, column) == NULL)
            code = SQLITE_NOMEM;
    return code;
}

int store_step(struct store *store, sqlite3_stmt *statement, struct error *err) {
    if (store->stop != NULL && store->stop(store->stop_context) != 0) {
        sqlite3_reset(statement);
        return error_set(err, ERROR_STOPPED, "reading the database was stopped");
    }
    int code = row_step(statement);
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
    if (status == 0)
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
    if (status == 0)
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

int store_execute(struct store *store, const char *sql, struct error *err) {
    return sqlite3_exec(store->db, sql, NULL, NULL, NULL) != 0 ? store_error(store, err) : 0;
}

static const char ROLL_BACK[] = "ROLLBACK", ROLL_BACK_TO[] = "ROLLBACK TO change";

static int error_rolled_back(const struct store *store, struct error *err) {
    return error_set(err, ERROR_SYSTEM, "database %s: the transaction was rolled back",
                     store->path);
}

/* Prepares the statements that roll back before there is anything to undo. If memory were lacking
 * for them later, a change that could not be undone would keep others from writing, or a part of it
 * would stay in its batch. */
int change_begin(struct store *store, struct error *err) {
    sqlite3_stmt *undo;
    bool inside = sqlite3_get_autocommit(store->db) == 0;
    if (store->options.read_only)
        return error_set(err, ERROR_SYSTEM, "database %s was opened for reading only", store->path);
    if (store->batch != 0 && (!inside || store->spoiled)) /* no savepoint of another transaction */
        return error_rolled_back(store, err);
    int status = find_statement(store, ROLL_BACK, &undo, err);
    if (status == 0)
        status = find_statement(store, ROLL_BACK_TO, &undo, err);
    if (status == 0 && store->batch == 0 && inside)
        status = store_run(store, err, ROLL_BACK, ""); /* which failed after the last change */
    if (status != 0)
        return status;
    return store_run(store, err, store->batch != 0 ? "SAVEPOINT change" : "BEGIN IMMEDIATE", "");
}

int change_end(struct store *store, int status, struct error *err) {
    if (status == 0 && store->batch == 0)
        status = files_check(store, err);
    if (status == 0)
        status = store_run(store, err, store->batch != 0 ? "RELEASE change" : "COMMIT", "");
    if (status == 0 &&
        store->batch == 0) /* nothing is acknowledged that is in a file without name */
        status = files_check(store, err);
    /* After a full disk SQLite may have rolled back by itself: then there is nothing left to undo.
     * A change of a batch that cannot be undone alone takes the batch with it, at its end where it
     * cannot be undone yet. */
    if (status != 0 && sqlite3_get_autocommit(store->db) == 0) {
        bool alone = store->batch != 0 && store_run(store, NULL, ROLL_BACK_TO, "") == 0;
        int undone = store_run(store, NULL, alone ? "RELEASE change" : ROLL_BACK, "");
        store->spoiled = store->batch != 0 && !alone && undone != 0;
    }
    return status;
}

int read_begin(struct store *store, struct error *err) {
    sqlite3_stmt *undo;
    int64_t tables;
    int status = find_statement(store, ROLL_BACK, &undo, err);
    if (status == 0 && sqlite3_get_autocommit(store->db) == 0)
        status = store_run(store, err, ROLL_BACK, "");
    if (status == 0)
        status = store_run(store, err, "BEGIN", "");
    /* the transaction begins when something is read */
    if (status == 0 && (status = store_integer(store, &tables, err,
                                               "SELECT count(*) FROM sqlite_schema", "")) != 0)
        read_end(store);
    return status;
}

void read_end(struct store *store) {
    store_run(store, NULL, ROLL_BACK, "");
}

int store_begin(struct store *store, struct error *err) {
    int status = change_begin(store, err);
    store->batch = status == 0;
    return status;
}

int store_commit(struct store *store, struct error *err) {
    store->batch = 0;
    if (!store->spoiled && sqlite3_get_autocommit(store->db) == 0)
        return change_end(store, 0, err);
    (void)change_end(store, ERROR_STATE, NULL);
    store->spoiled = false;
    return error_rolled_back(store, err);
}

void store_abandon(struct store *store) {
    store->batch = 0;
    (void)change_end(store, ERROR_STATE, NULL);
    store->spoiled = false;
}

/* SQLite writes no page that stays as it is: the one row changes its number at each probe. */
int store_probe(struct store *store, struct error *err) {
    int status = change_begin(store, err);
    return status != 0
               ? status
               : change_end(store, store_run(store, err, "UPDATE boot SET rowid = -rowid", ""),
                            err);
}
