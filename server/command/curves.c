/* `rugo curves`: the aggregated curves of a study, as they are now. */
#include "schema/result/csv.h"
#include "schema/result/result_json.h"
#include "server/command/question.h"
#include <stdio.h>

struct options {
    struct access_options place;
    int64_t case_number; /* -1: all */
    const char *quantity;
    int csv;
};
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    ACCESS_ROWS(struct options),
    {"case", 0, OPTION_INDEX, 0, 0, AT(case_number), "K", NULL, "this case only"},
    {"quantity", 0, OPTION_TEXT, 0, 0, AT(quantity), "Q", NULL, "this quantity only"},
    {"format", 0, OPTION_CHOICE, 0, 0, AT(csv), "json|csv", "json", "what to print"},
    {0}};

static int ask(struct access *access, const char *id, const void *values, cJSON **out,
               struct error *err) {
    const struct options *options = values;
    const struct curve_filter filter = {.case_number = options->case_number,
                                        .quantity = options->quantity};
    return access_curves(access, id, &filter, out, err);
}

static int show(const cJSON *document, const char *id, const void *values, struct error *err) {
    (void)id;
    const struct options *options = values;
    struct study_result study = {0};
    if (!options->csv)
        return output_document(document, err);
    int status = study_result_read(document, &study, err);
    if (status == 0) {
        csv_print(stdout, study.case_count, study.cases, NULL);
        status = output_flush(err);
    }
    study_result_clear(&study);
    return status;
}

static int run(const void *values, const char *const *arguments) {
    static const struct question QUESTION = {"curves", ACCESS_READ, ask, show};
    const struct options *options = values;
    return question_answer(&QUESTION, &options->place, arguments[0], options);
}

const struct command COMMAND_CURVES = {
    .name = "curves",
    .arguments = "ID",
    .summary = "aggregated curves, also of a study still running",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
