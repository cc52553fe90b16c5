/* What queries of a store's file return. */
#ifndef RUGO_TESTS_SUPPORT_STORE_TEXT_H
#define RUGO_TESTS_SUPPORT_STORE_TEXT_H

#include "tests/support/sql.h"
#include <stdlib.h>
#include <string.h>

static inline char *read_text(const char *path, const char *sql) {
    sqlite3_stmt *row = sql_row(path, sql);
    char *text = strdup((const char *)sqlite3_column_text(row, 0));
    sql_end(row);
    return text;
}

static inline void check_text(const char *path, const char *sql, const char *expected) {
    char *text = read_text(path, sql);
    assert_string_equal(text, expected);
    free(text);
}

#endif
