#include "server/command/token_file.h"
#include "server/command/command.h"
#include <stdlib.h>
#include <string.h>

/* Returns the roles that a line's first word names; ROLE_NONE for an unknown one. */
static unsigned roles_of(const char *word, size_t length) {
    static const struct {
        const char *name;
        unsigned roles;
    } ROLES[] = {
        {"read", ROLE_READ}, {"submit", ROLE_READ | ROLE_SUBMIT}, {"work", ROLE_READ | ROLE_WORK}};
    for (size_t r = 0; r < sizeof ROLES / sizeof *ROLES; r++)
        if (strlen(ROLES[r].name) == length && memcmp(word, ROLES[r].name, length) == 0)
            return ROLES[r].roles;
    return ROLE_NONE;
}

static int visit_line(const char *line, size_t number, token_visit *visit, void *context,
                      struct error *err) {
    size_t length = strcspn(line, ":");
    if (*line == '\0' || *line == '#')
        return 0;
    if (line[length] == '\0')
        return visit(context, ROLE_READ | ROLE_SUBMIT | ROLE_WORK, line, number, err);
    unsigned roles = roles_of(line, length);
    const char *token = roles != ROLE_NONE ? line + length + 1 : line;
    return visit(context, roles, token, number, err);
}

int token_file_read(const char *file, token_visit *visit, void *context, struct error *err) {
    char *text = NULL, *rest = NULL;
    size_t size = 0, number = 0;
    int status = file_read(file, 1 << 20, &text, &size, err);
    for (char *line = text; status == 0 && line != NULL; line = rest) {
        rest = strchr(line, '\n');
        if (rest != NULL)
            *rest++ = '\0';
        line[strcspn(line, "\r")] = '\0';
        status = visit_line(line, ++number, visit, context, err);
    }
    if (text != NULL)
        explicit_bzero(text, size);
    free(text);
    return status;
}

/* The choice of a client. */
struct choice_of_token {
    unsigned role;
    unsigned roles; /* of the token so far */
    char *token;    /* owned; NULL before the first line */
};

static int choose(void *context, unsigned roles, const char *token, size_t line,
                  struct error *err) {
    struct choice_of_token *choice = context;
    (void)line;
    if (choice->token != NULL &&
        ((choice->roles & choice->role) != 0 || (roles & choice->role) == 0))
        return 0;
    free(choice->token);
    choice->roles = roles;
    choice->token = strdup(token);
    return choice->token != NULL ? 0 : error_memory(err, strlen(token), "a token");
}

int token_read(const char *file, enum role role, char **token, struct error *err) {
    struct choice_of_token choice = {.role = (unsigned)role};
    const char *given = getenv("RUGO_TOKEN");
    *token = NULL;
    if (file == NULL && (given == NULL || *given == '\0'))
        return 0;
    int status = file != NULL ? token_file_read(file, choose, &choice, err)
                              : choose(&choice, ROLE_NONE, given, 0, err);
    if (status == 0 && choice.token == NULL)
        status = error_set(err, ERROR_INPUT, "%s holds no token", file);
    if (status != 0)
        free(choice.token);
    else
        *token = choice.token;
    return status;
}
