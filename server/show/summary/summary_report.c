/* Speed against error. */
#include "core/file/plain_text.h"
#include "server/show/summary/report_series.h"
#include "server/show/summary/summary.h"
#include "server/show/summary/summary_cells.h"
#include "server/show/summary/summary_units.h"
#include "server/show/view.h"
#include <math.h>
#include <string.h>

enum { TABLES_MOST = 4, NOTES_SHOWN = 40 };

/* A table has columns for the sources of which anything is known. */
struct error_columns {
    bool shown[ERROR_COLUMNS], unknown[UNKNOWN_SOURCES], small[ERROR_SOURCES];
    size_t count;
};

static void find_columns(const struct curve_report *curve, struct error_columns *columns) {
    for (size_t s = 0; s < ERROR_SOURCES; s++) {
        columns->shown[1 + s] = columns->shown[1 + s] || curve->errors[s] >= error_shown(s);
        columns->small[s] = columns->small[s] || curve->errors[s] < error_shown(s);
        columns->unknown[s] = columns->unknown[s] || (curve->applies[s] && isnan(curve->errors[s]));
    }
    columns->shown[LAW_COLUMN] = columns->shown[LAW_COLUMN] || curve->law >= ERROR_SHOWN;
}

/* Finds the columns for all curves of the main quantities. */
static struct error_columns columns_of(const struct study_report *report) {
    struct error_columns columns = {.shown = {[0] = true, [TOTAL_COLUMN] = true}};
    for (size_t c = 0; c < report->case_count; c++) {
        const struct case_report *one = &report->cases[c];
        for (size_t a = 0; a < one->curve_count && one->main != NULL; a++)
            if (strcmp(one->curves[a].place.quantity, one->main->place.quantity) == 0)
                find_columns(&one->curves[a], &columns);
    }
    for (size_t s = 0; s < ERROR_SOURCES; s++)
        columns.small[s] = columns.small[s] && !columns.shown[1 + s];
    for (size_t e = 0; e < ERROR_COLUMNS; e++)
        columns.count += columns.shown[e];
    return columns;
}

static void error_headings(const struct error_columns *columns, struct text_table *table) {
    table_cell(table, "statistical %%");
    for (int source = 0; source < ERROR_SOURCES; source++)
        if (columns->shown[1 + source])
            table_cell(table, "%s %%", ERROR_SOURCE_ROWS[source].name);
    table_fold(table);
    table_cell(table, "size %%");
    if (columns->shown[LAW_COLUMN])
        table_cell(table, "law %%");
}

static void error_cells(const struct error_columns *columns, const double errors[ERROR_COLUMNS],
                        struct text_table *table) {
    for (size_t e = 0; e < ERROR_COLUMNS; e++)
        if (columns->shown[e])
            percent_cell(table, errors[e]);
}

/* --- a row a case --- */

static void put_case(const struct shown_cases *shown, size_t c, const struct case_report *one,
                     const struct error_columns *columns, struct text_table *table) {
    double realisations = (double)one->about.realisations, errors[ERROR_COLUMNS];
    char partial[48];
    table_number(table, (double)one->about.case_number);
    varied_cells(table, shown, c);
    partial_text(realisations, one->main != NULL ? one->main->valueless : (double)NAN, partial,
                 sizeof partial);
    table_cell(table, "%.0f%s", realisations, partial);
    table_number(table, one->time.seconds);
    table_number(table, one->time.cpu_seconds);
    table_number(table, realisations > 0 ? one->time.cpu_seconds / realisations : (double)NAN);
    errors_of(one->main, errors);
    error_cells(columns, errors, table);
    table_number(table, case_report_seconds_to_halve(one));
}

static void print_cases(const struct study_report *report, const struct shown_cases *shown,
                        const struct error_columns *columns, FILE *file) {
    struct text_table table = {.columns = 1 + shown->varied_count + 4 + columns->count + 1,
                               .room = TABLE_ROOM};
    table_cell(&table, "case");
    varied_headings(&table, shown);
    table_cell(&table, "realisations");
    table_fold(&table);
    table_cell(&table, "seconds");
    table_cell(&table, "CPU s");
    table_cell(&table, "CPU s/realisation");
    table_fold(&table);
    error_headings(columns, &table);
    table_cell(&table, "CPU s to halve");
    for (size_t c = 0; c < report->case_count; c++)
        put_case(shown, c, &report->cases[c], columns, &table);
    table_print(&table, file);
    table_clear(&table);
}

