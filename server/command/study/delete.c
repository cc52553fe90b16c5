/* `rugo delete`: a study that has ended goes with its results, and the space it took is free. */
#include "server/command/study/question.h"
#include <stdio.h>

static int show(const cJSON *document, const char *id, const void *options, struct error *err) {
    (void)document;
    (void)options;
    printf("study %s is deleted\n", id);
    return output_flush(err);
}

static int ask(struct access *access, const char *id, const void *options, cJSON **out,
               struct error *err) {
    (void)options;
    return access_delete(access, id, out, err);
}

static int run(const void *values, const char *const *arguments) {
    static const struct question QUESTION = {"delete", ACCESS_WRITE, true, ask, show};
    const struct change_options *options = values;
    return question_answer(&QUESTION, &options->place, arguments[0], options);
}

const struct command COMMAND_DELETE = {
    .name = "delete",
    .arguments = "ID",
    .summary = "delete a study that has ended, with its results",
    .least = 1,
    .most = 1,
    .options = CHANGE_OPTIONS,
    .options_size = sizeof(struct change_options),
    .run = run,
};
