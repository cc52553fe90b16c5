#include "server/command/token_file.h"
#include "server/command/command.h"
#include <stdlib.h>
#include <string.h>

/* Returns the roles that a line's first word names; ROLE_NONE for an unknown one. */
static unsigned roles_of(const char *word, size_t length) {
    static const struct {
        const char *name;
        unsigned roles;
    } ROLES[] = {{"read", ROLE_READ},
                 {"submit", ROLE_READ | ROLE_SUBMIT},
                 {"work", ROLE_READ | ROLE_WORK},
                 {"admin", ROLE_READ | ROLE_SUBMIT | ROLE_ADMIN}};
    for (size_t r = 0; r < sizeof ROLES / sizeof *ROLES; r++)
        if (strlen(ROLES[r].name) == length && memcmp(word, ROLES[r].name, length) == 0)
            return ROLES[r].roles;
    return ROLE_NONE;
}

static int visit_line(char *text, size_t number, token_visit *visit, void *context,
                      struct error *err) {
    size_t length = strcspn(text, ":");
    struct token_line line = {.name = "", .token = text, .number = number};
    if (*text == '\0' || *text == '#')
        return 0;
    line.roles = text[length] != '\0' ? roles_of(text, length)
                                      : ROLE_READ | ROLE_SUBMIT | ROLE_WORK | ROLE_ADMIN;
    if (text[length] != '\0' && line.roles != ROLE_NONE) {
        char *rest = text + length + 1, *colon = strchr(rest, ':');
        line.token = colon != NULL ? colon + 1 : rest;
        line.name = colon != NULL ? rest : "";
        if (colon != NULL)
            *colon = '\0';
    }
    return visit(context, &line, err);
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

static int choose(void *context, const struct token_line *line, struct error *err) {
    struct choice_of_token *choice = context;
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
    const struct token_line alone = {.name = "", .token = given};
    int status =
        file != NULL ? token_file_read(file, choose, &choice, err) : choose(&choice, &alone, err);
    if (status == 0 && choice.token == NULL)
        status = error_set(err, ERROR_INPUT, "%s holds no token", file);
    if (status != 0)
        free(choice.token);
    else
        *token = choice.token;
    return status;
}
