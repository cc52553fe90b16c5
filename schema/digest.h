/* Digests of secrets, which are stored and compared instead of them, and of files. */
#ifndef RUGO_SCHEMA_DIGEST_H
#define RUGO_SCHEMA_DIGEST_H

#include <stdbool.h>
#include <stddef.h>

/* As a text: DIGEST_HEAD, 64 hexadecimal digits and a NUL. */
#define DIGEST_HEAD "sha256:"
enum { DIGEST_SIZE = 32, DIGEST_TEXT_SIZE = sizeof DIGEST_HEAD + 2 * DIGEST_SIZE };

/* SHA-256 of a text, without its NUL. */
void digest_text(const char *text, unsigned char digest[DIGEST_SIZE]);
void digest_bytes(const void *bytes, size_t size, unsigned char digest[DIGEST_SIZE]);
void digest_print(const unsigned char digest[DIGEST_SIZE], char text[DIGEST_TEXT_SIZE]);
/* Takes capital digits too; false where the text is no digest. */
bool digest_read(const char *text, unsigned char digest[DIGEST_SIZE]);

#endif
