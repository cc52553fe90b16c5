#include "schema/result/bytes/bytes.h"
#include <stdlib.h>
#include <string.h>

__extension__ typedef unsigned __int128 wide; /* a varint holds up to 128 bits */

void bytes_clear(struct bytes *bytes) {
    free(bytes->data);
    *bytes = (struct bytes){0};
}

static void put_byte(struct bytes *bytes, unsigned byte) {
    if (bytes->failed)
        return;
    if (bytes->size == bytes->capacity) {
        size_t capacity = bytes->capacity < 256 ? 512 : 2 * bytes->capacity;
        unsigned char *data = capacity > bytes->capacity ? realloc(bytes->data, capacity) : NULL;
        if (data == NULL) {
            bytes->failed = true;
            return;
        }
        bytes->data = data;
        bytes->capacity = capacity;
    }
    bytes->data[bytes->size++] = (unsigned char)byte;
}

static void put_wide(struct bytes *bytes, wide value) {
    while (value >= 0x80) {
        put_byte(bytes, (unsigned)(value & 0x7f) | 0x80);
        value >>= 7;
    }
    put_byte(bytes, (unsigned)value);
}

void bytes_put_unsigned(struct bytes *bytes, uint64_t value) {
    put_wide(bytes, value);
}

void bytes_put_fixed(struct bytes *bytes, fixed_point value) {
    wide bits = (wide)value << 1;
    put_wide(bytes, value < 0 ? ~bits : bits);
}

static void put_word(struct bytes *bytes, uint64_t word) {
    for (int a = 0; a < 8; a++)
        put_byte(bytes, (unsigned)(word >> (8 * a)) & 0xff);
}

void bytes_put_double(struct bytes *bytes, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_word(bytes, bits);
}

void bytes_put_checksum(struct bytes *bytes) {
    put_word(bytes, hash_bytes(HASH_START, bytes->size, bytes->data));
}

/* Counts the entries from `from` on that are all zero (zero != 0), or all not zero. */
static size_t run_length(size_t n, const uint64_t *counts, size_t from, int zero) {
    size_t a = from;
    while (a < n && (counts[a] == 0) == zero)
        a++;
    return a - from;
}

/* Puts the number of zeros, then the number of other entries and these entries, and so on up to
 * n. */
void bytes_put_counts(struct bytes *bytes, size_t n, const uint64_t *counts) {
    for (size_t a = 0; a < n;) {
        size_t zeros = run_length(n, counts, a, 1);
        size_t others = run_length(n, counts, a + zeros, 0);
        bytes_put_unsigned(bytes, zeros);
        bytes_put_unsigned(bytes, others);
        for (size_t b = a + zeros; b < a + zeros + others; b++)
            bytes_put_unsigned(bytes, counts[b]);
        a += zeros + others;
    }
}

static unsigned get_byte(struct byte_reader *reader) {
    if (reader->failed || reader->at == reader->end) {
        reader->failed = true;
        return 0;
    }
    return *reader->at++;
}

/* Reads a number of up to `bits` bits, 64 or more. Most values fit into 63 bits, which are read in
 * one word. */
static wide get_wide(struct byte_reader *reader, unsigned bits) {
    uint64_t low = 0;
    for (unsigned shift = 0; shift < 63; shift += 7) {
        unsigned byte = get_byte(reader);
        low |= (uint64_t)(byte & 0x7f) << shift;
        if (byte < 0x80) {
            reader->failed = reader->failed || (byte == 0 && shift > 0);
            return reader->failed ? 0 : low;
        }
    }
    wide value = low;
    for (unsigned shift = 63; shift < bits; shift += 7) {
        unsigned byte = get_byte(reader);
        wide part = byte & 0x7f;
        if (shift + 7 > bits && part >> (bits - shift) != 0)
            break;
        value |= part << shift;
        if (byte < 0x80) {
            if (byte == 0)
                break;
            return reader->failed ? 0 : value;
        }
    }
    reader->failed = true;
    return 0;
}

uint64_t bytes_get_unsigned(struct byte_reader *reader) {
    return (uint64_t)get_wide(reader, 64);
}

fixed_point bytes_get_fixed(struct byte_reader *reader) {
    wide bits = get_wide(reader, 128);
    wide value = bits >> 1;
    return (bits & 1) != 0 ? -(fixed_point)value - 1 : (fixed_point)value;
}

static uint64_t get_word(struct byte_reader *reader) {
    uint64_t word = 0;
    for (int a = 0; a < 8; a++)
        word |= (uint64_t)get_byte(reader) << (8 * a);
    return reader->failed ? 0 : word;
}

double bytes_get_double(struct byte_reader *reader) {
    uint64_t bits = get_word(reader);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

struct byte_reader bytes_open(const unsigned char *data, size_t size) {
    if (data == NULL || size < 8)
        return (struct byte_reader){.failed = true};
    const unsigned char *end = data + size - 8;
    struct byte_reader checksum = {end, end + 8, false, false};
    int damaged = get_word(&checksum) != hash_bytes(HASH_START, size - 8, data);
    return (struct byte_reader){data, end, damaged, false};
}

void bytes_get_counts(struct byte_reader *reader, size_t n, uint64_t *counts) {
    for (size_t a = 0; a < n && !reader->failed;) {
        uint64_t zeros = bytes_get_unsigned(reader);
        uint64_t others = bytes_get_unsigned(reader);
        if (zeros > n - a || others > n - a - zeros || zeros + others == 0) {
            reader->failed = true;
            return;
        }
        a += zeros;
        for (; others > 0; others--) {
            counts[a] = bytes_get_unsigned(reader);
            if (counts[a++] == 0)
                reader->failed = true;
        }
    }
}

uint64_t hash_bytes(uint64_t hash, size_t n, const void *data) {
    const unsigned char *at = data;
    for (size_t a = 0; a < n; a++)
        hash = (hash ^ at[a]) * UINT64_C(0x100000001b3);
    return hash;
}
