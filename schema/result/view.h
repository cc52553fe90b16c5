/* How the results of a kind are shown. Each kind describes it once; tables and pictures read the
 * description, so that they know no kind, quantity or scalar by name. Everything is static. */
#ifndef RUGO_SCHEMA_RESULT_VIEW_H
#define RUGO_SCHEMA_RESULT_VIEW_H

#include "schema/result/result.h"

/* A picture whose axes are both logarithmic. */
struct logarithmic_picture {
    const char *quantity;
    const char *suffix; /* of one more picture's name, "light"; NULL: the quantity's only picture */
};

/* The quantity that is tabulated over its x: a table a case, or, of many cases, a row each. */
struct quantity_table {
    const char *quantity;
    const char *title;                      /* "contact area" */
    const char *value, *x;                  /* the words of its columns: "area", "load" */
    const char *error_words[ERROR_SOURCES]; /* headings of its errors; NULL: the source's name */
    const char *legend;                     /* the line below: what the columns are */
    const char *const *scalars;             /* told with it; NULL-terminated */
    const char *const *left_out; /* theories that hold for a part of x alone; NULL-terminated */
};

struct result_view {
    const struct quantity_table *table; /* NULL: a row a case with its scalars */
    const char *const *headlines;       /* scalars of such a row, NULL-terminated; NULL, or where no
                                           case has one of them: all that have a theory */
    const struct logarithmic_picture *logarithmic; /* ends with a quantity of NULL; NULL: none */
};

/* Returns whether a NULL-terminated list, or NULL, has the name. */
bool view_lists(const char *const *names, const char *name);

#endif
