#define ZLIB_CONST /* what is unpacked is not changed */
#include "core/instrument/archive/gzip.h"
#include <stdint.h>
#include <stdlib.h>
#include <zlib.h>

/* A byte of deflate holds at most 1032 (zlib's technical details); the last 4 bytes of a file are
 * the size of what it holds, which is at least 18 bytes long. */
enum { RATIO_MOST = 1032, FILE_LEAST = 18, GZIP_ALONE = 16 };

bool gzip_begins(const char *data, size_t size) {
    return size >= 2 && data[0] == '\x1f' && data[1] == '\x8b';
}

static uint32_t stated_size(const char *data, size_t size) {
    const unsigned char *end = (const unsigned char *)data + size;
    return end[-4] | (uint32_t)end[-3] << 8 | (uint32_t)end[-2] << 16 | (uint32_t)end[-1] << 24;
}

/* Counts of zlib have 32 bits, so that bytes are passed on in parts. */
static uInt part_of(size_t left) {
    return left < UINT32_MAX ? (uInt)left : UINT32_MAX;
}

/* Returns whether the bytes unpack to `room` others and end there. */
static int unpack(char *to, size_t room, const char *data, size_t size, bool *whole) {
    z_stream stream = {.next_in = (const Bytef *)data};
    size_t used = 0;
    int state = inflateInit2(&stream, MAX_WBITS + GZIP_ALONE);
    if (state != Z_OK)
        return state;
    stream.next_out = (Bytef *)to;
    while (state == Z_OK) {
        const uInt in = part_of(size - used), out = part_of(room - stream.total_out);
        stream.avail_in = in;
        stream.avail_out = out;
        state = inflate(&stream, Z_NO_FLUSH);
        used += in - stream.avail_in;
        if (state == Z_OK && in == stream.avail_in && out == stream.avail_out)
            state = Z_BUF_ERROR;
    }
    *whole = state == Z_STREAM_END && used == size && stream.total_out == room;
    (void)inflateEnd(&stream);
    return state;
}

int gzip_unpack(char **out, size_t *out_size, const char *data, size_t size, struct error *err) {
    bool whole = false;
    if (size < FILE_LEAST || stated_size(data, size) / RATIO_MOST > size)
        return error_set(err, ERROR_INPUT, "gzip: %zu bytes cannot hold the size that they state",
                         size);
    const size_t room = stated_size(data, size);
    char *bytes = malloc(room + 1);
    if (bytes == NULL)
        return error_memory(err, room, "an unpacked file");
    int state = unpack(bytes, room, data, size, &whole);
    if (state == Z_MEM_ERROR || !whole) {
        free(bytes);
        if (state == Z_MEM_ERROR)
            return error_memory(err, room, "an unpacked file");
        return error_set(err, ERROR_INPUT,
                         "gzip: the file is damaged, or has other than the %zu bytes that it "
                         "states; allowed: one whole member",
                         room);
    }
    bytes[room] = '\0';
    *out = bytes;
    *out_size = room;
    return 0;
}
