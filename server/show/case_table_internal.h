/* What the files of the table of cases share; nobody else includes this. */
#ifndef RUGO_SERVER_SHOW_CASE_TABLE_INTERNAL_H
#define RUGO_SERVER_SHOW_CASE_TABLE_INTERNAL_H

#include "schema/result/result.h"

struct case_table;
struct picture_source;
struct table_column;
struct table_value;

enum { TABLE_WORDS_MOST = 8, TABLE_NAME_SIZE = 192 };
/* A column as it is asked for: "contact_area:layered@0.1". */
struct table_wish {
    char text[TABLE_NAME_SIZE]; /* words are parts of it, ended by NUL */
    const char *quantity;       /* or the name of a scalar */
    size_t word_count;
    const char *words[TABLE_WORDS_MOST];
    double x; /* NaN: a scalar is asked for */
};

struct table_maker {
    struct case_table *table;
    const struct picture_source *source;
    struct study_result curves; /* of the quantity that was asked for last; owned */
};

/* Appends a column of as many values as there are rows, NaN at first, for the caller to fill. */
int table_add(struct case_table *table, struct table_column column, struct table_value **values,
              struct error *err);
/* Adds the columns of curves that a wish stands for. */
int table_add_curves(struct table_maker *maker, const struct table_wish *wish, struct error *err);
/* Adds what the kind's view shows of such a quantity: at the highest place of its curves, and at
 * the one next to a third of it. */
int table_add_quantity(struct table_maker *maker, const char *quantity, struct error *err);

/* Reads "NAME=VALUE,..." and leaves the rows of the table that fit. */
int table_where(struct case_table *table, const char *const *where, struct error *err);

#endif
