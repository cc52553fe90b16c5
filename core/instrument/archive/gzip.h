/* Files in gzip's format (RFC 1952), unpacked whole. */
#ifndef RUGO_CORE_INSTRUMENT_ARCHIVE_GZIP_H
#define RUGO_CORE_INSTRUMENT_ARCHIVE_GZIP_H

#include "core/error.h"
#include <stdbool.h>
#include <stddef.h>

/* Returns whether a file begins as those of gzip do. */
bool gzip_begins(const char *data, size_t size);

/* Unpacks a file of one member into *out, which the caller frees, with a NUL behind it. The size
 * that the file states is enforced, and must be one that deflate can reach with its bytes, so that
 * a small file cannot fill memory. ERROR_INPUT where the file is damaged, differs from its stated
 * size or has several members. */
int gzip_unpack(char **out, size_t *out_size, const char *data, size_t size, struct error *err);

#endif
