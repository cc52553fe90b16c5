/* `rugo show`: the document of a study, as it was submitted. */
#include "schema/json/json.h"
#include "server/command/study/question.h"
#include <stdio.h>
#include <stdlib.h>

struct options {
    struct access_options place;
};
static const struct option_row OPTIONS[] = {ACCESS_ROWS(struct options), {0}};

static int ask(struct access *access, const char *id, const void *options, cJSON **out,
               struct error *err) {
    (void)options;
    return access_document(access, id, out, err);
}

static int show(const cJSON *document, const char *id, const void *options, struct error *err) {
    (void)id;
    (void)options;
    char *text = json_print_pretty(document);
    if (text == NULL)
        return error_memory(err, 0, "a study");
    fputs(text, stdout);
    free(text);
    return output_flush(err);
}

static int run(const void *values, const char *const *arguments) {
    static const struct question QUESTION = {"show", ACCESS_READ, false, ask, show};
    const struct options *options = values;
    return question_answer(&QUESTION, &options->place, arguments[0], options);
}

const struct command COMMAND_SHOW = {
    .name = "show",
    .arguments = "ID",
    .summary = "the document of a study, as it was submitted",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
