/* `rugo token`: makes tokens for a server's file of them, lists and revokes them. */
#include "server/command/command.h"
#include "server/command/service/secret_file.h"
#include "server/command/service/token_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
    const char *file, *out;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    {"token-file", 0, OPTION_TEXT, 0, 0, AT(file), "FILE", NULL,
     "the server's, which new makes where there is none"},
    {"out", 'o', OPTION_TEXT, 0, 0, AT(out), "FILE", NULL,
     "of new: write the token, as a client's file of tokens, in place of printing it"},
    {0}};

/* Who is to have it sees it once: the server's file has its digest alone. */
static int make(const struct options *options, const char *role, const char *name,
                struct error *err) {
    char *token = NULL, line[256];
    int status = token_file_add(options->file, role, name, &token, err);
    if (status != 0)
        return status;
    if (options->out != NULL) {
        int length = snprintf(line, sizeof line, "%s:%s:%s\n", role, name, token);
        status = secret_file_write(options->out, line, (size_t)length, err);
        explicit_bzero(line, sizeof line);
    } else {
        puts(token);
        status = output_flush(err);
    }
    if (status != 0) /* its digest stands in the file and does no harm */
        error_context(err, "a token was made that nobody has seen");
    explicit_bzero(token, strlen(token));
    free(token);
    return status;
}

static int show_line(void *context, const struct token_line *line, struct error *err) {
    (void)context;
    (void)err;
    printf("%-7s %-20s %s\n", *line->role != '\0' ? line->role : "all",
           *line->name != '\0' ? line->name : "-", line->token != NULL ? "in clear" : "digest");
    return 0;
}

static int perform(const struct options *options, const char *const *arguments, struct error *err) {
    const char *verb = arguments[0];
    unsigned count = 0;
    int status;
    if (strcmp(verb, "new") == 0)
        return make(options, arguments[1], arguments[2], err);
    if (strcmp(verb, "revoke") == 0)
        status = token_file_revoke(options->file, arguments[1], &count, err);
    else
        status = token_file_read(options->file, false, show_line, NULL, err);
    return status == 0 ? output_flush(err) : status;
}

static int run(const void *values, const char *const *arguments) {
    static const struct {
        const char *name;
        int count; /* of arguments, with itself */
    } VERBS[] = {{"new", 3}, {"list", 1}, {"revoke", 2}};
    const struct options *options = values;
    struct error err = {0};
    int wanted = 0, given = 1;
    while (given < ARGUMENTS_MOST && arguments[given] != NULL)
        given++;
    for (size_t v = 0; v < sizeof VERBS / sizeof *VERBS; v++)
        if (strcmp(VERBS[v].name, arguments[0]) == 0)
            wanted = VERBS[v].count;
    if (wanted == 0)
        return usage_error("token", "\"%.40s\" is none of new, list and revoke", arguments[0]);
    if (given != wanted)
        return usage_error("token", "it is new ROLE NAME, list, or revoke NAME");
    if (options->file == NULL)
        return usage_error("token", "--token-file FILE is missing");
    return perform(options, arguments, &err) == 0 ? EXIT_DONE : command_fail("token", &err);
}

const struct command COMMAND_TOKEN = {
    .name = "token",
    .arguments = "new ROLE NAME|list|revoke NAME",
    .summary = "make, list and revoke the tokens of a server",
    .least = 1,
    .most = 3,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
