#include "schema/json/json.h"
#include <nettle/base64.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int base64_encode(const unsigned char *data, size_t size, char **out, struct error *err) {
    if (size > SIZE_MAX / 2)
        return error_set(err, ERROR_MEMORY, "%zu bytes are too many to encode", size);
    size_t length = BASE64_ENCODE_RAW_LENGTH(size);
    char *text = malloc(length + 1);
    if (text == NULL)
        return error_memory(err, length + 1, "base64 text");
    base64_encode_raw(text, size, data);
    text[length] = '\0';
    *out = text;
    return 0;
}

/* Nettle passes over white space and takes padding in place of a last byte. Both leave fewer bytes
 * than this length and its last two characters stand for: one text is one value. */
int base64_decode(const char *text, unsigned char **out, size_t *size, struct error *err) {
    struct base64_decode_ctx context;
    size_t length = strlen(text), count = 0;
    if (length % 4 != 0)
        return error_set(err, ERROR_INPUT, "base64 of %zu characters; allowed: a multiple of 4",
                         length);
    size_t room = length / 4 * 3 + 1, padded = 0;
    while (padded < 2 && padded < length && text[length - 1 - padded] == '=')
        padded++;
    unsigned char *data = malloc(room);
    if (data == NULL)
        return error_memory(err, room, "base64 data");
    base64_decode_init(&context);
    if (base64_decode_update(&context, &count, data, length, text) != 1 ||
        base64_decode_final(&context) != 1 || count != length / 4 * 3 - padded) {
        free(data);
        return error_set(err, ERROR_INPUT, "%zu characters that are no base64", length);
    }
    *out = data;
    *size = count;
    return 0;
}
