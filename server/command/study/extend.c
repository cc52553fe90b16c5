/* `rugo extend`: queues the realisations that a study lacks to a larger number of them. */
#include "server/command/study/question.h"

struct options {
    struct access_options place;
    unsigned realisations;
};
static const struct option_row OPTIONS[] = {ACCESS_ROWS(struct options),
                                            {"realisations", 0, OPTION_COUNT, 1,
                                             STUDY_REALISATIONS_MOST,
                                             offsetof(struct options, realisations), "N", NULL,
                                             "of each case in all; those that are there stay"},
                                            {0}};

static int ask(struct access *access, const char *id, const void *values, cJSON **out,
               struct error *err) {
    const struct options *options = values;
    return access_extend(access, id, options->realisations, out, err);
}

static int run(const void *values, const char *const *arguments) {
    static const struct question QUESTION = {"extend", ACCESS_WRITE, false, ask, show_progress};
    const struct options *options = values;
    if (options->realisations == 0)
        return usage_error("extend", "--realisations N is missing");
    return question_answer(&QUESTION, &options->place, arguments[0], options);
}

const struct command COMMAND_EXTEND = {
    .name = "extend",
    .arguments = "ID",
    .summary = "give a study more realisations, computing only those that it lacks",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
