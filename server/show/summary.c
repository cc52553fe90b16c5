#include "server/show/summary.h"
#include "server/show/document.h"
#include "server/show/summary_cells.h"
#include <math.h>
#include <stdbool.h>
#include <string.h>

void duration_text(double seconds, char *out, size_t size) {
    if (isnan(seconds))
        snprintf(out, size, "-");
    else if (seconds > 0 && seconds < 0.1)
        snprintf(out, size, "%.3g ms", 1000 * seconds);
    else if (seconds < 100)
        snprintf(out, size, "%.3g s", seconds);
    else if (seconds < 6000)
        snprintf(out, size, "%.0f min %02.0f s", floor(seconds / 60), floor(fmod(seconds, 60)));
    else
        snprintf(out, size, "%.0f h %02.0f min", floor(seconds / 3600),
                 floor(fmod(seconds, 3600) / 60));
}

/* --- curves --- */

/* What a table of results shows first, of the kinds that have it. */
static const char *const HEADLINES[] = {"nayak_alpha", "summit_density", "summit_height_mean",
                                        "summit_curvature_mean"};
enum { HEADLINE_COUNT = sizeof HEADLINES / sizeof *HEADLINES };

static const cJSON *scalar_of(const cJSON *one, const char *name) {
    return member(member(one, "scalars"), name);
}

/* Whether some case has this scalar; with its theory. */
static bool has_scalar(const cJSON *cases, const char *name, bool with_theory) {
    for (const cJSON *one = cases->child; one; one = one->next) {
        const cJSON *scalar = scalar_of(one, name);
        if (scalar && (!with_theory || cJSON_IsNumber(member(scalar, "theory"))))
            return true;
    }
    return false;
}

/* The headlines of these cases; where they have none, all scalars with a theory. */
static size_t shown_scalars(const cJSON *cases, const char **names) {
    size_t count = 0;
    for (size_t h = 0; h < HEADLINE_COUNT; h++)
        if (has_scalar(cases, HEADLINES[h], false))
            names[count++] = HEADLINES[h];
    const cJSON *scalars = count ? NULL : member(cases->child, "scalars");
    for (const cJSON *s = scalars ? scalars->child : NULL; s && count < COLUMNS_MOST; s = s->next)
        if (has_scalar(cases, s->string, true))
            names[count++] = s->string;
    return count;
}

static void scalar_cells(struct text_table *table, const cJSON *scalar, bool with_theory) {
    double value = number_of(scalar, "value"), theory = number_of(scalar, "theory");
    measured_cell(table, value, number_of(scalar, "standard_error"));
    if (!with_theory)
        return;
    table_number(table, theory);
    if (theory != 0 && isfinite(value / theory))
        table_cell(table, "%.4f", value / theory);
    else
        table_cell(table, "-");
}

/* What a table of results has beside the swept parameters. */
struct results {
    const cJSON *cases, *costs; /* costs: the cases of a report, or NULL */
    const char *varied[COLUMNS_MOST], *scalars[COLUMNS_MOST];
    bool compared[COLUMNS_MOST]; /* with a theory beside it */
    size_t varied_count, scalar_count;
    bool uneven; /* not all cases have as many realisations */
};

static bool is_even(const cJSON *cases) {
    for (const cJSON *one = cases->child; one; one = one->next)
        if (number_of(one, "realisations") != number_of(cases->child, "realisations"))
            return false;
    return true;
}

static void results_prepare(struct results *results, const cJSON *cases, const cJSON *report) {
    *results = (struct results){.cases = cases, .costs = member(report, "cases")};
    results->varied_count = varied_parameters(cases, results->varied);
    results->scalar_count = shown_scalars(cases, results->scalars);
    for (size_t s = 0; s < results->scalar_count; s++)
        results->compared[s] = has_scalar(cases, results->scalars[s], true);
    results->uneven = !is_even(cases);
}

static size_t results_columns(const struct results *results) {
    size_t columns = 1 + results->varied_count + results->uneven + (results->costs != NULL);
    for (size_t s = 0; s < results->scalar_count; s++)
        columns += results->compared[s] ? 3 : 1;
    return columns;
}

static void results_heading(const struct results *results, struct text_table *table) {
    table_cell(table, "case");
    for (size_t p = 0; p < results->varied_count; p++)
        table_cell(table, "%s", last_name(results->varied[p]));
    if (results->uneven)
        table_cell(table, "realisations");
    for (size_t s = 0; s < results->scalar_count; s++) {
        if (results->compared[s])
            table_fold(table);
        table_cell(table, "%s", results->scalars[s]);
        if (results->compared[s]) {
            table_cell(table, "theory");
            table_cell(table, "ratio");
        }
    }
    if (results->costs) {
        table_fold(table);
        table_cell(table, "time");
    }
}

