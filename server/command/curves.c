/* `rugo curves`: the aggregated curves of a study, as they are now. */
#include "schema/result/csv.h"
#include "schema/result/result_json.h"
#include "server/command/access.h"
#include <stdio.h>
#include <stdlib.h>

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

static int show(const struct study_result *study, bool csv, struct error *err) {
    bool done = true;
    if (csv)
        done = csv_print(stdout, study->case_count, study->cases, NULL);
    else
        done = study_print(stdout, study) && putchar('\n') != EOF;
    return done ? output_flush(err) : error_memory(err, 0, "curves");
}

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    const struct result_filter filter = {.case_number = options->case_number,
                                         .part = {.quantity = options->quantity},
                                         .complete = true};
    struct error err = {0};
    struct access *access = NULL;
    struct study_result study = {0};
    if (access_options_check("curves", &options->place) != 0)
        return EXIT_USAGE;
    int status = access_open(&access, &options->place, ACCESS_READ, &err);
    if (status == 0)
        status = access_results(access, arguments[0], &filter, &study, &err);
    if (status == 0)
        status = show(&study, options->csv, &err);
    for (size_t c = 0; c < study.case_count && status == 0; c++)
        command_warn_missing("curves", &study.cases[c]);
    study_result_clear(&study);
    access_close(&access);
    return status != 0 ? command_fail("curves", &err) : EXIT_DONE;
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
