#include "server/command/service/token_file.h"
#include "core/file/text_mark.h"
#include "schema/store/store.h"
#include "server/command/service/secret_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name;
    unsigned roles;
} ROLES[] = {{"read", ROLE_READ},
             {"submit", ROLE_READ | ROLE_SUBMIT},
             {"work", ROLE_READ | ROLE_WORK},
             {"admin", ROLE_READ | ROLE_SUBMIT | ROLE_ADMIN}};
enum { ROLE_COUNT = sizeof ROLES / sizeof *ROLES };

void roles_refuse(unsigned roles, unsigned wanted, char *text, size_t size) {
    size_t used = (size_t)snprintf(text, size, "the token's role");
    for (size_t r = 0; r < ROLE_COUNT && used < size; r++)
        if (ROLES[r].roles == roles)
            used += (size_t)snprintf(text + used, size - used, ", %s,", ROLES[r].name);
    if (used < size)
        used += (size_t)snprintf(text + used, size - used, " does not allow this, which needs ");
    const char *between = "";
    for (size_t r = 0; r < ROLE_COUNT && used < size; r++)
        if ((ROLES[r].roles & wanted) != 0) {
            used += (size_t)snprintf(text + used, size - used, "%s%s", between, ROLES[r].name);
            between = " or ";
        }
}

/* Returns the roles that a line's first word names; ROLE_NONE for an unknown one. */
static unsigned roles_of(const char *word, size_t length) {
    for (size_t r = 0; r < ROLE_COUNT; r++)
        if (strlen(ROLES[r].name) == length && memcmp(word, ROLES[r].name, length) == 0)
            return ROLES[r].roles;
    return ROLE_NONE;
}

/* Splits a line in place. A name and a digest both begin behind a colon: sha256 with 64 digits
 * behind it is a digest. */
static void line_read(char *text, struct token_line *line) {
    size_t length = strcspn(text, ":");
    line->name = line->role = "";
    line->token = text;
    line->roles = text[length] != '\0' ? roles_of(text, length)
                                       : ROLE_READ | ROLE_SUBMIT | ROLE_WORK | ROLE_ADMIN;
    if (text[length] != '\0' && line->roles != ROLE_NONE) {
        char *rest = text + length + 1, *colon = strchr(rest, ':');
        text[length] = '\0';
        line->role = text;
        line->token = rest;
        if (colon != NULL && !digest_read(rest, line->digest)) {
            *colon = '\0';
            line->name = rest;
            line->token = colon + 1;
        }
    }
    if (digest_read(line->token, line->digest))
        line->token = NULL;
    else
        digest_text(line->token, line->digest);
}

int token_lines_visit(char *text, token_visit *visit, void *context, struct error *err) {
    size_t number = 0;
    int status = 0;
    text += text_mark_length(text, strlen(text));
    for (char *line = text, *rest = NULL; status == 0 && line != NULL; line = rest) {
        struct token_line read = {.number = ++number};
        rest = strchr(line, '\n');
        if (rest != NULL)
            *rest++ = '\0';
        line[strcspn(line, "\r")] = '\0';
        if (*line == '\0' || *line == '#')
            continue;
        line_read(line, &read);
        status = visit(context, &read, err);
    }
    return status;
}

int token_file_read(const char *file, bool open, token_visit *visit, void *context,
                    struct error *err) {
    char *text = NULL;
    size_t size = 0;
    int status = secret_file_read(file, open, &text, &size, err);
    if (status != 0)
        return status;
    status = token_lines_visit(text, visit, context, err);
    explicit_bzero(text, size);
    free(text);
    return status;
}

bool token_name_is_good(const char *text) {
    size_t length = strlen(text);
    return length > 0 && length < OWNER_SIZE &&
           strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._@-") ==
               length;
}

int token_words_check(const char *role, const char *name, struct error *err) {
    if (roles_of(role, strlen(role)) == ROLE_NONE)
        return error_set(err, ERROR_INPUT,
                         "\"%.40s\" is no role; roles are read, submit, work and admin", role);
    if (!token_name_is_good(name))
        return error_set(err, ERROR_INPUT,
                         "\"%.80s\" is no name for a token, which has 1 to %d letters, digits, "
                         ". _ @ or -",
                         name, OWNER_SIZE - 1);
    return 0;
}

int token_line_check(const struct token_line *line, const char *file, struct error *err) {
    if (line->roles == ROLE_NONE)
        return error_set(err, ERROR_INPUT,
                         "%s, line %zu: no role:token; roles are read, submit, work and admin",
                         file, line->number);
    if (*line->name != '\0' && !token_name_is_good(line->name))
        return error_set(err, ERROR_INPUT,
                         "%s, line %zu: in role:name:token, a name has 1 to %d letters, digits, "
                         ". _ @ or -",
                         file, line->number, OWNER_SIZE - 1);
    if (line->token != NULL && strncmp(line->token, DIGEST_HEAD, strlen(DIGEST_HEAD)) == 0)
        return error_set(err, ERROR_INPUT, "%s, line %zu: sha256: needs 64 hexadecimal digits",
                         file, line->number);
    if (line->token != NULL && strlen(line->token) < 16)
        return error_set(err, ERROR_INPUT, "%s, line %zu: a token of less than 16 characters", file,
                         line->number);
    return 0;
}

/* The choice of a client. */
struct choice_of_token {
    unsigned role;
    unsigned roles; /* of the token so far */
    char *token;    /* owned; NULL before the first line */
    bool digests;   /* lines had no token to ask with */
};

static int choose(void *context, const struct token_line *line, struct error *err) {
    struct choice_of_token *choice = context;
    choice->digests = choice->digests || line->token == NULL;
    if (line->token == NULL)
        return 0;
    if (choice->token != NULL &&
        ((choice->roles & choice->role) != 0 || (line->roles & choice->role) == 0))
        return 0;
    free(choice->token);
    choice->roles = line->roles;
    choice->token = strdup(line->token);
    return choice->token != NULL ? 0 : error_memory(err, strlen(line->token), "a token");
}

int token_read(const char *file, enum role role, char **token, struct error *err) {
    struct choice_of_token choice = {.role = (unsigned)role};
    const char *given = getenv("RUGO_TOKEN");
    *token = NULL;
    if (file == NULL && (given == NULL || *given == '\0'))
        return 0;
    const struct token_line alone = {.role = "", .name = "", .token = given};
    int status = file != NULL ? token_file_read(file, false, choose, &choice, err)
                              : choose(&choice, &alone, err);
    if (status == 0 && choice.token == NULL)
        status = error_set(err, ERROR_INPUT, "%s holds %s", file,
                           choice.digests ? "digests alone, which a server checks: a client needs "
                                            "the token that rugo token new printed"
                                          : "no token");
    if (status != 0)
        free(choice.token);
    else
        *token = choice.token;
    return status;
}
