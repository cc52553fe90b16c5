/* How the results of a kind are shown. Each kind describes it once, and tables and pictures follow
 * the description: they know no kind, quantity or scalar by name. Everything is static. */
#ifndef RUGO_SCHEMA_RESULT_VIEW_H
#define RUGO_SCHEMA_RESULT_VIEW_H

#include "schema/result/result.h"

/* A picture whose axes are both logarithmic. */
struct logarithmic_picture {
    const char *quantity;
    const char *suffix; /* of the picture's name, "light"; NULL: the only picture of the quantity */
};

/* A quantity that is tabulated over its x: a table for a case, or a row for each of many cases. */
struct quantity_table {
    const char *quantity;
    const char *title;                      /* "contact area" */
    const char *value, *x;                  /* titles of its columns: "area", "load" */
    const char *error_words[ERROR_SOURCES]; /* headings of its errors; NULL: the source's name */
    const char *legend;                     /* the line below: what the columns are */
    const char *const *scalars;             /* printed with it; NULL-terminated */
    const char *const *left_out; /* theories that hold for a part of x only; NULL-terminated */
};

/* What a series shows where a parameter of its case has a value: pits of one distribution are the
 * summits of another. */
struct series_name {
    const char *series;          /* "": that without a name */
    const char *pointer, *value; /* of the parameter; NULL: in every case */
    const char *name;
};

/* How people call what results name: a quantity, a series, a theory or a scalar, or the label of an
 * axis, which is a symbol without words. */
struct shown_name {
    const char *name;  /* "psd"; "A/A0" */
    const char *words; /* in titles and legends: "power spectral density" */
    const char *label; /* at an axis: "contact area A/A0"; NULL: the words */
};

struct result_view {
    const struct quantity_table *table; /* NULL: a row a case with its scalars */
    const char *const *headlines;       /* scalars of such a row, NULL-terminated; NULL, or where no
                                           case has one of them: all that have a theory */
    const char *const *densities; /* quantities whose zeros at the ends are empty bins, which a
                                     picture leaves out; NULL-terminated; NULL: none */
    const struct logarithmic_picture *logarithmic; /* ends with a quantity of NULL; NULL: none */
    const struct series_name *series_names;        /* ends with a series of NULL; NULL: none */
    const struct shown_name *names; /* of what is not called as it is named; ends with a name of
                                       NULL; NULL: none */
};

/* Returns whether a NULL-terminated list, or NULL, has the name. */
bool view_lists(const char *const *names, const char *name);

#endif
