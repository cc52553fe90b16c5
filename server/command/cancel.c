/* `rugo cancel`: stops a study; what its workers hold is dropped. */
#include "server/command/question.h"

struct options {
    struct access_options place;
};
static const struct option_row OPTIONS[] = {ACCESS_ROWS(struct options), {0}};

static int ask(struct access *access, const char *id, const void *options, cJSON **out,
               struct error *err) {
    (void)options;
    return access_cancel(access, id, out, err);
}

static int run(const void *values, const char *const *arguments) {
    static const struct question QUESTION = {"cancel", ACCESS_WRITE, ask, show_progress};
    const struct options *options = values;
    return question_answer(&QUESTION, &options->place, arguments[0], options);
}

const struct command COMMAND_CANCEL = {
    .name = "cancel",
    .arguments = "ID",
    .summary = "stop a study",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
