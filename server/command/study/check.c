/* `rugo check`: what a study would do, and what it would cost; runs nothing. */
#include "jobs/allotment.h"
#include "jobs/kind.h"
#include "jobs/target.h"
#include "schema/json/field.h"
#include "server/command/command.h"
#include "server/command/options.h"
#include "server/show/summary/plan.h"
#include "server/show/summary/summary_cells.h"
#include "server/show/summary/summary_target.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PLANS_SHOWN = 5 };

static const char *random_name(const struct study *study) {
    return choice_name(STUDY_RANDOM, (int)study->random);
}

/* --- text --- */

static void print_value(struct text_table *table, const cJSON *value) {
    char *text = value != NULL ? json_print(value) : NULL;
    size_t length = text != NULL ? strlen(text) : 0;
    bool quoted = length > 1 && text[0] == '"';
    table_cell(table, "%.*s", text != NULL ? (int)(length - 2 * quoted) : 1,
               text != NULL ? text + quoted : "-");
    free(text);
}

/* Returns whether a case has a law of heights, of which something is known. */
static bool has_law(const struct study *study) {
    bool any = false;
    for (size_t c = 0; c < study->case_count; c++)
        any = any || study->cases[c].cost.law_outside > 0;
    return any;
}

static void print_law(struct text_table *table, const struct study_cost *cost) {
    if (cost->law_outside > 0) {
        table_cell(table, "%.3g", 100 * cost->law_outside);
        table_cell(table, "%.2f", 100 * cost->law_misfit);
        return;
    }
    table_cell(table, "-");
    table_cell(table, "-");
}

/* Columns of what only some studies have. */
static const struct own_column {
    const char *heading;
    size_t at;    /* of its number in study_cost, 0 where a case has none */
    double usual; /* needs no column either; 0: none */
    const char *legend;
} OWN_COLUMNS[] = {
    {"fine zone", offsetof(struct study_cost, fine_height), 0,
     "fine zone: depth in lambda_s in which columns of elements are as wide as those of the "
     "surface"},
    {"solver", offsetof(struct study_cost, tolerance), 0,
     "solver: tolerance of contact, the largest violation over the largest displacement"},
    {"wavelength_ratio", offsetof(struct study_cost, wavelength_ratio), 0, NULL},
    {"hurst", offsetof(struct study_cost, hurst), 0, NULL},
    {"skewness", offsetof(struct study_cost, skewness), 0, NULL},
    {"kurtosis", offsetof(struct study_cost, kurtosis), KURTOSIS_GAUSSIAN, NULL},
};
enum { OWN_COUNT = sizeof OWN_COLUMNS / sizeof *OWN_COLUMNS };

static double own_number(const struct study_case *one, const struct own_column *column) {
    if (column->at == offsetof(struct study_cost, tolerance))
        return plan_case_tolerance(one);
    return *(const double *)((const char *)&one->cost + column->at);
}

static const char TOLERANCE[] = "/contact/tolerance";

static bool is_swept(const struct study *study, const char *pointer) {
    size_t p = 0;
    while (study->swept[p] != NULL && strcmp(study->swept[p], pointer) != 0)
        p++;
    return study->swept[p] != NULL;
}

/* Returns whether a value of the first case differs in others. */
static bool differs(const struct study *study, const char *pointer) {
    const cJSON *first = json_at(study->cases[0].parameters, pointer);
    bool same = true;
    for (size_t c = 1; same && c < study->case_count; c++)
        same = cJSON_Compare(first, json_at(study->cases[c].parameters, pointer), true);
    return !same;
}

/* Returns whether the tolerance stands in the list of values that all cases share, or among what is
 * swept. */
static bool shows_tolerance(const struct study *study) {
    return is_swept(study, TOLERANCE) ||
           (json_at(study->cases[0].parameters, TOLERANCE) != NULL && !differs(study, TOLERANCE));
}

/* Finds the columns that some case has; returns their number. */
static size_t own_columns(const struct study *study, bool shown[OWN_COUNT]) {
    size_t count = 0;
    for (size_t a = 0; a < OWN_COUNT; a++) {
        bool listed =
            OWN_COLUMNS[a].at == offsetof(struct study_cost, tolerance) && shows_tolerance(study);
        shown[a] = false;
        for (size_t c = 0; c < study->case_count && !listed; c++) {
            double number = own_number(&study->cases[c], &OWN_COLUMNS[a]);
            shown[a] = shown[a] || (number != 0 && number != OWN_COLUMNS[a].usual);
        }
        count += shown[a];
    }
    return count;
}

