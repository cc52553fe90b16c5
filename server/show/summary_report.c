/* Speed against error. */
#include "server/show/document.h"
#include "server/show/summary.h"
#include "server/show/summary_cells.h"
#include <string.h>

/* --- a row a case --- */

static void cases_table(const cJSON *cases, const char *const *varied, size_t varied_count,
                        FILE *file) {
    static const char *const NUMBERS[] = {"seconds", "seconds_per_realisation"};
    static const char *const ERRORS[] = {"statistical_error", "discretisation_error", "model_error",
                                         "total_error"};
    static const char *const HEADINGS[] = {"realisations",  "seconds",          "s/realisation",
                                           "statistical %", "discretisation %", "model %",
                                           "total %",       "s to halve"};
    enum { NUMBER_COUNT = 2, ERROR_COUNT = 4, HEADING_COUNT = NUMBER_COUNT + ERROR_COUNT + 2 };
    char partial[48];
    struct text_table table = {.columns = 1 + varied_count + HEADING_COUNT};
    table_cell(&table, "case");
    for (size_t p = 0; p < varied_count; p++)
        table_cell(&table, "%s", last_name(varied[p]));
    for (size_t n = 0; n < HEADING_COUNT; n++)
        table_cell(&table, "%s", HEADINGS[n]);
    for (const cJSON *one = cases->child; one; one = one->next) {
        table_number(&table, number_of(one, "case"));
        for (size_t p = 0; p < varied_count; p++)
            value_cell(&table, member(member(one, "parameters"), varied[p]));
        partial_text(number_of(one, "realisations"), number_of(one, "valueless"), partial,
                     sizeof partial);
        table_cell(&table, "%.0f%s", number_of(one, "realisations"), partial);
        for (size_t n = 0; n < NUMBER_COUNT; n++)
            table_number(&table, number_of(one, NUMBERS[n]));
        for (size_t e = 0; e < ERROR_COUNT; e++)
            percent_cell(&table, number_of(one, ERRORS[e]));
        table_number(&table, number_of(one, "seconds_to_halve_error"));
    }
    table_print(&table, file);
    table_clear(&table);
}

/* --- a row a series: model, level, estimator --- */

enum { TABLES_MOST = 4, SERIES_MOST = 64, ERROR_COUNT = 4, NOTES_SHOWN = 40 };
static const char *const ERRORS[ERROR_COUNT] = {"statistical_error", "discretisation_error",
                                                "model_error", "total_error"};

/* Sums over the cases that have the series. */
struct series {
    const cJSON *entry; /* of the first one */
    double seconds, realisations, valueless, squares[ERROR_COUNT];
    size_t known[ERROR_COUNT];
};
struct series_list {
    size_t count;
    struct series rows[SERIES_MOST];
};

static bool same_series(const cJSON *a, const cJSON *b) {
    return same_member(a, b, "model") && same_member(a, b, "kinematics") &&
           same_member(a, b, "level") && same_member(a, b, "series");
}

static struct series *series_find(struct series_list *list, const cJSON *entry) {
    for (size_t s = 0; s < list->count; s++)
        if (same_series(list->rows[s].entry, entry))
            return &list->rows[s];
    if (list->count == SERIES_MOST)
        return NULL;
    list->rows[list->count] = (struct series){.entry = entry};
    return &list->rows[list->count++];
}

static void series_add(struct series *series, const cJSON *one, const cJSON *entry) {
    series->seconds += number_of(entry, "seconds");
    series->realisations += number_of(one, "realisations");
    series->valueless += fmax(number_of(entry, "valueless"), 0);
    for (size_t e = 0; e < ERROR_COUNT; e++) {
        double error = number_of(entry, ERRORS[e]);
        if (!isnan(error)) {
            series->squares[e] += error * error;
            series->known[e]++;
        }
    }
}

/* The series of the case's main quantity that have a model; estimates alone. */
static void add_case(struct series_list *list, const cJSON *one) {
    const char *quantity = text_of(one, "main_curve", "");
    for (const cJSON *entry = first_of(one, "curves"); entry; entry = entry->next) {
        if (strcmp(text_of(entry, "quantity", ""), quantity) != 0 || !member(entry, "model") ||
            is_bracket(entry))
            continue;
        struct series *series = series_find(list, entry);
        if (series)
            series_add(series, one, entry);
    }
}

static void series_table(const struct series_list *list, FILE *file) {
    static const char *const HEADINGS[] = {"model",         "level",         "estimator",
                                           "s/realisation", "statistical %", "discretisation %",
                                           "model %",       "total %"};
    enum { HEADING_COUNT = sizeof HEADINGS / sizeof *HEADINGS };
    struct text_table table = {.columns = HEADING_COUNT};
    char model[64], partial[48];
    for (size_t h = 0; h < HEADING_COUNT; h++)
        table_cell(&table, "%s", HEADINGS[h]);
    for (size_t s = 0; s < list->count; s++) {
        const struct series *series = &list->rows[s];
        model_text(series->entry, model, sizeof model);
        partial_text(series->realisations, series->valueless, partial, sizeof partial);
        table_cell(&table, "%s%s", model, partial);
        table_number(&table, number_of(series->entry, "level"));
        table_cell(&table, "%s", text_of(series->entry, "series", "-"));
        table_cell(&table, "%.3g", series->seconds / series->realisations);
        for (size_t e = 0; e < ERROR_COUNT; e++)
            percent_cell(&table, series->known[e]
                                     ? sqrt(series->squares[e] / (double)series->known[e])
                                     : (double)NAN);
    }
    table_print(&table, file);
    table_clear(&table);
}

/* One case, or all of them together. */
static void print_series(const cJSON *first, const cJSON *end, const char *title,
                         const char *const *varied, size_t varied_count, FILE *file) {
    struct series_list list = {0};
    const char *quantity = text_of(first, "main_curve", "");
    for (const cJSON *one = first; one != end; one = one->next) {
        add_case(&list, one);
        quantity = *quantity ? quantity : text_of(one, "main_curve", "");
    }
    if (!list.count)
        return;
    fprintf(file, "\n%s: ", title);
    print_swept(first, varied, varied_count, file);
    fprintf(file, "%s by model, level and estimator\n", quantity);
    series_table(&list, file);
}

static void print_all_series(const cJSON *cases, const char *const *varied, size_t varied_count,
                             FILE *file) {
    char title[32];
    if (cJSON_GetArraySize(cases) > TABLES_MOST) {
        print_series(cases->child, NULL, "all cases, root mean square", NULL, 0, file);
        return;
    }
    for (const cJSON *one = cases->child; one; one = one->next) {
        snprintf(title, sizeof title, "case %.0f", number_of(one, "case"));
        print_series(one, one->next, title, varied, varied_count, file);
    }
}

void summary_of_report(const cJSON *report, FILE *file) {
    const cJSON *cases = member(report, "cases");
    const char *varied[COLUMNS_MOST];
    if (!cJSON_IsArray(cases) || !cases->child)
        return;
    size_t varied_count = varied_parameters(cases, varied);
    fprintf(file, "%s (%s), study %s: cost, and relative errors of the main curve\n",
            text_of(report, "name", "-"), text_of(report, "state", "-"),
            text_of(report, "study", "-"));
    cases_table(cases, varied, varied_count, file);
    print_all_series(cases, varied, varied_count, file);
    print_partial(cases, file);
    print_notes(cases, NOTES_SHOWN, file);
}
