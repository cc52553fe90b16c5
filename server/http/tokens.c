#include "server/http/tokens.h"
#include <nettle/memops.h>
#include <nettle/sha2.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct entry {
    uint8_t digest[SHA256_DIGEST_SIZE];
    unsigned roles;
};
struct tokens {
    struct entry *entries; /* owned */
    size_t count;
};

static void digest_of(const char *token, uint8_t digest[SHA256_DIGEST_SIZE]) {
    struct sha256_ctx context;
    sha256_init(&context);
    sha256_update(&context, strlen(token), (const uint8_t *)token);
    sha256_digest(&context, SHA256_DIGEST_SIZE, digest);
}

int tokens_add(struct tokens *tokens, unsigned roles, const char *token, struct error *err) {
    size_t bytes = (tokens->count + 1) * sizeof *tokens->entries;
    struct entry *larger = realloc(tokens->entries, bytes);
    if (larger == NULL)
        return error_memory(err, bytes, "tokens");
    tokens->entries = larger;
    digest_of(token, larger[tokens->count].digest);
    larger[tokens->count++].roles = roles;
    return 0;
}

/* What reads a file fills. */
struct token_reading {
    struct tokens *tokens;
    const char *file;
};

static int add_line(void *context, unsigned roles, const char *token, size_t line,
                    struct error *err) {
    struct token_reading *reading = context;
    if (roles == ROLE_NONE)
        return error_set(err, ERROR_INPUT,
                         "%s, line %zu: no role:token; roles are read, submit and work",
                         reading->file, line);
    if (strlen(token) < 16)
        return error_set(err, ERROR_INPUT, "%s, line %zu: a token of less than 16 characters",
                         reading->file, line);
    return tokens_add(reading->tokens, roles, token, err);
}

int tokens_read(struct tokens **out, const char *file, struct error *err) {
    struct token_reading reading = {.tokens = array_create(1, sizeof *reading.tokens),
                                    .file = file};
    int status = reading.tokens != NULL ? token_file_read(file, add_line, &reading, err)
                                        : error_memory(err, sizeof *reading.tokens, "tokens");
    if (status == 0 && reading.tokens->count == 0)
        status = error_set(err, ERROR_INPUT, "%s holds no token", file);
    if (status != 0) {
        tokens_destroy(&reading.tokens);
        return status;
    }
    *out = reading.tokens;
    return 0;
}

void tokens_destroy(struct tokens **tokens) {
    if (*tokens == NULL)
        return;
    free((*tokens)->entries);
    free(*tokens);
    *tokens = NULL;
}

unsigned tokens_roles(const struct tokens *tokens, const char *token) {
    uint8_t digest[SHA256_DIGEST_SIZE];
    unsigned roles = 0;
    if (token == NULL)
        return 0;
    digest_of(token, digest);
    for (size_t i = 0; i < tokens->count; i++) /* all of them, whichever fits */
        if (memeql_sec(tokens->entries[i].digest, digest, sizeof digest))
            roles |= tokens->entries[i].roles;
    return roles;
}
