#include "server/http/tokens.h"
#include "server/command/command.h"
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

int tokens_add(struct tokens *tokens, enum role role, const char *token, struct error *err) {
    size_t bytes = (tokens->count + 1) * sizeof *tokens->entries;
    struct entry *larger = realloc(tokens->entries, bytes);
    if (larger == NULL)
        return error_memory(err, bytes, "tokens");
    tokens->entries = larger;
    digest_of(token, larger[tokens->count].digest);
    larger[tokens->count++].roles = (unsigned)role | ROLE_READ;
    return 0;
}

/* Returns the role in front of a line's colon; 0 for an unknown one. */
static unsigned role_of(const char *line, size_t length) {
    static const struct {
        const char *name;
        enum role role;
    } ROLES[] = {{"read", ROLE_READ}, {"submit", ROLE_SUBMIT}, {"work", ROLE_WORK}};
    for (size_t r = 0; r < sizeof ROLES / sizeof *ROLES; r++)
        if (strlen(ROLES[r].name) == length && memcmp(line, ROLES[r].name, length) == 0)
            return ROLES[r].role;
    return ROLE_NONE;
}

static int add_line(struct tokens *tokens, const char *line, size_t number, const char *file,
                    struct error *err) {
    size_t length = strcspn(line, ":");
    if (*line == 0 || *line == '#')
        return 0;
    unsigned role = line[length] != '\0' ? role_of(line, length) : ROLE_NONE;
    if (role == ROLE_NONE)
        return error_set(err, ERROR_INPUT,
                         "%s, line %zu: no role:token; roles are read, submit and work", file,
                         number);
    if (strlen(line + length + 1) < 16)
        return error_set(err, ERROR_INPUT, "%s, line %zu: a token of less than 16 characters", file,
                         number);
    return tokens_add(tokens, (enum role)role, line + length + 1, err);
}

int tokens_read(struct tokens **out, const char *file, struct error *err) {
    char *text = NULL, *rest = NULL;
    size_t size, number = 0;
    struct tokens *tokens = array_create(1, sizeof *tokens);
    int status = tokens != NULL ? file_read(file, 1 << 20, &text, &size, err)
                                : error_memory(err, sizeof *tokens, "tokens");
    for (char *line = text; status == 0 && line != NULL; line = rest) {
        rest = strchr(line, '\n');
        if (rest != NULL)
            *rest++ = 0;
        line[strcspn(line, "\r")] = 0;
        status = add_line(tokens, line, ++number, file, err);
    }
    if (status == 0 && tokens->count == 0)
        status = error_set(err, ERROR_INPUT, "%s holds no token", file);
    if (text != NULL)
        explicit_bzero(text, size);
    free(text);
    if (status != 0) {
        tokens_destroy(&tokens);
        return status;
    }
    *out = tokens;
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
