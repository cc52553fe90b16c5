/* Digests: of secrets, which are kept and compared in their place, and of files. */
#ifndef RUGO_SCHEMA_DIGEST_H
#define RUGO_SCHEMA_DIGEST_H

#include <stddef.h>

enum { DIGEST_SIZE = 32 };

/* SHA-256 of a text, without its NUL. */
void digest_text(const char *text, unsigned char digest[DIGEST_SIZE]);
void digest_bytes(const void *bytes, size_t size, unsigned char digest[DIGEST_SIZE]);

#endif
