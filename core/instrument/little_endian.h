/* Numbers of files that store the lowest byte first, at any address and on any machine. */
#ifndef RUGO_CORE_INSTRUMENT_LITTLE_ENDIAN_H
#define RUGO_CORE_INSTRUMENT_LITTLE_ENDIAN_H

#include <stdint.h>
#include <string.h>

/* Returns the unsigned integer of this many bytes, at most 8. */
static inline uint64_t little_integer(const char *at, size_t bytes) {
    uint64_t value = 0;
    for (size_t byte = bytes; byte-- > 0;)
        value = value << 8 | (unsigned char)at[byte];
    return value;
}

static inline double little_double(const char *at) {
    uint64_t bits = little_integer(at, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline float little_float(const char *at) {
    uint32_t bits = (uint32_t)little_integer(at, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
