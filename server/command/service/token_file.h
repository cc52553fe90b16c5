/* Files of tokens, which server and clients share: a role:token or role:name:token a line (a token
 * alone may do everything), where role:name:sha256:HEX has the digest of a token in its place;
 * empty lines and those that begin with # are passed over.
 *
 * Every role may read; submit may also submit studies and change those of its name, work also claim
 * and report jobs, admin also submit, and change the studies of all. */
#ifndef RUGO_SERVER_COMMAND_SERVICE_TOKEN_FILE_H
#define RUGO_SERVER_COMMAND_SERVICE_TOKEN_FILE_H

#include "core/error.h"
#include "schema/digest.h"
#include <stdbool.h>
#include <stddef.h>

enum role { ROLE_NONE = 0, ROLE_READ = 1, ROLE_SUBMIT = 2, ROLE_WORK = 4, ROLE_ADMIN = 8 };

/* Writes that a token of these roles (bits) may not do what one of `wanted` may: "the token's role,
 * read, does not allow this, which needs submit or admin". */
void roles_refuse(unsigned roles, unsigned wanted, char *text, size_t size);

/* A line that is not passed over; its texts are borrowed for the call. */
struct token_line {
    unsigned roles;    /* bits; ROLE_NONE where a word that is no role stands before the colon */
    const char *role;  /* its word; "" without */
    const char *name;  /* of whoever has the token; "" without */
    const char *token; /* NULL where the file has its digest alone */
    unsigned char digest[DIGEST_SIZE]; /* SHA-256 of the token */
    size_t number;                     /* of the line, from 1 on */
};
/* Anything but 0 ends the reading. */
typedef int token_visit(void *context, const struct token_line *line, struct error *err);
/* Shows each line of a file to visit; what was read is wiped. ERROR_INPUT where others may read it
 * (secret_file.h), unless it may be `open`. */
int token_file_read(const char *file, bool open, token_visit *visit, void *context,
                    struct error *err);
/* Likewise of the text of one, which it cuts into parts. */
int token_lines_visit(char *text, token_visit *visit, void *context, struct error *err);
/* Whether a text may be the name in a line: 1 to 40 letters, digits, . _ @ or -. */
bool token_name_is_good(const char *text);
/* What is wrong with a line that a server reads: ERROR_INPUT names file and line, never the token.
 */
int token_line_check(const struct token_line *line, const char *file, struct error *err);

/* ERROR_INPUT where no line role:name:token can have this role and name. */
int token_words_check(const char *role, const char *name, struct error *err);

/* The token with which a client asks: of the file (NULL: RUGO_TOKEN, whole) the first one that has
 * the role, else the first one; *token is NULL where there is none. Caller frees. */
int token_read(const char *file, enum role role, char **token, struct error *err);

/* Makes a token, puts a line with its digest at the end of a file, which is made where there is
 * none, and gives the token, which the caller frees. ERROR_INPUT as of token_words_check. */
int token_file_add(const char *file, const char *role, const char *name, char **token,
                   struct error *err);
/* Takes the lines of a name out of a file: *count of them; ERROR_ABSENT where there is none. */
int token_file_revoke(const char *file, const char *name, unsigned *count, struct error *err);

#endif
