/* What a study sweeps, as columns of tables. */
#ifndef RUGO_SCHEMA_RESULT_SWEPT_H
#define RUGO_SCHEMA_RESULT_SWEPT_H

#include "schema/result/result.h"

size_t swept_count(const struct study_result *study); /* 0 where it is not known */
/* Returns the pointer of number n; NULL behind the last. Borrowed from the study. Of a value that
 * is an object, such as a height in one of several units, each member is a column. */
const char *swept_pointer(const struct study_result *study, size_t n);
/* Returns the title of a column: the last word of the pointer, or the whole pointer without its
 * first slash where another one ends in the same word. */
const char *swept_name(const struct study_result *study, size_t n);

#endif
