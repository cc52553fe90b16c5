/* `rugo retry`: queues failed jobs of a study again, and those of cases that could not be
 * published. */
#include "server/command/study/question.h"

static int run(const void *options, const char *const *arguments) {
    static const struct change_question CHANGE = {"retry", false, access_retry};
    return change_answer(&CHANGE, options, arguments[0]);
}

const struct command COMMAND_RETRY = {
    .name = "retry",
    .arguments = "ID",
    .summary = "queue failed jobs of a study again, publish what could not be",
    .least = 1,
    .most = 1,
    .options = CHANGE_OPTIONS,
    .options_size = sizeof(struct change_options),
    .run = run,
};
