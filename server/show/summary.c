#include "server/show/summary.h"
#include "core/plain_text.h"
#include "server/show/summary_cells.h"
#include "server/show/summary_like.h"
#include "server/show/summary_target.h"
#include "server/show/view.h"
#include <math.h>
#include <string.h>

/* --- scalars --- */

/* What stands beside a scalar. */
enum comparison { ALONE, WITH_THEORY, WITH_GRID };

static double expected(const struct scalar *scalar, enum comparison with) {
    return scalar == NULL ? (double)NAN : with == WITH_GRID ? scalar->grid : scalar->theory;
}

/* Returns whether some case has a value of this scalar, with what stands beside it. */
static bool has_scalar(const struct shown_cases *shown, const char *name, enum comparison with) {
    for (size_t c = 0; c < shown->count; c++) {
        const struct scalar *scalar = result_scalar(shown->list[c], name);
        if (scalar != NULL && !isnan(scalar->value) &&
            (with == ALONE || isfinite(expected(scalar, with))))
            return true;
    }
    return false;
}

/* The largest error of a source, over its scalar, of those that are shown; NaN where none has one.
 */
static double largest_error(const struct case_result *one, size_t count, const char *const *names,
                            enum error_source source) {
    double largest = NAN;
    for (size_t s = 0; s < count; s++) {
        const struct scalar *scalar = result_scalar(one, names[s]);
        const struct scalar_error *error = scalar != NULL ? &scalar->errors[source] : NULL;
        if (error != NULL && error->applies && error->known)
            largest = fmax(largest, (fabs(error->value) + error->bound) / fabs(scalar->value));
    }
    return largest;
}

/* The view's headlines; where these cases have none, all scalars with a theory. */
static size_t shown_scalars(const struct shown_cases *shown, const char *const *headlines,
                            const char **names) {
    const struct case_result *first = shown->list[0];
    size_t count = 0;
    for (; headlines != NULL && *headlines != NULL && count < COLUMNS_MOST; headlines++)
        if (strncmp(*headlines, "percentile_", 11) != 0 && /* those have a table of their own */
            has_scalar(shown, *headlines, ALONE))
            names[count++] = *headlines;
    if (count > 0)
        return count;
    for (size_t s = 0; s < first->scalar_count && count < COLUMNS_MOST; s++)
        if (has_scalar(shown, first->scalars[s].name, WITH_THEORY))
            names[count++] = first->scalars[s].name;
    return count;
}

static void comparison_cells(struct text_table *table, double value, double theory) {
    table_number(table, theory);
    if (theory != 0 && isfinite(value / theory))
        table_cell(table, "%.4f", value / theory);
    else
        table_cell(table, "-");
}

static void scalar_cells(struct text_table *table, const struct scalar *scalar,
                         const bool compared[]) {
    double value = scalar != NULL ? scalar->value : (double)NAN;
    measured_cell(table, value, scalar != NULL ? scalar->standard_error : (double)NAN);
    for (enum comparison with = WITH_THEORY; with <= WITH_GRID; with++)
        if (compared[with])
            comparison_cells(table, value, expected(scalar, with));
}

/* --- a row a case --- */

/* Such a table has this beside the swept parameters. */
struct scalar_table {
    const struct shown_cases *shown;
    const struct study_report *report; /* or NULL */
    size_t scalar_count;
    const char *scalars[COLUMNS_MOST];
    bool compared[COLUMNS_MOST][WITH_GRID + 1]; /* with what beside it */
    bool sources[ERROR_SOURCES];                /* of which errors of these are known */
    bool uneven;                                /* not all cases have as many realisations */
};

static bool is_even(const struct study_result *study) {
    for (size_t c = 1; c < study->case_count; c++)
        if (study->cases[c].realisations != study->cases[0].realisations)
            return false;
    return true;
}

static size_t column_count(const struct scalar_table *plan) {
    size_t columns = 1 + plan->shown->varied_count + plan->uneven + (plan->report != NULL);
    for (size_t s = 0; s < plan->scalar_count; s++)
        columns += 1 + 2u * plan->compared[s][WITH_THEORY] + 2u * plan->compared[s][WITH_GRID];
    for (enum error_source e = 0; e < ERROR_SOURCES; e++)
        columns += plan->sources[e];
    return columns;
}

