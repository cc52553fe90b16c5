/* Who may do what: tokens out of a file (server/command/service/token_file.h), kept as SHA-256
 * digests and compared in constant time. Whoever asks is judged by the file as it is then: a change
 * is seen at the next request. Safe from many threads. */
#ifndef RUGO_SERVER_HTTP_GUARD_TOKENS_H
#define RUGO_SERVER_HTTP_GUARD_TOKENS_H

#include "schema/store/store.h"
#include "server/command/service/token_file.h"
#include <stdbool.h>

struct tokens;

/* Reads tokens; ERROR_INPUT names the line at fault, never the token. Later a line at fault counts
 * for nothing, and a file that is gone, or holds no token, ends all tokens after TOKENS_GRACE_MS:
 * an editor may be writing it. */
enum { TOKENS_GRACE_MS = 2000 };
int tokens_read(struct tokens **out, const char *file, struct error *err);
void tokens_destroy(struct tokens **tokens);
/* Sets one more token with these roles (bits) and no name, for this process's own workers. */
void tokens_set_own(struct tokens *tokens, unsigned roles, const char *token);
/* Who has a token. */
struct token_holder {
    unsigned roles;        /* bits; 0 for an unknown token */
    char name[OWNER_SIZE]; /* "" without */
};
/* Finds who has a token (NULL: nobody). */
struct token_holder tokens_find(struct tokens *tokens, const char *token);
/* Looks at the file though nobody asks: else the time of a file that is gone would begin with the
 * next request, however late. */
void tokens_look(struct tokens *tokens);

#endif
