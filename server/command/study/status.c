/* `rugo status`: how far one study is, or all of them, once or until it has ended. */
#include "server/command/study/question.h"
#include "server/command/study/watch.h"
#include "server/show/summary/summary_status.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct options {
    struct access_options place;
    int json;
    bool watch;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    ACCESS_ROWS(struct options),
    {"format", 0, OPTION_CHOICE, 0, 0, AT(json), "text|json", "text", "what to print"},
    {"watch", 'w', OPTION_FLAG, 0, 0, AT(watch), NULL, NULL,
     "look again twice a second, until the study has ended; print what has changed"},
    {0}};

static int print(const cJSON *document, const char *id, const struct options *options,
                 struct error *err) {
    if (options->json != 0)
        return output_document(document, err);
    if (id != NULL)
        return show_progress(document, id, options, err);
    summary_of_list(document, stdout);
    return output_flush(err);
}

/* Prints what is new: over the last one on a terminal, below it elsewhere. *last is its text. */
static int print_change(const cJSON *document, const char *id, const struct options *options,
                        char **last, struct error *err) {
    char *text = json_print(document);
    bool terminal = isatty(STDOUT_FILENO) && options->json == 0;
    if (text == NULL)
        return error_memory(err, 0, "a document");
    bool same = *last != NULL && strcmp(text, *last) == 0;
    free(*last);
    *last = text;
    if (same)
        return 0;
    if (terminal)
        fputs("\033[H\033[2J", stdout);
    return print(document, id, options, err);
}

/* Looks and prints until the study has ended: ERROR_STOPPED where a signal comes before. Without a
 * study, until a signal. */
static int watch_study(struct watch *watch, const struct options *options, struct error *err) {
    char *last = NULL;
    bool ended = false;
    int status = 0;
    signals_catch();
    for (bool first = true; status == 0 && !ended; first = false) {
        cJSON *document = NULL;
        status = watch_look(watch, first, &document, err);
        if (status == 0 && document != NULL)
            status = print_change(document, watch->id, options, &last, err);
        ended = document != NULL && watch->id != NULL && watch_has_ended(document);
        cJSON_Delete(document);
        if (status != 0 || ended || watch_pause())
            continue;
        ended = true;
        if (watch->id != NULL)
            status = error_set(err, ERROR_STOPPED, "stopped");
    }
    free(last);
    return status;
}

static int ask(struct access *access, const char *id, const void *values, cJSON **out,
               struct error *err) {
    const struct options *options = values;
    struct watch watch = {.command = "status", .access = access, .id = id};
    if (options->watch)
        return watch_study(&watch, options, err);
    return watch_look(&watch, true, out, err);
}

static int show(const cJSON *document, const char *id, const void *options, struct error *err) {
    return document != NULL ? print(document, id, options, err) : 0;
}

static int run(const void *values, const char *const *arguments) {
    static const struct question QUESTION = {"status", ACCESS_READ, false, ask, show};
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