static void results_row(const struct results *results, const cJSON *one, const cJSON *cost,
                        struct text_table *table) {
    table_number(table, number_of(one, "case"));
    for (size_t p = 0; p < results->varied_count; p++)
        value_cell(table, member(member(one, "parameters"), results->varied[p]));
    if (results->uneven)
        table_number(table, number_of(one, "realisations"));
    for (size_t s = 0; s < results->scalar_count; s++)
        scalar_cells(table, scalar_of(one, results->scalars[s]), results->compared[s]);
    if (results->costs) {
        char time[48];
        duration_text(number_of(cost, "seconds"), time, sizeof time);
        table_cell(table, "%s", time);
    }
}

static void results_table(const cJSON *cases, const cJSON *report, FILE *file) {
    struct results results;
    results_prepare(&results, cases, report);
    struct text_table table = {.columns = results_columns(&results)};
    results_heading(&results, &table);
    const cJSON *cost = results.costs ? results.costs->child : NULL;
    for (const cJSON *one = cases->child; one; one = one->next) {
        results_row(&results, one, cost, &table);
        cost = cost ? cost->next : NULL;
    }
    fputc('\n', file);
    table_print(&table, file);
    table_clear(&table);
}

void summary_of_curves(const cJSON *curves, const cJSON *report, FILE *file) {
    const cJSON *cases = member(curves, "cases");
    if (!cJSON_IsArray(cases) || !cases->child)
        return;
    fprintf(file, "%s (%s), study %s", text_of(curves, "name", "-"), text_of(curves, "state", "-"),
            text_of(curves, "study", "-"));
    if (is_even(cases))
        fprintf(file, ", %.0f realisations a case", number_of(cases->child, "realisations"));
    if (report) {
        char time[48];
        duration_text(number_of(report, "seconds"), time, sizeof time);
        fprintf(file, ", %s of work", time);
    }
    fputc('\n', file);
    if (strcmp(text_of(curves, "kind", ""), "contact") == 0)
        summary_of_contact(cases, member(report, "cases"), file);
    else
        results_table(cases, report, file);
}

/* --- status --- */

void summary_of_status(const cJSON *status, FILE *file) {
    const cJSON *jobs = member(status, "jobs"), *realisations = member(status, "realisations");
    char left[48], spent[48];
    duration_text(number_of(status, "seconds_left"), left, sizeof left);
    duration_text(number_of(status, "seconds"), spent, sizeof spent);
    fprintf(file, "%s  %s  %s  %s\n", text_of(status, "id", "-"), text_of(status, "name", "-"),
            text_of(status, "kind", "-"), text_of(status, "state", "-"));
    fprintf(file, "  realisations %.0f of %.0f, jobs %.0f of %.0f (%.0f running, %.0f failed)\n",
            number_of(realisations, "done"), number_of(realisations, "total"),
            number_of(jobs, "done"), number_of(jobs, "total"), number_of(jobs, "running"),
            number_of(jobs, "failed"));
    fprintf(file, "  workers %.0f, spent %s, left %s\n", number_of(status, "workers"), spent, left);
    const cJSON *failures = member(status, "failures");
    for (const cJSON *f = failures ? failures->child : NULL; f; f = f->next)
        if (!cJSON_IsNumber(member(f, "job")))
            fprintf(file, "  not published: case %.0f: %s\n", number_of(f, "case"),
                    text_of(f, "reason", "-"));
        else
            fprintf(
                file,
                "  failed: case %.0f, realisations %.0f to %.0f, %.0f attempts, worker %s: %s\n",
                number_of(f, "case"), number_of(f, "first"),
                number_of(f, "first") + number_of(f, "count") - 1, number_of(f, "attempts"),
                text_of(f, "worker", "-"), text_of(f, "reason", "-"));
}

void summary_of_list(const cJSON *studies, FILE *file) {
    const cJSON *list = member(studies, "studies");
    struct text_table table = {.columns = 6};
    static const char *const HEADINGS[] = {"id", "name", "kind", "state", "done %", "created"};
    for (size_t h = 0; h < 6; h++)
        table_cell(&table, "%s", HEADINGS[h]);
    for (const cJSON *s = list ? list->child : NULL; s; s = s->next) {
        const cJSON *realisations = member(s, "realisations");
        table_cell(&table, "%s", text_of(s, "id", "-"));
        table_cell(&table, "%s", text_of(s, "name", "-"));
        table_cell(&table, "%s", text_of(s, "kind", "-"));
        table_cell(&table, "%s", text_of(s, "state", "-"));
        table_cell(&table, "%.1f",
                   100 * number_of(realisations, "done") / number_of(realisations, "total"));
        table_cell(&table, "%s", text_of(s, "created", "-"));
    }
    table_print(&table, file);
    table_clear(&table);
}
