#include "server/command/study/export_folder.h"
#include "core/file/memory_file.h"
#include "core/file/plain_text.h"
#include "core/file/written_file.h"
#include "schema/json/field.h"
#include "schema/result/provenance.h"
#include "schema/result/result_json.h"
#include "server/command/access/access_source.h"
#include "server/command/command.h"
#include "server/show/output.h"
#include "server/show/plot/plot_cost.h"
#include "server/show/summary/summary.h"
#include "server/show/table/case_table.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_SIZE = 4096 };

/* What the files are made of. */
struct exported {
    const struct export_order *order;
    struct study_result *study;
    struct study_report report; /* owned */
    cJSON *document;            /* owned */
};

/* Writes one file by a function that prints it. */
static int write_file(const struct exported *from, const char *name,
                      int (*print)(const struct exported *from, FILE *file, struct error *err),
                      struct error *err) {
    char path[PATH_SIZE];
    struct written_file file;
    if (snprintf(path, sizeof path, "%s/%s", from->order->folder.path, name) >= (int)sizeof path)
        return error_set(err, ERROR_INPUT, "the path %.100s... is too long",
                         from->order->folder.path);
    int status = written_file_open(&file, path, err);
    return status != 0 ? status : written_file_close(&file, print(from, file.stream, err), err);
}

/* --- tables --- */

static int print_table(const struct exported *from, const char *columns, FILE *file,
                       struct error *err) {
    const struct access_origin origin = {from->order->access, from->order->id};
    const struct picture_source source = access_source(&origin);
    const struct table_request request = {.columns = columns};
    struct case_table table = {0};
    int status = case_table_make(&table, &source, &request, err);
    if (status != 0)
        return status;
    status = case_table_print(&table, TABLE_CSV, file, err);
    case_table_clear(&table);
    return status;
}

static int print_shown(const struct exported *from, FILE *file, struct error *err) {
    return print_table(from, NULL, file, err);
}

/* Whether an earlier case than `limit`, or an earlier scalar of that case, has this name. */
static bool is_listed(const struct study_result *study, size_t limit, const char *name) {
    for (size_t c = 0; c < limit; c++)
        if (result_scalar(&study->cases[c], name) != NULL)
            return true;
    return false;
}

/* Writes the names of all scalars, with commas between; the caller frees. "" where there are none,
 * NULL when out of memory. */
static char *all_scalars(const struct study_result *study) {
    struct memory_file names;
    bool first = true;
    if (!memory_file_open(&names))
        return NULL;
    for (size_t c = 0; c < study->case_count; c++)
        for (size_t s = 0; s < study->cases[c].scalar_count; s++) {
            const char *name = study->cases[c].scalars[s].name;
            if (is_listed(study, c, name))
                continue;
            fprintf(names.file, "%s%s", first ? "" : ",", name);
            first = false;
        }
    return memory_file_close(&names, NULL);
}

static int print_scalars(const struct exported *from, FILE *file, struct error *err) {
    char *names = all_scalars(from->study);
    if (names == NULL)
        return error_memory(err, 0, "names of scalars");
    int status = print_table(from, *names != '\0' ? names : NULL, file, err);
    free(names);
    return status;
}

/* --- report and provenance --- */

static int print_report(const struct exported *from, FILE *file, struct error *err) {
    return study_report_print(file, &from->report) && fputc('\n', file) != EOF
               ? 0
               : error_memory(err, 0, "a report");
}

static int print_report_text(const struct exported *from, FILE *file, struct error *err) {
    (void)err;
    summary_of_report(&from->report, file);
    return 0;
}

static int print_cost(const struct exported *from, FILE *file, struct error *err) {
    return plot_cost(&from->report, file, err);
}

static int print_provenance(const struct exported *from, FILE *file, struct error *err) {
    const struct study_result *study = from->study;
    cJSON *document = cJSON_CreateObject();
    bool complete = document != NULL && field_put_text(document, "study", study->id) &&
                    field_put_text(document, "name", study->name) &&
                    field_put_text(document, "kind", study->kind) &&
                    field_put_text(document, "state", study->state) &&
                    (study->provenance == NULL ||
                     field_put(document, "provenance", cJSON_Duplicate(study->provenance, true)));
    char *text = complete ? json_print_pretty(document) : NULL;
    cJSON_Delete(document);
    if (text == NULL)
        return error_memory(err, 0, "the provenance");
    (void)fputs(text, file); /* the file remembers a failure */
    free(text);
    return 0;
}

/* --- what the files are --- */

