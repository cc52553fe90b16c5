#include "schema/digest.h"
#include "schema/hex.h"
#include <nettle/sha2.h>
#include <stdlib.h>
#include <string.h>

void digest_bytes(const void *bytes, size_t size, unsigned char digest[DIGEST_SIZE]) {
    struct sha256_ctx context;
    sha256_init(&context);
    sha256_update(&context, size, bytes);
    sha256_digest(&context, SHA256_DIGEST_SIZE, digest);
}

void digest_text(const char *text, unsigned char digest[DIGEST_SIZE]) {
    digest_bytes(text, strlen(text), digest);
}

void digest_print(const unsigned char digest[DIGEST_SIZE], char text[DIGEST_TEXT_SIZE]) {
    memcpy(text, DIGEST_HEAD, sizeof DIGEST_HEAD);
    hex_print(digest, DIGEST_SIZE, text + sizeof DIGEST_HEAD - 1);
}

bool digest_read(const char *text, unsigned char digest[DIGEST_SIZE]) {
    size_t head = strlen(DIGEST_HEAD), length = 2 * (size_t)DIGEST_SIZE;
    const char *digits = text + head;
    if (strncmp(text, DIGEST_HEAD, head) != 0 || strlen(digits) != length ||
        strspn(digits, "0123456789abcdefABCDEF") != length)
        return false;
    for (size_t i = 0; i < DIGEST_SIZE; i++) {
        const char pair[3] = {digits[2 * i], digits[2 * i + 1], '\0'};
        digest[i] = (unsigned char)strtoul(pair, NULL, 16);
    }
    return true;
}
