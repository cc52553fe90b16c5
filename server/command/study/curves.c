/* `rugo curves`: the aggregated curves of a study, as they are now, or one case less another. */
#include "schema/result/csv.h"
#include "schema/result/result_json.h"
#include "server/command/access/access.h"
#include "server/command/study/result_folder.h"
#include "server/show/output.h"
#include "server/show/summary/summary.h"
#include <stdio.h>
#include <stdlib.h>

struct options {
    struct access_options place;
    int64_t case_number; /* -1: all */
    int64_t difference[2];
    const char *quantity;
    struct result_folder folder;
    int format;
};
enum { FORMAT_JSON, FORMAT_CSV, FORMAT_TABLE };
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    ACCESS_ROWS(struct options),
    {"case", 0, OPTION_INDEX, 0, 0, AT(case_number), "K", NULL, "this case only"},
    {"quantity", 0, OPTION_TEXT, 0, 0, AT(quantity), "Q", NULL, "this quantity only"},
    {"difference", 0, OPTION_PAIR, 0, 0, AT(difference), "A B", NULL,
     "case A less case B, by pairs of realisations where they share their random numbers"},
    {"format", 0, OPTION_CHOICE, 0, 0, AT(format), "json|csv|table", "json", "what to print"},
    {"out", 'o', OPTION_TEXT, 0, 0, AT(folder.path), "DIR", NULL,
     "write study.json, curves.json, curves.csv and an SVG a quantity instead"},
    REPLACE_ROW(AT(folder.replace)),
    {0}};

static int show(const struct study_result *study, const struct options *options,
                struct error *err) {
    bool done = true;
    if (options->folder.path != NULL)
        return output_write(study, options->folder.path, err);
    if (options->format == FORMAT_CSV)
        done = csv_print(stdout, study);
    else if (options->format == FORMAT_TABLE && options->difference[0] >= 0)
        summary_of_difference(study, stdout);
    else if (options->format == FORMAT_TABLE)
        summary_of_curves(study, NULL, stdout);
    else
        done = study_print(stdout, study) && putchar('\n') != EOF;
    return done ? output_flush(err) : error_memory(err, 0, "curves");
}

/* Sees whose results the folder holds, and makes it this study's. */
static int take_folder(struct access *access, const char *id, const struct result_folder *folder,
                       struct error *err) {
    cJSON *document = NULL;
    if (folder->path == NULL)
        return 0;
    int status = access_document(access, id, &document, err);
    if (status == 0)
        status = result_folder_take(folder, id, document, err);
    cJSON_Delete(document);
    return status;
}

static int ask(struct access *access, const char *id, const struct options *options,
               struct study_result *out, struct error *err) {
    if (options->difference[0] >= 0) {
        const struct comparison comparison = {.minuend = (uint64_t)options->difference[0],
                                              .subtrahend = (uint64_t)options->difference[1],
                                              .quantity = options->quantity};
        return access_difference(access, id, &comparison, out, err);
    }
    const struct result_filter filter = {.case_number = options->case_number,
                                         .part = {.quantity = options->quantity},
                                         .complete = true};
    return access_results(access, id, &filter, out, err);
}

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    struct error err = {0};
    char id[STUDY_ID_SIZE];
    struct access *access = NULL;
    struct study_result study = {0};
    if (access_options_check("curves", &options->place) != 0)
        return EXIT_USAGE;
    if (options->difference[0] >= 0 && options->case_number >= 0)
        return usage_error("curves", "--difference and --case exclude each other");
    int status = options->folder.path != NULL ? output_check(options->folder.path, &err) : 0;
    if (status == 0)
        status = access_open(&access, &options->place, ACCESS_READ, &err);
    if (status == 0)
        status = access_find(access, "curves", arguments[0], id, &err);
    if (status == 0)
        status = ask(access, id, options, &study, &err);
    if (status == 0)
        status = take_folder(access, id, &options->folder, &err);
    if (status == 0)
        status = show(&study, options, &err);
    for (size_t c = 0; c < study.case_count && status == 0; c++)
        command_warn_missing("curves", &study.cases[c]);
    study_result_clear(&study);
    access_close(&access);
    return status != 0 ? command_fail("curves", &err) : EXIT_DONE;
}

const struct command COMMAND_CURVES = {
    .name = "curves",
    .arguments = "ID",
    .summary = "aggregated curves, also of a study still running, or one case less another",
    .least = 1,
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
