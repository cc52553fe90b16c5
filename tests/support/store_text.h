/* What a store tells whoever queries its file. Include after check.h. */
#ifndef RUGO_TESTS_SUPPORT_STORE_TEXT_H
#define RUGO_TESTS_SUPPORT_STORE_TEXT_H

#include <sqlite3.h>
#include <stdlib.h>
#include <string.h>

static inline char *read_text(const char *path, const char *sql) {
    sqlite3 *db = NULL;
    sqlite3_stmt *row = NULL;
    assert_int_equal(sqlite3_open_v2(path, &db, SQLITE_OPEN_READONLY, NULL), SQLITE_OK);
    if (sqlite3_prepare_v2(db, sql, -1, &row, NULL))
        print_error("%s\n", sqlite3_errmsg(db));
    assert_int_equal(sqlite3_step(row), SQLITE_ROW);
    char *text = strdup((const char *)sqlite3_column_text(row, 0));
    sqlite3_finalize(row);
    sqlite3_close(db);
    return text;
}

static inline void check_text(const char *path, const char *sql, const char *expected) {
    char *text = read_text(path, sql);
    assert_string_equal(text, expected);
    free(text);
}

#endif
