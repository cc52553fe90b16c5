#include "schema/digest.h"
#include <nettle/sha2.h>
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
