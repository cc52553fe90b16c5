/* The commands that ask a store or a server one question: submit, status, curves, report, snapshot,
 * cancel, retry. */
#include "schema/result/csv.h"
#include "schema/result/result_json.h"
#include "server/command/access.h"
#include "server/command/command.h"
#include "server/show/summary.h"
#include "server/show/summary_status.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One of two words, the first by default. */
static bool format_check(const char *command, const char *format, const char *first,
                         const char *second, bool *is_second) {
    *is_second = format && strcmp(format, second) == 0;
    if (!format || *is_second || strcmp(format, first) == 0)
        return true;
    return usage_error(command, "--format %.40s is neither %s nor %s", format, first, second);
}

/* --- submit --- */

static int print_id(const cJSON *document, struct error *err) {
    const char *id = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(document, "id"));
    if (!id)
        return error_set(err, ERROR_SYSTEM, "the server's answer has no id");
    puts(id);
    return output_flush(err);
}

int command_submit(int argc, char **argv) {
    struct access_options place = {0};
    const char *file, **sets = array_create((size_t)argc + 1, sizeof *sets);
    struct option_row rows[] = {ACCESS_OPTION_ROWS(&place), {"set", OPTION_LIST, sets}, {0}};
    if (!sets || !options_parse(argc, argv, rows, 1, 1, &file) ||
        !access_options_check(argv[0], &place)) {
        free(sets);
        return EXIT_USAGE;
    }
    struct error err = {0};
    struct fault_list faults = {0};
    struct access *access = NULL;
    char *text = NULL;
    size_t size;
    cJSON *document = NULL;
    int status = file_read(file, JSON_LIMITS.bytes, &text, &size, &err);
    if (!status)
        status = access_open(&access, &place, ACCESS_CREATE, &err);
    if (!status)
        status = access_submit(access, text, size, sets, &document, &faults, &err);
    if (status == ERROR_INPUT)
        error_context(&err, "%s", file);
    if (!status)
        status = print_id(document, &err);
    int result = !status        ? EXIT_DONE
                 : faults.count ? command_fail_faults(file, &faults)
                                : command_fail(argv[0], &err);
    cJSON_Delete(document);
    access_close(&access);
    fault_list_clear(&faults);
    free(text);
    free(sets);
    return result;
}

/* --- one study, one document --- */

/* Asks and shows; each command below fills in how. */
struct question {
    const char *id;
    struct curve_filter filter;
    bool other_format; /* not the command's default one */
    enum access_mode mode;
    int (*ask)(struct access *access, const struct question *question, cJSON **out,
               struct error *err);
    int (*show)(const struct question *question, const cJSON *document, struct error *err);
};

static int answer(const char *command, const struct access_options *place,
                  const struct question *question) {
    struct error err = {0};
    struct access *access = NULL;
    cJSON *document = NULL;
    int status = access_open(&access, place, question->mode, &err);
    if (!status)
        status = question->ask(access, question, &document, &err);
    if (!status)
        status = question->show(question, document, &err);
    cJSON_Delete(document);
    access_close(&access);
    return status ? command_fail(command, &err) : EXIT_DONE;
}

static int ask_status(struct access *access, const struct question *question, cJSON **out,
                      struct error *err) {
    return question->id ? access_status(access, question->id, out, err)
                        : access_list(access, out, err);
}

static int show_status(const struct question *question, const cJSON *document, struct error *err) {
    if (question->other_format)
        return output_document(document, err);
    if (question->id)
        summary_of_status(document, stdout);
    else
        summary_of_list(document, stdout);
    return output_flush(err);
}

int command_status(int argc, char **argv) {
    struct access_options place = {0};
    struct question question = {.mode = ACCESS_READ, .ask = ask_status, .show = show_status};
    const char *format = NULL;
    struct option_row rows[] = {ACCESS_OPTION_ROWS(&place), {"format", OPTION_TEXT, &format}, {0}};
    if (!options_parse(argc, argv, rows, 0, 1, &question.id) ||
        !access_options_check(argv[0], &place) ||
        !format_check(argv[0], format, "text", "json", &question.other_format))
        return EXIT_USAGE;
    return answer(argv[0], &place, &question);
}