static void put_heading(const struct scalar_table *plan, struct text_table *table) {
    table_cell(table, "case");
    varied_headings(table, plan->shown);
    if (plan->uneven)
        table_cell(table, "realisations");
    for (size_t s = 0; s < plan->scalar_count; s++) {
        if (plan->compared[s][WITH_THEORY] || plan->compared[s][WITH_GRID])
            table_fold(table);
        table_cell(table, "%s", plan->scalars[s]);
        for (enum comparison with = WITH_THEORY; with <= WITH_GRID; with++)
            if (plan->compared[s][with]) {
                table_cell(table, with == WITH_GRID ? "grid" : "theory");
                table_cell(table, "ratio");
            }
    }
    for (enum error_source e = 0; e < ERROR_SOURCES; e++)
        if (plan->sources[e])
            table_cell(table, "%s %%", ERROR_SOURCE_ROWS[e].name);
    if (plan->report != NULL) {
        table_fold(table);
        table_cell(table, "CPU time");
    }
}

static void put_row(const struct scalar_table *plan, size_t c, struct text_table *table) {
    const struct case_result *one = plan->shown->list[c];
    table_number(table, (double)one->case_number);
    varied_cells(table, plan->shown, c);
    if (plan->uneven)
        table_number(table, (double)one->realisations);
    for (size_t s = 0; s < plan->scalar_count; s++)
        scalar_cells(table, result_scalar(one, plan->scalars[s]), plan->compared[s]);
    for (enum error_source e = 0; e < ERROR_SOURCES; e++)
        if (plan->sources[e])
            percent_cell(table, largest_error(one, plan->scalar_count, plan->scalars, e));
    if (plan->report != NULL) {
        const struct case_report *cost = report_of(plan->report, one);
        duration_cell(table, cost != NULL ? cost->time.cpu_seconds : (double)NAN);
    }
}

static void find_sources(struct scalar_table *plan) {
    for (enum error_source e = 0; e < ERROR_SOURCES; e++)
        for (size_t c = 0; c < plan->shown->count && !plan->sources[e]; c++)
            plan->sources[e] =
                !isnan(largest_error(plan->shown->list[c], plan->scalar_count, plan->scalars, e));
}

static void print_scalars(const struct scalar_table *plan, FILE *file) {
    struct text_table table = {.columns = column_count(plan)};
    put_heading(plan, &table);
    for (size_t c = 0; c < plan->shown->count; c++)
        put_row(plan, c, &table);
    fputc('\n', file);
    table_print(&table, file);
    table_clear(&table);
}

/* --- a study --- */

enum { TARGETS_SHOWN = 20, LIKE_SHOWN = 5 };

static void print_title(const struct study_result *study, const struct study_report *report,
                        FILE *file) {
    text_print_plain(file, study->name);
    fprintf(file, " (%s), study %s", study->state, study->id);
    if (is_even(study))
        fprintf(file, ", %llu realisations a case",
                (unsigned long long)study->cases[0].realisations);
    if (report != NULL) {
        char time[112];
        work_time_text(&report->time, time, sizeof time);
        fprintf(file, ", %s", time);
    }
    fputc('\n', file);
    if (report != NULL)
        print_without_cpu(&report->time, file);
    print_random(study->random, study->case_count, file);
}

void summary_of_curves(const struct study_result *study, const struct study_report *report,
                       FILE *file) {
    const struct result_view *view = view_of(study->kind);
    struct shown_cases shown;
    if (study->case_count == 0)
        return;
    print_title(study, report, file);
    if (!shown_of_results(study, &shown)) {
        fputs("(no memory for a table)\n", file);
        return;
    }
    if (view->table != NULL) {
        summary_of_quantity(view->table, &shown, report, file);
    } else {
        struct scalar_table plan = {.shown = &shown, .report = report, .uneven = !is_even(study)};
        plan.scalar_count = shown_scalars(&shown, view->headlines, plan.scalars);
        for (size_t s = 0; s < plan.scalar_count; s++)
            for (enum comparison with = WITH_THEORY; with <= WITH_GRID; with++)
                plan.compared[s][with] = has_scalar(&shown, plan.scalars[s], with);
        find_sources(&plan);
        print_scalars(&plan, file);
        for (size_t c = 0; c < shown.count && c < TARGETS_SHOWN; c++)
            summary_of_target(shown.list[c], file);
    }
    for (size_t c = 0; c < shown.count && c < LIKE_SHOWN; c++)
        summary_of_like(shown.list[c], file);
    print_missing(&shown, file);
    shown_clear(&shown);
}
