#include "schema/result/bytes/packed_bytes.h"
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#define ZLIB_CONST /* input is const */
#include <zlib.h>

/* No kind's bytes begin with this mark, nor does a text in UTF-8. */
static const unsigned char MARK[4] = {0xfe, 'Z', 'B', 1};
enum {
    HEADER = 4 + 8,
    LEVEL = 1,        /* of 9: twice as fast as the usual 6 for a twentieth more bytes */
    RATIO_MOST = 1032 /* of deflate: 258 bytes by two bits */
};

void packed_bytes_clear(struct packed_bytes *bytes) {
    free(bytes->owned);
    *bytes = (struct packed_bytes){0};
}

static bool is_marked(const void *data, size_t size) {
    return size >= sizeof MARK && memcmp(data, MARK, sizeof MARK) == 0;
}

static void put_header(unsigned char *at, uint64_t size) {
    memcpy(at, MARK, sizeof MARK);
    for (size_t a = 0; a < 8; a++)
        at[sizeof MARK + a] = (unsigned char)(size >> 8 * a);
}

static uint64_t get_size(const unsigned char *header) {
    uint64_t size = 0;
    for (size_t a = 0; a < 8; a++)
        size |= (uint64_t)header[sizeof MARK + a] << 8 * a;
    return size;
}

/* The logarithm of a window that holds so many bytes, of those that zlib has: what it sets up for
 * the usual window of 32 KiB takes longer than to deflate some KiB. */
static int window_bits(size_t size) {
    int bits = 10;
    while (bits < MAX_WBITS && size >> bits != 0)
        bits++;
    return bits;
}

/* Deflates into so much room; *used: 0 where it does not fit. */
static int deflate_into(unsigned char *out, size_t room, const void *data, size_t size,
                        size_t *used, struct error *err) {
    z_stream stream = {
        .next_in = data, .avail_in = (uInt)size, .next_out = out, .avail_out = (uInt)room};
    int bits = window_bits(size), memory = bits - 7; /* the usual 8 with the largest window */
    if (deflateInit2(&stream, LEVEL, Z_DEFLATED, bits, memory, Z_DEFAULT_STRATEGY) != Z_OK)
        return error_memory(err, size, "packing a result");
    *used = deflate(&stream, Z_FINISH) == Z_STREAM_END ? stream.total_out : 0;
    deflateEnd(&stream);
    return 0;
}

int bytes_pack(struct packed_bytes *out, const void *data, size_t size, size_t least,
               struct error *err) {
    bool marked = is_marked(data, size);
    *out = (struct packed_bytes){data, size, NULL};
    if (size > PACKED_MOST && marked)
        return error_set(err, ERROR_INPUT, "a result of %zu bytes that begins as packed ones do",
                         size);
    if (size > PACKED_MOST || size == 0 || (size < least && !marked))
        return 0;
    size_t room = marked ? compressBound((uLong)size) + HEADER : size, used = 0;
    unsigned char *packed = room > HEADER ? array_create(room, 1) : NULL;
    if (packed == NULL)
        return room > HEADER ? error_memory(err, room, "packing a result") : 0;
    int status = deflate_into(packed + HEADER, room - HEADER, data, size, &used, err);
    if (status != 0 || used == 0) {
        free(packed);
        return status;
    }
    put_header(packed, size);
    *out = (struct packed_bytes){packed, used + HEADER, packed};
    return 0;
}

/* Inflates all of a stream that makes exactly so many bytes; anything else is damage. */
static int inflate_into(unsigned char *out, size_t size, const unsigned char *data, size_t packed,
                        struct error *err) {
    z_stream stream = {
        .next_in = data, .avail_in = (uInt)packed, .next_out = out, .avail_out = (uInt)size};
    if (inflateInit(&stream) != Z_OK)
        return error_memory(err, size, "unpacking a result");
    int code = inflate(&stream, Z_FINISH);
    bool whole = code == Z_STREAM_END && stream.total_out == size && stream.avail_in == 0;
    inflateEnd(&stream);
    if (code == Z_MEM_ERROR)
        return error_memory(err, size, "unpacking a result");
    return whole ? 0 : error_set(err, ERROR_INPUT, "packed bytes of a result are damaged");
}

int bytes_unpack(struct packed_bytes *out, const void *data, size_t size, struct error *err) {
    *out = (struct packed_bytes){data, size, NULL};
    if (!is_marked(data, size))
        return 0;
    uint64_t wanted = size > HEADER ? get_size(data) : 0;
    if (wanted == 0 || wanted > PACKED_MOST || wanted / RATIO_MOST > size)
        return error_set(err, ERROR_INPUT,
                         "packed bytes of a result are damaged: %zu that say to be %llu", size,
                         (unsigned long long)wanted);
    unsigned char *bytes = array_create((size_t)wanted, 1);
    if (bytes == NULL)
        return error_memory(err, (size_t)wanted, "unpacking a result");
    int status = inflate_into(bytes, (size_t)wanted, (const unsigned char *)data + HEADER,
                              size - HEADER, err);
    if (status != 0) {
        free(bytes);
        return status;
    }
    *out = (struct packed_bytes){bytes, (size_t)wanted, bytes};
    return 0;
}
