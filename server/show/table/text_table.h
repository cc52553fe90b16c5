/* Tables of text for people: columns as wide as their widest cell; folded on a narrow terminal. */
#ifndef RUGO_SERVER_SHOW_TABLE_TEXT_TABLE_H
#define RUGO_SERVER_SHOW_TABLE_TEXT_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { TABLE_FOLDS_MOST = 64 };

struct text_table {
    size_t columns, cells, capacity;
    char **text;   /* owned, row after row; initialise with {.columns = n} */
    size_t room;   /* columns where there is no terminal; 0: as many as it takes */
    bool markdown; /* printed between bars, as documents have tables, and never folded */
    bool failed;   /* out of memory: the table prints nothing */
    size_t folds[TABLE_FOLDS_MOST], fold_count; /* columns where a folded table may begin anew */
};
/* So many columns a report has, also in a file. */
enum { TABLE_ROOM = 120 };
/* Before a cell of the heading: a table too wide for its room may be folded here. Columns
 * before the first fold stand at the left of every part. */
void table_fold(struct text_table *table);
/* Fills the next cell, from left to right and top to bottom. */
__attribute__((format(printf, 2, 3))) void table_cell(struct text_table *table, const char *format,
                                                      ...);
/* Fills it with a number of up to four significant digits, "-" for NaN. */
void table_number(struct text_table *table, double value);
/* Prints numbers to the right, texts to the left; the first row is a heading. */
void table_print(const struct text_table *table, FILE *file);
void table_clear(struct text_table *table);

/* Prints a text, which ends without a line feed, in lines of at most TABLE_ROOM bytes, folded at
 * blanks, and a line feed. A longer word has a line of its own. */
void print_folded(FILE *file, const char *text);

#endif
