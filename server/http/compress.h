/* Answers in the content coding gzip (RFC 9110, 8.4.1.3), by zlib. */
#ifndef RUGO_SERVER_HTTP_COMPRESS_H
#define RUGO_SERVER_HTTP_COMPRESS_H

#include <microhttpd.h>
#include <stdbool.h>
#include <stddef.h>

enum { COMPRESS_LEAST = 4096 }; /* bytes: a shorter document goes as it is */

/* Whether a peer with this header Accept-Encoding (NULL: none) takes gzip. */
bool compress_is_accepted(const char *accept_encoding);
/* The text in gzip, which the caller frees, and its size; NULL when out of memory. */
char *compress_text(const char *text, size_t size, size_t *compressed);

/* A content reader around another one, which gives what that reads in gzip. */
struct compressor;
/* Takes context, to be released by free_context; NULL, with context still the caller's, when out of
 * memory. */
struct compressor *compressor_create(MHD_ContentReaderCallback read, void *context,
                                     MHD_ContentReaderFreeCallback free_context);
/* These are for the library; context is the compressor. */
ssize_t compressor_read(void *context, uint64_t position, char *buffer, size_t room);
void compressor_free(void *context);

#endif
