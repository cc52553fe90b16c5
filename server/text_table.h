/* Tables of text for people: columns as wide as their widest cell. */
#ifndef RUGO_SERVER_TEXT_TABLE_H
#define RUGO_SERVER_TEXT_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

struct text_table {
    size_t columns, cells, capacity;
    char **text; /* owned, row after row; initialise with {.columns = n} */
    bool failed; /* out of memory: the table prints nothing */
};
/* The next cell, filled from left to right, top to bottom. */
__attribute__((format(printf, 2, 3))) void table_cell(struct text_table *table, const char *format,
                                                      ...);
/* The same with up to four significant digits, "-" for NaN. */
void table_number(struct text_table *table, double value);
/* Numbers to the right, texts to the left; the first row is a heading. */
void table_print(const struct text_table *table, FILE *file);
void table_clear(struct text_table *table);

#endif
