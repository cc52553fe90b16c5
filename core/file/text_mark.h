/* Byte-order marks: bytes before a text, by which some programs say how it is encoded. */
#ifndef RUGO_CORE_TEXT_MARK_H
#define RUGO_CORE_TEXT_MARK_H

#include "core/error.h"
#include <stdbool.h>
#include <stddef.h>

/* Returns the length of the mark of UTF-8 that a text begins with, as Excel and Notepad write it;
 * 0 where there is none. */
size_t text_mark_length(const char *text, size_t size);
/* Returns whether a text begins with a mark of UTF-16. *low_first: the low byte of each pair comes
 * first; may be NULL. */
bool text_mark_is_utf16(const char *text, size_t size, bool *low_first);

/* Bytes without the mark that they began with, and with LF at the ends of lines. */
struct unmarked_text {
    const char *text; /* borrowed from the bytes, or owned; text[size] is 0 where data[size] is */
    size_t size;
    char *owned; /* NULL where the text is the bytes themselves */
};

/* Removes the mark of UTF-8, and converts UTF-16 with a mark to UTF-8; what has no mark stays as it
 * is. Surrogates, which no file of numbers needs, become '?'. In a text without LF each CR, with
 * which the first Macintosh ended lines and some programs still do, becomes one. ERROR_MEMORY; *out
 * is then untouched. */
int text_unmark(struct unmarked_text *out, const char *data, size_t size, struct error *err);
/* Makes its bytes owned, so that they can be changed. ERROR_MEMORY; it is then untouched. */
int unmarked_text_own(struct unmarked_text *text, struct error *err);
void unmarked_text_clear(struct unmarked_text *text);

#endif
