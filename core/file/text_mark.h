/* Byte-order marks: bytes before a text, by which some programs say how it is encoded. */
#ifndef RUGO_CORE_TEXT_MARK_H
#define RUGO_CORE_TEXT_MARK_H

#include <stdbool.h>
#include <stddef.h>

/* Returns the length of the mark of UTF-8 that a text begins with, as Excel and Notepad write it;
 * 0 where there is none. */
size_t text_mark_length(const char *text, size_t size);
/* Returns whether a text begins with a mark of UTF-16. *low_first: the low byte of each pair comes
 * first; may be NULL. */
bool text_mark_is_utf16(const char *text, size_t size, bool *low_first);

#endif