static int ask_curves(struct access *access, const struct question *question, cJSON **out,
                      struct error *err) {
    return access_curves(access, question->id, &question->filter, out, err);
}

static int show_curves(const struct question *question, const cJSON *document, struct error *err) {
    struct study_result study = {0};
    if (!question->other_format)
        return output_document(document, err);
    int status = study_result_read(document, &study, err);
    if (status == 0) {
        csv_print(stdout, study.case_count, study.cases, NULL);
        status = output_flush(err);
    }
    study_result_clear(&study);
    return status;
}

int command_curves(int argc, char **argv) {
    struct access_options place = {0};
    struct question question = {.mode = ACCESS_READ, .ask = ask_curves, .show = show_curves};
    question.filter.case_number = -1;
    const char *format = NULL;
    struct option_row rows[] = {ACCESS_OPTION_ROWS(&place),
                                {"case", OPTION_INDEX, &question.filter.case_number},
                                {"quantity", OPTION_TEXT, &question.filter.quantity},
                                {"format", OPTION_TEXT, &format},
                                {0}};
    if (!options_parse(argc, argv, rows, 1, 1, &question.id) ||
        !access_options_check(argv[0], &place) ||
        !format_check(argv[0], format, "json", "csv", &question.other_format))
        return EXIT_USAGE;
    return answer(argv[0], &place, &question);
}

static int ask_report(struct access *access, const struct question *question, cJSON **out,
                      struct error *err) {
    return access_report(access, question->id, out, err);
}

static int show_report(const struct question *question, const cJSON *document, struct error *err) {
    if (question->other_format)
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

int command_report(int argc, char **argv) {
    struct access_options place = {0};
    struct question question = {.mode = ACCESS_READ, .ask = ask_report, .show = show_report};
    const char *format = NULL;
    struct option_row rows[] = {ACCESS_OPTION_ROWS(&place), {"format", OPTION_TEXT, &format}, {0}};
    if (!options_parse(argc, argv, rows, 1, 1, &question.id) ||
        !access_options_check(argv[0], &place) ||
        !format_check(argv[0], format, "text", "json", &question.other_format))
        return EXIT_USAGE;
    return answer(argv[0], &place, &question);
}

static int ask_cancel(struct access *access, const struct question *question, cJSON **out,
                      struct error *err) {
    return access_cancel(access, question->id, out, err);
}

static int ask_retry(struct access *access, const struct question *question, cJSON **out,
                     struct error *err) {
    return access_retry(access, question->id, out, err);
}

static int change_study(int argc, char **argv, struct question question) {
    struct access_options place = {0};
    struct option_row rows[] = {ACCESS_OPTION_ROWS(&place), {0}};
    if (!options_parse(argc, argv, rows, 1, 1, &question.id) ||
        !access_options_check(argv[0], &place))
        return EXIT_USAGE;
    return answer(argv[0], &place, &question);
}

int command_cancel(int argc, char **argv) {
    return change_study(
        argc, argv,
        (struct question){.mode = ACCESS_WRITE, .ask = ask_cancel, .show = show_status});
}

int command_retry(int argc, char **argv) {
    return change_study(
        argc, argv, (struct question){.mode = ACCESS_WRITE, .ask = ask_retry, .show = show_status});
}

/* --- snapshot --- */

int command_snapshot(int argc, char **argv) {
    struct access_options place = {0};
    const char *file;
    struct option_row rows[] = {ACCESS_OPTION_ROWS(&place), {0}};
    if (!options_parse(argc, argv, rows, 1, 1, &file) || !access_options_check(argv[0], &place))
        return EXIT_USAGE;
    struct error err = {0};
    struct access *access = NULL;
    int status = access_open(&access, &place, ACCESS_READ, &err);
    if (!status)
        status = access_snapshot(access, file, &err);
    access_close(&access);
    return status ? command_fail(argv[0], &err) : EXIT_DONE;
}
