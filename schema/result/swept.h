/* What a study sweeps, as columns of tables. */
#ifndef RUGO_SCHEMA_RESULT_SWEPT_H
#define RUGO_SCHEMA_RESULT_SWEPT_H

#include "schema/result/result.h"

/* No kind has as many parameters; what a document has beyond is left out. */
enum { SWEPT_MOST = 256 };

struct swept_column {
    const char *pointer;
    /* The last word of the pointer, or the whole pointer without its first slash where another one
     * ends in the same word. */
    const char *name;
};
/* Borrowed from the study, in the order of its pointers. */
struct swept {
    size_t count; /* 0 also where it is not known */
    struct swept_column columns[SWEPT_MOST];
};

/* Finds the columns. A value that is an object in some case, such as a height in one of several
 * units, has a column for each member that a case has, behind that of the cases in which it is
 * none. */
void swept_find(const struct study_result *study, struct swept *out);

#endif
