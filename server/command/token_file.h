/* Files of tokens, which server and clients share: a role:token or role:name:token a line (a token
 * alone may do everything); empty lines and those that begin with # are passed over.
 *
 * Every role may read; submit may also submit studies and change those of its name, work also claim
 * and report jobs, admin also submit, and change the studies of all. */
#ifndef RUGO_SERVER_COMMAND_TOKEN_FILE_H
#define RUGO_SERVER_COMMAND_TOKEN_FILE_H

#include "core/error.h"

enum role { ROLE_NONE = 0, ROLE_READ = 1, ROLE_SUBMIT = 2, ROLE_WORK = 4, ROLE_ADMIN = 8 };

/* A line that is not passed over; its texts are borrowed for the call. */
struct token_line {
    unsigned roles;   /* bits; ROLE_NONE where a word that is no role stands before the colon */
    const char *name; /* of whoever has the token; "" without */
    const char *token;
    size_t number; /* of the line, from 1 on */
};
/* Anything but 0 ends the reading. */
typedef int token_visit(void *context, const struct token_line *line, struct error *err);
/* Shows each line of a file to visit; what was read is wiped. */
int token_file_read(const char *file, token_visit *visit, void *context, struct error *err);

/* The token with which a client asks: of the file (NULL: RUGO_TOKEN, whole) the first one that has
 * the role, else the first one; *token is NULL where there is none. Caller frees. */
int token_read(const char *file, enum role role, char **token, struct error *err);

#endif
