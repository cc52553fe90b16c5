/* Words that people write in requests for tables. Private to server/show/table. */
#ifndef RUGO_SERVER_SHOW_TABLE_TABLE_WORDS_H
#define RUGO_SERVER_SHOW_TABLE_TABLE_WORDS_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TABLE_NAME_SIZE = 192 };
/* Numbers that a person writes are those meant, to so much. */
static const double TABLE_ROUNDING = 1e-9;

/* Returns whether a number is meant by a text. */
static inline bool table_word_is(double number, const char *text) {
    char *end;
    double read = strtod(text, &end);
    return end != text && *end == '\0' && fabs(read - number) <= TABLE_ROUNDING * fabs(number);
}

#endif
