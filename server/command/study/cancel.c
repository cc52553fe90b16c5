/* `rugo cancel`: stops a study; what its workers hold is dropped. */
#include "server/command/study/question.h"

static int run(const void *options, const char *const *arguments) {
    static const struct change_question CHANGE = {"cancel", true, access_cancel};
    return change_answer(&CHANGE, options, arguments[0]);
}

const struct command COMMAND_CANCEL = {
    .name = "cancel",
    .arguments = "ID",
    .summary = "stop a study",
    .least = 1,
    .most = 1,
    .options = CHANGE_OPTIONS,
    .options_size = sizeof(struct change_options),
    .run = run,
};
