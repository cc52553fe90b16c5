/* Makes texts from outside safe for terminals, tables and pictures: a name or a reason could hold
 * characters that a terminal obeys, or that make XML malformed. */
#ifndef RUGO_CORE_PLAIN_TEXT_H
#define RUGO_CORE_PLAIN_TEXT_H

#include <stddef.h>
#include <stdio.h>

/* Returns the bytes of a well-formed UTF-8 sequence (RFC 3629); 0 if it is none. Reads no further
 * than a NUL. */
size_t text_character(const char *text);
/* As text_character, of a character that is shown. Returns 0 also for control characters (C0, DEL,
 * C1), marks that change the direction of text, and characters that XML 1.0 does not allow. */
size_t text_shown(const char *text);
/* Replaces each byte that is not of a shown character by '?'; returns text, which may be NULL. */
char *text_make_plain(char *text);
/* Prints the text with the same replacements. */
void text_print_plain(FILE *file, const char *text);

#endif
