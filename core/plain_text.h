/* Texts from outside as terminals, tables and pictures may have them: a name or a reason could hold
 * what a terminal obeys, or what makes XML malformed. */
#ifndef RUGO_CORE_PLAIN_TEXT_H
#define RUGO_CORE_PLAIN_TEXT_H

#include <stddef.h>
#include <stdio.h>

/* Returns the bytes of a well-formed UTF-8 sequence (RFC 3629); 0 if it is none. Reads no further
 * than a NUL. */
size_t text_character(const char *text);
/* The same of one that is shown: 0 too for control characters, of ASCII (C0, DEL) and behind it
 * (C1), marks that turn the direction of what follows, and what XML 1.0 has no place for. */
size_t text_shown(const char *text);
/* Puts '?' in the place of each byte that is not of a character that is shown; returns text, which
 * may be NULL. */
char *text_make_plain(char *text);
/* Prints it likewise. */
void text_print_plain(FILE *file, const char *text);

#endif
