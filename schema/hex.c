#include "schema/hex.h"
#include <sys/random.h>

void hex_print(const unsigned char *bytes, size_t count, char *text) {
    for (size_t i = 0; i < 2 * count; i++)
        text[i] = "0123456789abcdef"[bytes[i / 2] >> (i % 2 != 0 ? 0 : 4) & 15];
    text[2 * count] = '\0';
}

int hex_random(char *text, size_t digits, struct error *err) {
    unsigned char bytes[32];
    if (digits / 2 > sizeof bytes || getrandom(bytes, digits / 2, 0) != (ssize_t)(digits / 2))
        return error_set(err, ERROR_SYSTEM, "no random numbers from the kernel");
    hex_print(bytes, digits / 2, text);
    return 0;
}