/* --- a row a series: model, level, estimator --- */

static void put_series(const struct report_series *series, const struct error_columns *columns,
                       struct text_table *table) {
    double errors[ERROR_COLUMNS];
    char model[64], partial[48];
    model_text(series->place->model, series->place->kinematics, model, sizeof model);
    partial_text(series->realisations, series->valueless, partial, sizeof partial);
    table_cell(table, "%s%s", model, partial);
    table_number(table, series->place->level);
    table_cell(table, "%s", series->place->series != NULL ? series->place->series : "-");
    table_cell(table, "%.3g", series->cpu_seconds / series->realisations);
    for (size_t e = 0; e < ERROR_COLUMNS; e++)
        errors[e] = series_error(series, e);
    error_cells(columns, errors, table);
}

/* Prints the series of the cases `first` to `end` - 1 together. */
static void print_series(const struct study_report *report, size_t first, size_t end,
                         const char *title, const struct shown_cases *swept,
                         const struct error_columns *columns, FILE *file) {
    static const char *const HEADINGS[] = {"model", "level", "estimator", "CPU s/realisation"};
    enum { HEADING_COUNT = sizeof HEADINGS / sizeof *HEADINGS };
    struct text_table table = {.columns = HEADING_COUNT + columns->count};
    struct series_list list = {0};
    const char *quantity = NULL;
    for (size_t c = first; c < end; c++) {
        const struct curve_report *main = report->cases[c].main;
        series_add_case(&list, &report->cases[c]);
        quantity = quantity == NULL && main != NULL ? main->place.quantity : quantity;
    }
    if (list.count == 0)
        return;
    fprintf(file, "\n%s: ", title);
    if (swept != NULL)
        print_swept(swept, first, file);
    fprintf(file, "%s by model, level and estimator\n", quantity);
    for (size_t h = 0; h < HEADING_COUNT; h++)
        table_cell(&table, "%s", HEADINGS[h]);
    error_headings(columns, &table);
    for (size_t s = 0; s < list.count; s++)
        put_series(&list.rows[s], columns, &table);
    table_print(&table, file);
    table_clear(&table);
}

static void print_all_series(const struct study_report *report, const struct shown_cases *shown,
                             const struct error_columns *columns, FILE *file) {
    char title[32];
    if (report->case_count > TABLES_MOST)
        print_series(report, 0, report->case_count, "all cases, root mean square", NULL, columns,
                     file);
    else
        for (size_t c = 0; c < report->case_count; c++) {
            snprintf(title, sizeof title, "case %llu",
                     (unsigned long long)report->cases[c].about.case_number);
            print_series(report, c, c + 1, title, shown, columns, file);
        }
}

void summary_of_report(const struct study_report *report, FILE *file) {
    const struct quantity_table *words = view_of(report->kind)->table;
    struct shown_cases shown;
    if (report->case_count == 0)
        return;
    text_print_plain(file, report->name);
    fprintf(file, " (%s), study %s: cost, and relative errors of the main curve\n", report->state,
            report->id);
    print_without_cpu(&report->time, file);
    print_random(report->random, report->case_count, file);
    if (!shown_of_report(report, &shown)) {
        fputs("(no memory for a table)\n", file);
        return;
    }
    print_scales(&shown, file);
    const struct error_columns columns = columns_of(report);
    print_cases(report, &shown, &columns, file);
    print_all_series(report, &shown, &columns, file);
    print_unknown(columns.unknown, NULL, file);
    print_small(columns.small, NULL, file);
    fputs("size: one standard error and the other errors at most, root of the sum of squares; - "
          "where one is not known.\n",
          file);
    if (columns.shown[LAW_COLUMN])
        print_law_legend(file);
    print_patch_legend(&shown, file);
    print_partial(&shown, words != NULL ? words->x : "point", file);
    print_notes(&shown, NOTES_SHOWN, file);
    print_missing(&shown, file);
    shown_clear(&shown);
}
