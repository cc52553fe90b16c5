/* A command that asks a store or a server one question and shows the document that answers. */
#ifndef RUGO_SERVER_COMMAND_QUESTION_H
#define RUGO_SERVER_COMMAND_QUESTION_H

#include "server/command/access.h"

/* id: of a study, as given on the command line; options: the command's. */
struct question {
    const char *command;
    enum access_mode mode;
    int (*ask)(struct access *access, const char *id, const void *options, cJSON **out,
               struct error *err);
    int (*show)(const cJSON *document, const char *id, const void *options, struct error *err);
};
/* Checks the place, asks, shows; an exit status. */
int question_answer(const struct question *question, const struct access_options *place,
                    const char *id, const void *options);
/* A study's progress, as text. */
int show_progress(const cJSON *document, const char *id, const void *options, struct error *err);

#endif
