/* Who may do what: tokens out of a file, kept as SHA-256 digests and compared in constant time.
 *
 * The file has a role:token a line; empty lines and those that begin with # are passed over. Every
 * role may read; submit may also change studies, work also claim and report jobs. */
#ifndef RUGO_SERVER_HTTP_TOKENS_H
#define RUGO_SERVER_HTTP_TOKENS_H

#include "core/error.h"
#include <stdbool.h>

enum role { ROLE_NONE = 0, ROLE_READ = 1, ROLE_SUBMIT = 2, ROLE_WORK = 4 };
struct tokens;

/* Reads tokens; ERROR_INPUT names the line at fault, never the token. */
int tokens_read(struct tokens **out, const char *file, struct error *err);
void tokens_destroy(struct tokens **tokens);
/* Adds one more token, for this process's own workers. */
int tokens_add(struct tokens *tokens, enum role role, const char *token, struct error *err);
/* Returns the roles (bits) of a token; 0 for an unknown one or NULL. */
unsigned tokens_roles(const struct tokens *tokens, const char *token);

#endif
