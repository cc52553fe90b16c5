/* Which cases of a study are rows of its table: by the values of their parameters. */
#ifndef RUGO_SERVER_SHOW_TABLE_CASE_ROWS_H
#define RUGO_SERVER_SHOW_TABLE_CASE_ROWS_H

#include "server/show/table/case_table.h"

/* Fills the rows of a table whose study is read: those that fit `where`, lists of NAME=VALUE as in
 * table_request. ERROR_INPUT names a parameter or value that no case has, and those that there
 * are. */
int case_rows_fill(struct case_table *table, const char *const *where, struct error *err);

#endif
