/* Who may do what: tokens out of a file (server/command/token_file.h), kept as SHA-256 digests and
 * compared in constant time. */
#ifndef RUGO_SERVER_HTTP_TOKENS_H
#define RUGO_SERVER_HTTP_TOKENS_H

#include "server/command/token_file.h"
#include <stdbool.h>

struct tokens;

/* Reads tokens; ERROR_INPUT names the line at fault, never the token. */
int tokens_read(struct tokens **out, const char *file, struct error *err);
void tokens_destroy(struct tokens **tokens);
/* Adds one more token with these roles (bits), for this process's own workers. */
int tokens_add(struct tokens *tokens, unsigned roles, const char *token, struct error *err);
/* Returns the roles (bits) of a token; 0 for an unknown one or NULL. */
unsigned tokens_roles(const struct tokens *tokens, const char *token);

#endif
