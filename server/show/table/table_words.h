/* Words that people write in requests for tables, and lists of those that there are. Private to
 * server/show/table. */
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

/* Appends a name, or once "..." where there is no room for it. */
static inline void table_words_add(char *names, size_t size, const char *name) {
    size_t used = strlen(names);
    bool full = used >= 3 && strcmp(names + used - 3, "...") == 0;
    if (used + strlen(name) + sizeof ", , ..." < size)
        snprintf(names + used, size - used, "%s%s", used > 0 ? ", " : "", name);
    else if (!full)
        snprintf(names + used, size - used, "%s...", used > 0 ? ", " : "");
}

#endif
