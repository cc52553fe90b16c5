/* Bytes as hexadecimal digits, and random digits for identifiers, keys and tokens. */
#ifndef RUGO_SCHEMA_HEX_H
#define RUGO_SCHEMA_HEX_H

#include "core/error.h"
#include <stddef.h>

/* text: room for 2 count + 1 characters. */
void hex_print(const unsigned char *bytes, size_t count, char *text);
/* Fills text with so many random digits of the kernel, an even number, 64 at most, and a NUL. */
int hex_random(char *text, size_t digits, struct error *err);

#endif
