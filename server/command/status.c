/* `rugo status`: how far one study is, or all of them. */
#include "server/command/question.h"
#include "server/show/summary_status.h"
#include <stdio.h>

struct options {
    struct access_options place;
    int json;
};
static const struct option_row OPTIONS[] = {ACCESS_ROWS(struct options),
                                            {"format", 0, OPTION_CHOICE, 0, 0,
                                             offsetof(struct options, json), "text|json", "text",
                                             "what to print"},
                                            {0}};

static int ask(struct access *access, const char *id, const void *options, cJSON **out,
               struct error *err) {
    (void)options;
    return id != NULL ? access_status(access, id, out, err) : access_list(access, out, err);
}

static int show(const cJSON *document, const char *id, const void *values, struct error *err) {
    const struct options *options = values;
    if (options->json != 0)
        return output_document(document, err);
    if (id != NULL)
        return show_progress(document, id, options, err);
    summary_of_list(document, stdout);
    return output_flush(err);
}

static int run(const void *values, const char *const *arguments) {
    static const struct question QUESTION = {"status", ACCESS_READ, ask, show};
    const struct options *options = values;
    return question_answer(&QUESTION, &options->place, arguments[0], options);
}

const struct command COMMAND_STATUS = {
    .name = "status",
    .arguments = "[ID]",
    .summary = "progress, workers, time left, failures; without ID all studies",
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
