#include "schema/json/json.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

int base64_encode(const unsigned char *data, size_t size, char **out, struct error *err) {
    if (size > SIZE_MAX / 2)
        return error_set(err, ERROR_MEMORY, "%zu bytes are too many to encode", size);
    size_t length = (size + 2) / 3 * 4;
    char *text = malloc(length + 1), *at = text;
    if (text == NULL)
        return error_memory(err, length + 1, "base64 text");
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        uint32_t group = (uint32_t)data[i] << 16;
        group |= left > 1 ? (uint32_t)data[i + 1] << 8 : 0;
        group |= left > 2 ? data[i + 2] : 0;
        *at++ = DIGITS[group >> 18];
        *at++ = DIGITS[group >> 12 & 63];
        *at++ = left > 1 ? DIGITS[group >> 6 & 63] : '=';
        *at++ = left > 2 ? DIGITS[group & 63] : '=';
    }
    *at = 0;
    *out = text;
    return 0;
}

/* The values of the characters from '+' to 'z'; -1 for what is no digit. */
static const signed char VALUES[] = {
    62, -1, -1, -1, 63, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, -1, -1, -1, -1, -1,
    -1, -1, 0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17,
    18, 19, 20, 21, 22, 23, 24, 25, -1, -1, -1, -1, -1, -1, 26, 27, 28, 29, 30, 31,
    32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43, 44, 45, 46, 47, 48, 49, 50, 51};

/* Returns the value of a digit; -1 for what is no digit. */
static int digit_value(char c) {
    unsigned place = (unsigned)(unsigned char)c - '+';
    return place < sizeof VALUES ? VALUES[place] : -1;
}

/* Four characters to 1..3 bytes; 0 when they are no base64. Only the last group may be padded. */
static size_t group_decode(const char *text, bool last, unsigned char *bytes) {
    size_t count = last && text[3] == '=' ? (text[2] == '=' ? 1 : 2) : 3;
    int first = digit_value(text[0]), second = digit_value(text[1]);
    int third = count > 1 ? digit_value(text[2]) : 0, fourth = count > 2 ? digit_value(text[3]) : 0;
    if (first < 0 || second < 0 || third < 0 || fourth < 0)
        return 0;
    uint32_t group =
        (uint32_t)first << 18 | (uint32_t)second << 12 | (uint32_t)third << 6 | (uint32_t)fourth;
    /* Bits behind the last byte must be zero: one text for one value. */
    if ((count == 1 && (group & 0xffff) != 0) || (count == 2 && (group & 0xff) != 0))
        return 0;
    bytes[0] = (unsigned char)(group >> 16);
    bytes[1] = (unsigned char)(group >> 8);
    bytes[2] = (unsigned char)group;
    return count;
}

int base64_decode(const char *text, unsigned char **out, size_t *size, struct error *err) {
    size_t length = strlen(text), at = 0;
    if (length % 4 != 0)
        return error_set(err, ERROR_INPUT, "base64 of %zu characters; allowed: a multiple of 4",
                         length);
    unsigned char *data = malloc(length / 4 * 3 + 1);
    if (data == NULL)
        return error_memory(err, length / 4 * 3 + 1, "base64 data");
    for (size_t i = 0; i < length; i += 4) {
        size_t count = group_decode(text + i, i + 4 == length, data + at);
        if (count == 0) {
            free(data);
            return error_set(err, ERROR_INPUT, "no base64 at character %zu", i);
        }
        at += count;
    }
    *out = data;
    *size = at;
    return 0;
}