/* Writes CPU seconds, with the range where they scatter. */
static void cost_text(double seconds, struct plan_range range, char *out, size_t size) {
    char time[48], least[48], most[48];
    duration_text(seconds, time, sizeof time);
    duration_text(range.least, least, sizeof least);
    duration_text(range.most, most, sizeof most);
    if (isnan(range.most))
        snprintf(out, size, "%s", time);
    else
        snprintf(out, size, "%s (%s to %s)", time, least, most);
}

static void print_cases(const struct study *study) {
    size_t swept = 0;
    while (study->swept[swept] != NULL)
        swept++;
    static const char *const HEADINGS[] = {"grid",    "memory MiB", "jobs",    "CPU time",
                                           "error %", "outside %",  "misfit %"};
    bool law = has_law(study);
    bool own[OWN_COUNT];
    size_t columns = law ? 7 : 5;
    struct text_table table = {.columns = swept + 1 + columns + own_columns(study, own)};
    table_cell(&table, "case");
    for (size_t p = 0; p < swept; p++)
        table_cell(&table, "%s", strrchr(study->swept[p], '/') + 1);
    for (size_t h = 0; h < columns; h++)
        table_cell(&table, "%s", HEADINGS[h]);
    for (size_t a = 0; a < OWN_COUNT; a++)
        if (own[a])
            table_cell(&table, "%s", OWN_COLUMNS[a].heading);
    for (size_t c = 0; c < study->case_count; c++) {
        const struct study_case *one = &study->cases[c];
        char time[160];
        cost_text(plan_case_seconds(one), plan_case_range(one), time, sizeof time);
        table_cell(&table, "%zu", c);
        for (size_t p = 0; p < swept; p++)
            print_value(&table, json_at(one->parameters, study->swept[p]));
        table_cell(&table, "%zu x %zu", one->cost.nx, one->cost.ny);
        table_cell(&table, "%.1f", plan_case_bytes(one) / 0x1p20);
        table_cell(&table, "%llu", (unsigned long long)plan_case_jobs(one));
        table_cell(&table, "%s", time);
        table_cell(&table, "%.2g", 100 * plan_case_error(&study->cases[c]));
        if (law)
            print_law(&table, &one->cost);
        for (size_t a = 0; a < OWN_COUNT; a++)
            if (own[a])
                table_number(&table, own_number(one, &OWN_COLUMNS[a]));
    }
    table_print(&table, stdout);
    table_clear(&table);
    if (law)
        printf("outside: share of m0 at waves outside the band of the spectrum; misfit: share of "
               "the variance in the band at other waves than asked for\n");
    for (size_t a = 0; a < OWN_COUNT; a++)
        if (own[a] && OWN_COLUMNS[a].legend != NULL)
            printf("%s\n", OWN_COLUMNS[a].legend);
}

enum { NUMBERS_SHOWN = 8 };

/* Prints a value; of a long list of numbers, such as samples of heights, the first ones. */
static void print_whole(const char *pointer, const cJSON *value) {
    char *text = json_print(value);
    int length = text != NULL ? (int)strlen(text) : 0, count = cJSON_GetArraySize(value);
    bool cut = text != NULL && count > NUMBERS_SHOWN && cJSON_IsNumber(value->child);
    if (cut) {
        const char *end = text;
        for (int n = 0; n < NUMBERS_SHOWN; n++)
            end = strchr(end, ',') + 1;
        length = (int)(end - text);
    }
    printf("  %-36s %.*s", pointer, text != NULL ? length : 1, text != NULL ? text : "?");
    if (cut)
        printf(" ...] (%d numbers)", count);
    putchar('\n');
    free(text);
}

/* Prints the effective values that all cases share; what is swept stands in the table. */
static void print_values(const struct study *study, const cJSON *object, const char *prefix) {
    for (const cJSON *member = object->child; member != NULL; member = member->next) {
        char pointer[256];
        snprintf(pointer, sizeof pointer, "%s/%s", prefix, member->string);
        if (cJSON_IsObject(member))
            print_values(study, member, pointer);
        else if (!is_swept(study, pointer) && !differs(study, pointer))
            print_whole(pointer, member);
    }
}

/* Prints what files of nodes take, which `rugo run --out` writes. */
static void print_kept(const struct study *study) {
    struct study_kept kept = plan_kept(study);
    char time[48];
    duration_text(kept.seconds, time, sizeof time);
    if (kept.path != NULL)
        printf("nodes of kept realisations: about %.3g MB of files, %s of CPU, by run --out\n",
               kept.bytes / 1e6, time);
}

