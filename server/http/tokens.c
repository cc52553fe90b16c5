#include "server/http/tokens.h"
#include <nettle/memops.h>
#include <nettle/sha2.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct entry {
    uint8_t digest[SHA256_DIGEST_SIZE];
    struct token_holder holder;
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

static int add(struct tokens *tokens, const struct token_line *line, struct error *err) {
    size_t bytes = (tokens->count + 1) * sizeof *tokens->entries;
    struct entry *larger = realloc(tokens->entries, bytes);
    if (larger == NULL)
        return error_memory(err, bytes, "tokens");
    tokens->entries = larger;
    struct entry *entry = &larger[tokens->count++];
    digest_of(line->token, entry->digest);
    entry->holder = (struct token_holder){.roles = line->roles};
    snprintf(entry->holder.name, sizeof entry->holder.name, "%s", line->name);
    return 0;
}

int tokens_add(struct tokens *tokens, unsigned roles, const char *token, struct error *err) {
    const struct token_line line = {.roles = roles, .name = "", .token = token};
    return add(tokens, &line, err);
}

/* What reads a file fills. */
struct token_reading {
    struct tokens *tokens;
    const char *file;
};

static bool is_name(const char *text) {
    size_t length = strlen(text);
    return length > 0 && length < OWNER_SIZE &&
           strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._@-") ==
               length;
}

static int add_line(void *context, const struct token_line *line, struct error *err) {
    struct token_reading *reading = context;
    if (line->roles == ROLE_NONE)
        return error_set(err, ERROR_INPUT,
                         "%s, line %zu: no role:token; roles are read, submit, work and admin",
                         reading->file, line->number);
    if (*line->name != '\0' && !is_name(line->name))
        return error_set(err, ERROR_INPUT,
                         "%s, line %zu: in role:name:token, a name has 1 to %d letters, digits, "
                         ". _ @ or -",
                         reading->file, line->number, OWNER_SIZE - 1);
    if (strlen(line->token) < 16)
        return error_set(err, ERROR_INPUT, "%s, line %zu: a token of less than 16 characters",
                         reading->file, line->number);
    return add(reading->tokens, line, err);
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

struct token_holder tokens_find(const struct tokens *tokens, const char *token) {
    uint8_t digest[SHA256_DIGEST_SIZE];
    struct token_holder found = {0};
    if (token == NULL)
        return found;
    digest_of(token, digest);
    for (size_t i = 0; i < tokens->count; i++) { /* all of them, whichever fits */
        if (!memeql_sec(tokens->entries[i].digest, digest, sizeof digest))
            continue;
        found.roles |= tokens->entries[i].holder.roles;
        if (*found.name == '\0')
            memcpy(found.name, tokens->entries[i].holder.name, sizeof found.name);
    }
    return found;
}
