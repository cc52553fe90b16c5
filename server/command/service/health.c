/* `rugo health`: whether a server can be reached and says that it is well; for supervisors. */
#include "server/command/study/question.h"
#include <stdio.h>

#define SERVER "http://127.0.0.1:8080"

struct options {
    struct access_options place;
};
static const struct option_row OPTIONS[] = {ACCESS_SERVER_ROWS(struct options, "the server"), {0}};

static int ask(struct access *access, const char *id, const void *options, cJSON **out,
               struct error *err) {
    (void)id;
    (void)options;
    return access_health(access, out, err);
}

static int show(const cJSON *document, const char *id, const void *options, struct error *err) {
    (void)id;
    (void)options;
    return output_document(document, err);
}

static int run(const void *values, const char *const *arguments) {
    static const struct question QUESTION = {"health", ACCESS_READ, false, ask, show};
    const struct options *options = values;
    struct options own = *options;
    (void)arguments;
    if (own.place.server == NULL)
        own.place.server = SERVER;
    return question_answer(&QUESTION, &own.place, NULL, &own);
}

const struct command COMMAND_HEALTH = {
    .name = "health",
    .arguments = "",
    .summary = "whether a server (of this machine, unless given) is well; status 1 if not",
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
