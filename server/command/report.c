/* `rugo report`: what each case cost and how exact it is. */
#include "schema/result/result_json.h"
#include "server/command/question.h"
#include "server/show/summary.h"
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
    return access_report(access, id, out, err);
}

static int show(const cJSON *document, const char *id, const void *values, struct error *err) {
    (void)id;
    const struct options *options = values;
    if (options->json)
        return output_document(document, err);
    struct study_report report = {0};
    int status = study_report_read(document, &report, err);
    if (status == 0) {
        summary_of_report(&report, stdout);
        status = output_flush(err);
    }
    study_report_clear(&report);
    return status;
}

static int run(const void *values, const char *const *arguments) {
    static const struct question QUESTION = {"report", ACCESS_READ, ask, show};
    const struct options *options = values;
    return question_answer(&QUESTION, &options->place, arguments[0], options);
}

const struct command COMMAND_REPORT = {
    .name = "report",
    .arguments = "ID",
    .summary = "speed against error, by case",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
