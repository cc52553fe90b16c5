/* A text of one column of numbers with decimal commas, as spreadsheets write a profile where the
 * comma is the decimal mark: each line looks like two numbers. */
#ifndef RUGO_CORE_INSTRUMENT_TEXT_DECIMAL_COLUMN_H
#define RUGO_CORE_INSTRUMENT_TEXT_DECIMAL_COLUMN_H

#include <stddef.h>

enum decimal_column {
    DECIMAL_NO,   /* the text has other rows */
    DECIMAL_OPEN, /* each row may be one number or two whole ones */
    DECIMAL_YES
};

/* Judges a text whose rows, eight at least, all have digits on both sides of one comma and nothing
 * else but a sign before them. They are numbers with decimals where there are as many digits behind
 * all commas, and a part behind one begins with 0 before others, or one before is -0: whole numbers
 * are not written so. *rows: their number. */
enum decimal_column decimal_column_judge(const char *text, size_t size, size_t *rows);

/* Puts a point in place of the comma of each row of such a text. */
void decimal_column_point(char *text, size_t size);

#endif
