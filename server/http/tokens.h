/* Who may do what: tokens out of a file (server/command/token_file.h), kept as SHA-256 digests and
 * compared in constant time. */
#ifndef RUGO_SERVER_HTTP_TOKENS_H
#define RUGO_SERVER_HTTP_TOKENS_H

#include "schema/store/store.h"
#include "server/command/token_file.h"
#include <stdbool.h>

struct tokens;

/* Reads tokens; ERROR_INPUT names the line at fault, never the token. */
int tokens_read(struct tokens **out, const char *file, struct error *err);
void tokens_destroy(struct tokens **tokens);
/* Adds one more token with these roles (bits) and no name, for this process's own workers. */
int tokens_add(struct tokens *tokens, unsigned roles, const char *token, struct error *err);
/* Who has a token. */
struct token_holder {
    unsigned roles;        /* bits; 0 for an unknown token */
    char name[OWNER_SIZE]; /* "" without */
};
/* Finds who has a token (NULL: nobody). */
struct token_holder tokens_find(const struct tokens *tokens, const char *token);

#endif
