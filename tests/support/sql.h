/* The file of a store, asked and changed behind the back of the program. */
#ifndef RUGO_TESTS_SUPPORT_SQL_H
#define RUGO_TESTS_SUPPORT_SQL_H

#include "tests/support/check.h"
#include <sqlite3.h>

/* Opens a file, which is made where there is none; the caller closes it. */
static inline sqlite3 *sql_open(const char *path) {
    sqlite3 *db = NULL;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    sqlite3_busy_timeout(db, 20000);
    return db;
}

static inline void sql_run(sqlite3 *db, const char *sql) {
    if (sqlite3_exec(db, sql, NULL, NULL, NULL) != SQLITE_OK)
        fail_msg("%s: %s", sql, sqlite3_errmsg(db));
}

static inline void sql_change(const char *path, const char *sql) {
    sqlite3 *db = sql_open(path);
    sql_run(db, sql);
    sqlite3_close(db);
}

/* Returns the first row of an answer, for sql_end. Whoever opens a database after a crash, or
 * closes it as the last one, keeps others out for a moment: the reader waits for them. */
static inline sqlite3_stmt *sql_row(const char *path, const char *sql) {
    sqlite3 *db = NULL;
    sqlite3_stmt *row = NULL;
    assert_int_equal(sqlite3_open_v2(path, &db, SQLITE_OPEN_READONLY, NULL), SQLITE_OK);
    sqlite3_busy_timeout(db, 20000);
    if (sqlite3_prepare_v2(db, sql, -1, &row, NULL) != SQLITE_OK)
        fail_msg("%s: %s", sql, sqlite3_errmsg(db));
    assert_int_equal(sqlite3_step(row), SQLITE_ROW);
    return row;
}

static inline void sql_end(sqlite3_stmt *row) {
    sqlite3 *db = sqlite3_db_handle(row);
    sqlite3_finalize(row);
    sqlite3_close(db);
}

static inline int64_t sql_integer(const char *path, const char *sql) {
    sqlite3_stmt *row = sql_row(path, sql);
    int64_t value = sqlite3_column_int64(row, 0);
    sql_end(row);
    return value;
}

static inline double sql_real(const char *path, const char *sql) {
    sqlite3_stmt *row = sql_row(path, sql);
    double value = sqlite3_column_double(row, 0);
    sql_end(row);
    return value;
}

#endif
