/* Bytes that the store keeps, by zlib's deflate where that makes them fewer; exact. Packed bytes
 * begin with a mark, then have their size unpacked as 8 bytes, little endian, then a stream of zlib
 * (RFC 1950) with its checksum. Bytes without the mark are themselves, so that what older programs
 * stored is read as it is. Bytes that begin with the mark are packed whatever that makes of them.
 *
 * A transposition of the bytes of doubles before deflate was tried: blocks of contact then took 70
 * instead of 49 % of their size, curves 44 instead of 38 %, as their doubles repeat. */
#ifndef RUGO_SCHEMA_RESULT_BYTES_PACKED_BYTES_H
#define RUGO_SCHEMA_RESULT_BYTES_PACKED_BYTES_H

#include "core/error.h"
#include <stddef.h>

enum {
    PACKED_LEAST = 8 << 10, /* bytes: fewer take more time to pack than to store */
    PACKED_MOST = 256 << 20 /* bytes: more are left as they are, and refused where packed */
};

struct packed_bytes {
    const unsigned char *data; /* owned where `owned` is it, else what was passed in */
    size_t size;
    unsigned char *owned;
};
void packed_bytes_clear(struct packed_bytes *bytes);

/* Packs bytes for the store; *out borrows them where they stay as they are: below `least`, above
 * PACKED_MOST, or not made fewer. ERROR_MEMORY. */
int bytes_pack(struct packed_bytes *out, const void *data, size_t size, size_t least,
               struct error *err);
/* Unpacks bytes of the store; *out borrows what is not packed. ERROR_INPUT for damaged bytes, and
 * for those that say to be more than deflate can make so few: the memory taken is at most 1032
 * bytes for each one stored, and PACKED_MOST. */
int bytes_unpack(struct packed_bytes *out, const void *data, size_t size, struct error *err);

#endif
