/* Files of tokens, which server and clients share: a role:token a line (a token alone may do
 * everything); empty lines and those that begin with # are passed over.
 *
 * Every role may read; submit may also change studies, work also claim and report jobs. */
#ifndef RUGO_SERVER_COMMAND_TOKEN_FILE_H
#define RUGO_SERVER_COMMAND_TOKEN_FILE_H

#include "core/error.h"

enum role { ROLE_NONE = 0, ROLE_READ = 1, ROLE_SUBMIT = 2, ROLE_WORK = 4 };

/* A line that is not passed over; roles are bits, ROLE_NONE where a word that is no role stands
 * before the colon. The token is borrowed for the call. Anything but 0 ends the reading. */
typedef int token_visit(void *context, unsigned roles, const char *token, size_t line,
                        struct error *err);
/* Shows each line of a file to visit; what was read is wiped. */
int token_file_read(const char *file, token_visit *visit, void *context, struct error *err);

/* The token with which a client asks: of the file (NULL: RUGO_TOKEN, whole) the first one that has
 * the role, else the first one; *token is NULL where there is none. Caller frees. */
int token_read(const char *file, enum role role, char **token, struct error *err);

#endif
