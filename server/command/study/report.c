/* `rugo report`: what each case cost and how exact it is. */
#include "server/command/access/access.h"
#include "server/show/plot/plot_cost.h"
#include "server/show/summary/summary.h"
#include <stdio.h>

struct options {
    struct access_options place;
    int format;
};
enum { FORMAT_TEXT, FORMAT_JSON, FORMAT_SVG };
static const struct option_row OPTIONS[] = {ACCESS_ROWS(struct options),
                                            {"format", 0, OPTION_CHOICE, 0, 0,
                                             offsetof(struct options, format), "text|json|svg",
                                             "text", "what to print"},
                                            {0}};

static int show(const struct study_report *report, int format, struct error *err) {
    bool done = true;
    int status = 0;
    if (format == FORMAT_SVG)
        status = plot_cost(report, stdout, err);
    else if (format == FORMAT_JSON)
        done = study_report_print(stdout, report) && putchar('\n') != EOF;
    else
        summary_of_report(report, stdout);
    if (status != 0)
        return status;
    return done ? output_flush(err) : error_memory(err, 0, "a document");
}

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    struct error err = {0};
    char id[STUDY_ID_SIZE];
    struct access *access = NULL;
    struct study_report report = {0};
    if (access_options_check("report", &options->place) != 0)
        return EXIT_USAGE;
    int status = access_open(&access, &options->place, ACCESS_READ, &err);
    if (status == 0)
        status = access_find(access, "report", arguments[0], id, &err);
    if (status == 0)
        status = access_report(access, id, &report, &err);
    if (status == 0)
        status = show(&report, options->format, &err);
    for (size_t c = 0; c < report.case_count && status == 0; c++)
        command_warn_missing("report", &report.cases[c].about);
    study_report_clear(&report);
    access_close(&access);
    return status != 0 ? command_fail("report", &err) : EXIT_DONE;
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
