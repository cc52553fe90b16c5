/* Which cases of a study are rows of its table: by the values of their parameters. */
#ifndef RUGO_SERVER_SHOW_TABLE_CASE_ROWS_H
#define RUGO_SERVER_SHOW_TABLE_CASE_ROWS_H

#include "schema/result/result.h"

/* Fills rows, with room for all cases, by those that fit `where`, lists of NAME=VALUE as in
 * table_request (case_table.h). ERROR_INPUT names a parameter or value that no case has, and those
 * that there are. */
int case_rows_choose(const struct study_result *study, const char *const *where,
                     const struct case_result **rows, size_t *count, struct error *err);

#endif
