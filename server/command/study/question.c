#include "server/command/study/question.h"
#include "server/show/summary/summary_status.h"
#include <stdio.h>

int question_answer(const struct question *question, const struct access_options *place,
                    const char *given, const void *options) {
    struct error err = {0};
    char id[STUDY_ID_SIZE];
    struct access *access = NULL;
    cJSON *document = NULL;
    if (access_options_check(question->command, place) != 0)
        return EXIT_USAGE;
    int status = access_open(&access, place, question->mode, &err);
    if (status == 0 && given != NULL)
        status = access_find(access, question->alone ? NULL : question->command, given, id, &err);
    const char *study = given != NULL ? id : NULL;
    if (status == 0)
        status = question->ask(access, study, options, &document, &err);
    if (status == 0)
        status = question->show(document, study, options, &err);
    cJSON_Delete(document);
    access_close(&access);
    return status == 0 ? EXIT_DONE : command_fail(question->command, &err);
}

int show_progress(const cJSON *document, const char *id, const void *options, struct error *err) {
    (void)id;
    (void)options;
    summary_of_status(document, stdout);
    return output_flush(err);
}

const struct option_row CHANGE_OPTIONS[] = {ACCESS_ROWS(struct change_options), {0}};

static int ask_change(struct access *access, const char *id, const void *change, cJSON **out,
                      struct error *err) {
    return ((const struct change_question *)change)->make(access, id, out, err);
}

int change_answer(const struct change_question *change, const struct change_options *options,
                  const char *id) {
    const struct question question = {.command = change->command,
                                      .mode = ACCESS_WRITE,
                                      .alone = change->alone,
                                      .ask = ask_change,
                                      .show = show_progress};
    return question_answer(&question, &options->place, id, change);
}
