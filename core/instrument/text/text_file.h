/* The text of an instrument's export line by line, in UTF-8 or Latin-1, without a mark. */
#ifndef RUGO_CORE_INSTRUMENT_TEXT_TEXT_FILE_H
#define RUGO_CORE_INSTRUMENT_TEXT_TEXT_FILE_H

#include "core/error.h"
#include <stdbool.h>
#include <stddef.h>

/* ERROR_INPUT where the bytes are no text. */
int text_check(const char *data, size_t size, struct error *err);

/* A line without its end and without blanks around it. */
struct text_line {
    const char *at, *end; /* borrowed */
    size_t number;        /* from 1; 0 before the first */
};

/* Moves to the next line of text[size], *next being where it begins; returns false where there is
 * none. */
bool text_line_next(struct text_line *line, const char **next, const char *end);
static inline bool text_is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

#endif
