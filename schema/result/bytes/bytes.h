/* A byte string that grows, and a reader that never passes its end: how partial results are
 * encoded. Integers are LEB128 varints (signed ones zigzag), doubles 8 bytes little endian. */
#ifndef RUGO_SCHEMA_RESULT_BYTES_BYTES_H
#define RUGO_SCHEMA_RESULT_BYTES_BYTES_H

#include "core/statistics/heights/histogram.h"
#include <stdbool.h>

struct bytes {
    unsigned char *data; /* owned; initialise with {0} */
    size_t size, capacity;
    bool failed; /* set by the first allocation failure; later writes do nothing */
};
void bytes_clear(struct bytes *bytes);
void bytes_put_unsigned(struct bytes *bytes, uint64_t value);
void bytes_put_fixed(struct bytes *bytes, fixed_point value);
void bytes_put_double(struct bytes *bytes, double value);
/* Puts a sparse array, in which a run of zeros costs about two bytes. */
void bytes_put_counts(struct bytes *bytes, size_t n, const uint64_t *counts);

/* Ends the string with a checksum of all bytes before it. */
void bytes_put_checksum(struct bytes *bytes);

struct byte_reader {
    const unsigned char *at, *end; /* borrowed */
    bool failed;        /* set by a read past the end or a malformed number; reads give 0 */
    bool out_of_memory; /* failed for lack of memory, not because of the data */
};
/* Returns a reader of the bytes before the checksum, which has failed where the checksum does not
 * match. */
struct byte_reader bytes_open(const unsigned char *data, size_t size);
/* Takes only the shortest form of a number. */
uint64_t bytes_get_unsigned(struct byte_reader *reader);
fixed_point bytes_get_fixed(struct byte_reader *reader);
double bytes_get_double(struct byte_reader *reader);
/* counts[n] must be zero: only the entries in use of a large sparse array are written. */
void bytes_get_counts(struct byte_reader *reader, size_t n, uint64_t *counts);

/* FNV-1a of 64 bits: a checksum against damage, not against intent. Start from HASH_START. */
#define HASH_START UINT64_C(0xcbf29ce484222325)
uint64_t hash_bytes(uint64_t hash, size_t n, const void *data);

#endif