static const char FILES[] =
    "\n"
    "Files\n"
    "-----\n"
    "study.json        the study, which `rugo run study.json` repeats\n"
    "provenance.json   seed, version of the program, when and on which machines it was computed\n"
    "curves.csv        all curves, a row a point: value, standard error, errors by source, theory\n"
    "curves.json       the same with all scalars and parameters of each case\n"
    "scalars.csv       a row a case: all scalars with their errors and theory\n"
    "table.csv         a row a case: what the study is about\n"
    "report.txt        speed and errors by source, for reading\n"
    "report.json       the same for programs\n"
    "report.svg        the same as a picture, where errors and costs are known\n"
    "*.svg             a picture of each quantity; case-K-... are densities of case K\n"
    "\n"
    "Numbers in JSON and CSV read back to the same double. Lines of CSV that begin with # are\n"
    "comments. Lengths are in lambda_s and pressures over E* h', unless a unit is given.\n"
    "\n"
    "How to repeat it\n"
    "----------------\n"
    "Run the study with the program of the version in provenance.json:\n"
    "\n"
    "    rugo run study.json --db repeated.db --out repeated\n"
    "    grep -v '^#' curves.csv | cmp - <(grep -v '^#' repeated/curves.csv)\n"
    "\n"
    "The second command prints nothing: the curves are the same, bit for bit. Between processors\n"
    "of different vector width, the last digits may differ.\n"
    "\n"
    "How to cite it\n"
    "--------------\n"
    "Cite the program by the file CITATION.cff of its source, with the version above.\n";

static int print_readme(const struct exported *from, FILE *file, struct error *err) {
    struct memory_file memory;
    if (!memory_file_open(&memory))
        return error_memory(err, 0, "a text");
    fputs("Results of a study by Rugo, which computes rough surfaces and their contact.\n\n",
          memory.file);
    provenance_comment(memory.file, from->study);
    char *text = memory_file_close(&memory, NULL);
    if (text == NULL)
        return error_memory(err, 0, "a text");
    for (const char *line = text; *line != '\0';) { /* without the "# " of comments */
        size_t size = strcspn(line, "\n");
        bool comment = strncmp(line, "# ", 2) == 0;
        fprintf(file, "%.*s\n", (int)(size - (comment ? 2 : 0)), line + (comment ? 2 : 0));
        line += size + (line[size] == '\n');
    }
    free(text);
    fputs(FILES, file);
    return 0;
}

/* --- all of them --- */

/* What an interrupted command has not begun it leaves. */
static int go_on(struct error *err) {
    return stop_is_requested(NULL) ? error_set(err, ERROR_STOPPED, "stopped") : 0;
}

static int gather(struct exported *out, struct error *err) {
    const struct export_order *order = out->order;
    const struct result_filter all = {.case_number = -1, .complete = true};
    int status = access_document(order->access, order->id, &out->document, err);
    if (status == 0)
        status = result_folder_check(&order->folder, order->id, out->document, err);
    if (status == 0)
        status = access_results(order->access, order->id, &all, out->study, err);
    return status != 0 ? status : access_report(order->access, order->id, &out->report, err);
}

static int write_files(const struct exported *from, struct error *err) {
    static const struct {
        const char *name;
        int (*print)(const struct exported *from, FILE *file, struct error *err);
    } ROWS[] = {
        {"README.txt", print_readme},      {"provenance.json", print_provenance},
        {"scalars.csv", print_scalars},    {"table.csv", print_shown},
        {"report.txt", print_report_text}, {"report.json", print_report},
    };
    const struct result_folder *folder = &from->order->folder;
    int status = result_folder_take(folder, from->order->id, from->document, err);
    if (status == 0)
        status = go_on(err);
    if (status == 0)
        status = output_write(from->study, folder->path, err);
    for (size_t r = 0; r < sizeof ROWS / sizeof *ROWS && status == 0; r++) {
        status = go_on(err);
        if (status == 0)
            status = write_file(from, ROWS[r].name, ROWS[r].print, err);
    }
    return status;
}

/* The picture of speed against error is left out where there is nothing to draw. */
static int write_cost(const struct exported *from, struct error *err) {
    struct error absent = {0};
    char path[PATH_SIZE];
    int status = write_file(from, "report.svg", print_cost, &absent);
    if (status == ERROR_ABSENT) {
        snprintf(path, sizeof path, "%s/report.svg", from->order->folder.path);
        (void)remove(path);
        return 0;
    }
    if (status != 0)
        *err = absent;
    return status;
}

int export_folder(const struct export_order *order, struct study_result *study, struct error *err) {
    struct exported from = {.order = order, .study = study};
    int status = gather(&from, err);
    if (status == 0)
        status = write_files(&from, err);
    if (status == 0)
        status = write_cost(&from, err);
    study_report_clear(&from.report);
    cJSON_Delete(from.document);
    return status;
}
