/* `rugo theory`: what theory expects of the surfaces of a study; makes none. */
#include "jobs/kind.h"
#include "jobs/statistics/statistics_expectation.h"
#include "schema/json/json.h"
#include "schema/program.h"
#include "schema/result/csv.h"
#include "schema/result/result_json.h"
#include "server/command/command.h"
#include "server/command/study/result_folder.h"
#include "server/show/output.h"
#include "server/show/plot/picture.h"
#include "server/show/summary/summary.h"
#include "worker/publish/aggregate.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
    const char **sets;
    const char *quantity;
    struct result_folder folder;
    int format;
};
enum { FORMAT_TEXT, FORMAT_JSON, FORMAT_CSV, FORMAT_SVG };
#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    {"set", 0, OPTION_LIST, 0, 0, AT(sets), "PATH=VALUE", NULL,
     "change the study, e.g. --set surface/hurst=[0.2,0.8]; without a study, all that it has"},
    {"quantity", 0, OPTION_TEXT, 0, 0, AT(quantity), "Q", NULL,
     "this quantity only; summit_joint_pdf is made only if named here"},
    {"format", 0, OPTION_CHOICE, 0, 0, AT(format), "text|json|csv|svg", "text",
     "what to print; svg: a picture of --quantity (summit_height_pdf)"},
    {"out", 'o', OPTION_TEXT, 0, 0, AT(folder.path), "DIR", NULL,
     "write study.json, curves.json, curves.csv and an SVG a quantity instead"},
    REPLACE_ROW(AT(folder.replace)),
    {0}};

static const char JOINT[] = "summit_joint_pdf";

/* Says what the study sweeps, and which program computed its theories. */
static int tell_origin(const struct study *study, struct study_result *out, struct error *err) {
    char program[PROGRAM_SIZE];
    int count = 0;
    while (study->swept[count] != NULL)
        count++;
    program_write(program);
    out->swept = cJSON_CreateStringArray((const char *const *)study->swept, count);
    out->provenance = cJSON_CreateObject();
    return out->swept != NULL && out->provenance != NULL &&
                   cJSON_AddStringToObject(out->provenance, "program", program) != NULL
               ? 0
               : error_memory(err, sizeof program, "the provenance of theories");
}

/* Fills the cases with what theory expects of them. */
static int expect(const struct study *study, const char *quantity, struct study_result *out,
                  struct error *err) {
    bool joint = quantity != NULL && strcmp(quantity, JOINT) == 0;
    int status = 0;
    out->id = strdup(FOLDER_OF_THEORY);
    out->state = strdup("expected");
    out->name = strdup(study->name);
    out->kind = strdup("statistics");
    out->cases = array_create(study->case_count, sizeof *out->cases);
    if (out->id == NULL || out->state == NULL || out->name == NULL || out->kind == NULL ||
        out->cases == NULL)
        return error_memory(err, study->case_count * sizeof *out->cases, "cases");
    status = tell_origin(study, out, err);
    for (size_t c = 0; c < study->case_count && status == 0; c++) {
        struct case_result *one = &out->cases[c];
        status = statistics_expectation(study->cases[c].parameters, joint, one, err);
        one->case_number = c;
        out->case_count++;
        if (status == 0 && quantity != NULL && result_curve(one, quantity) == NULL)
            status = quantity_absent(one, quantity, err);
        if (status == 0 && quantity != NULL)
            result_keep(one, quantity, false);
    }
    return status;
}

/* Says where theories are not of the surface that is pressed, the sum of two faces. */
static void tell_faces(const struct study *study) {
    for (size_t c = 0; c < study->case_count; c++)
        if (cJSON_GetObjectItemCaseSensitive(study->cases[c].parameters, "counter_surface") !=
            NULL) {
            fputs("rugo theory: theories are those of the first face alone, /surface\n", stderr);
            return;
        }
}

static int write_folder(const struct study *study, const struct study_result *result,
                        const struct result_folder *folder, struct error *err) {
    cJSON *document = NULL;
    int status = json_parse(study->source, strlen(study->source), NULL, &document, err);
    if (status == 0)
        status = result_folder_take(folder, FOLDER_OF_THEORY, document, err);
    cJSON_Delete(document);
    return status == 0 ? output_write(result, folder->path, err) : status;
}

static int show(const struct study_result *study, const struct options *options,
                struct error *err) {
    bool done = true;
    int status = 0;
    if (options->format == FORMAT_CSV)
        done = csv_print(stdout, study);
    else if (options->format == FORMAT_JSON)
        done = study_print(stdout, study) && putchar('\n') != EOF;
    else if (options->format == FORMAT_SVG)
        status = picture_of_results(
            study, options->quantity != NULL ? options->quantity : "summit_height_pdf", stdout,
            err);
    else
        summary_of_theory(study, stdout);
    if (status != 0)
        return status;
    return done ? output_flush(err) : error_memory(err, 0, "theories");
}

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    struct error err = {0};
    struct fault_list faults = {0};
    struct study *study = NULL;
    struct study_result result = {0};
    const char *file = arguments[0];
    int status = study_file_read(&study, file, options->sets, &faults, &err);
    if (status == 0)
        status = expect(study, options->quantity, &result, &err);
    if (status == 0)
        tell_faces(study);
    if (status == 0)
        status = options->folder.path != NULL ? write_folder(study, &result, &options->folder, &err)
                                              : show(&result, options, &err);
    study_result_clear(&result);
    study_destroy(&study);
    int answer = command_end("theory", status, file != NULL ? file : "--set", &faults, &err);
    fault_list_clear(&faults);
    return answer;
}

const struct command COMMAND_THEORY = {
    .name = "theory",
    .arguments = "[STUDY.json]",
    .summary = "what theory expects of a study's surfaces: summits, spectra, Nayak's parameter",
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