static void print_text(const struct study *study) {
    const struct plan_range range = plan_range(study);
    char cpu[160], wall[48];
    cost_text(plan_seconds(study), range, cpu, sizeof cpu);
    duration_text(plan_seconds(study) / allotment_threads(), wall, sizeof wall);
    printf("%s (%s), seed %llu: %zu cases", study->name, study->kind->name,
           (unsigned long long)study->seed, study->case_count);
    if (study->realisations > 0)
        printf(" of %llu realisations", (unsigned long long)study->realisations);
    if (study->case_count > 1)
        printf(", %s random numbers", random_name(study));
    putchar('\n');
    print_values(study, study->cases[0].parameters, "");
    print_cases(study);
    for (size_t c = 0; c < study->case_count && c < PLANS_SHOWN; c++)
        summary_of_plan(&study->cases[c], stdout);
    print_kept(study);
    if (!isnan(range.most))
        puts(
            "in brackets: what nine of ten such studies take, as a few realisations of steep faces "
            "may take many times what others take");
    printf("in all about %s of CPU, %s on %u processors; up to %.0f MiB a worker\n", cpu, wall,
           allotment_threads(), plan_bytes(study) / 0x1p20);
}

/* --- JSON --- */

static int print_document(cJSON *document, struct error *err) {
    int status = output_document(document, err);
    cJSON_Delete(document);
    return status;
}

/* Prints the schema as the service gives it (GET /v1/study.schema.json). */
static int print_schema(struct error *err) {
    cJSON *schema = study_schema(JOB_KINDS);
    char *text = schema != NULL ? json_print_pretty(schema) : NULL;
    cJSON_Delete(schema);
    if (text == NULL)
        return error_memory(err, 0, "the schema of studies");
    fputs(text, stdout);
    free(text);
    return output_flush(err);
}

/* --- the command --- */

struct options {
    const char **sets;
    int json;
    bool schema, study;
};

/* Prints the study as it would be kept and sent: with its changes, and what was fitted in the place
 * of a file. */
static int print_study(const struct study *study, struct error *err) {
    cJSON *document = NULL;
    int status = json_parse(study->source, strlen(study->source), NULL, &document, err);
    char *text = status == 0 ? json_print_pretty(document) : NULL;
    cJSON_Delete(document);
    if (status == 0 && text == NULL)
        status = error_memory(err, strlen(study->source), "a study");
    if (status != 0)
        return status;
    fputs(text, stdout);
    free(text);
    return output_flush(err);
}

static int check(const char *file, const struct options *options, struct fault_list *faults,
                 struct error *err) {
    struct study *study = NULL;
    int status = study_file_read(&study, file, options->sets, faults, err);
    if (status == 0 && options->study) {
        status = print_study(study, err);
    } else if (status == 0 && options->json != 0) {
        status = print_document(plan_document(study), err);
    } else if (status == 0) {
        print_text(study);
        status = output_flush(err);
    }
    study_destroy(&study);
    return status;
}

#define AT(member) offsetof(struct options, member)
static const struct option_row OPTIONS[] = {
    {"set", 0, OPTION_LIST, 0, 0, AT(sets), "PATH=VALUE", NULL, SET_HELP},
    {"format", 0, OPTION_CHOICE, 0, 0, AT(json), "text|json", "text", "what to print"},
    {"study", 0, OPTION_FLAG, 0, 0, AT(study), NULL, NULL,
     "print the study instead, as it would be kept and sent: with its changes, and the values "
     "fitted to a measured surface in place of its file"},
    {"schema", 0, OPTION_FLAG, 0, 0, AT(schema), NULL, NULL,
     "print the JSON Schema of studies instead; needs no study"},
    {0}};

static int run(const void *values, const char *const *arguments) {
    const struct options *options = values;
    const char *file = arguments[0];
    struct error err = {0};
    struct fault_list faults = {0};
    if (file == NULL && !options->schema)
        return usage_error("check", "an argument is missing");
    int status = options->schema ? print_schema(&err) : check(file, options, &faults, &err);
    int result = command_end("check", status, file, &faults, &err);
    fault_list_clear(&faults);
    return result;
}

const struct command COMMAND_CHECK = {
    .name = "check",
    .arguments = "STUDY.json",
    .summary = "read and validate a study, print cases and cost, run nothing",
    .most = 1,
    .options = OPTIONS,
    .options_size = sizeof(struct options),
    .run = run,
};
