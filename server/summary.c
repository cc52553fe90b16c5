#include "server/summary.h"
#include "server/text_table.h"
#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { COLUMNS_MOST = 24 };

static const cJSON *member(const cJSON *object, const char *name) {
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

static double number(const cJSON *object, const char *name) {
    const cJSON *value = member(object, name);
    return cJSON_IsNumber(value) ? value->valuedouble : (double)NAN;
}

static const char *text(const cJSON *object, const char *name) {
    const cJSON *value = member(object, name);
    return cJSON_IsString(value) ? value->valuestring : "-";
}

void duration_text(double seconds, char *out, size_t size) {
    if (isnan(seconds))
        snprintf(out, size, "-");
    else if (seconds < 100)
        snprintf(out, size, "%.3g s", seconds);
    else if (seconds < 6000)
        snprintf(out, size, "%.0f min %02.0f s", floor(seconds / 60), floor(fmod(seconds, 60)));
    else
        snprintf(out, size, "%.0f h %02.0f min", floor(seconds / 3600),
                 floor(fmod(seconds, 3600) / 60));
}

/* --- curves --- */

/* Pointers whose values differ between cases, or of which some case has none. */
static size_t varied_parameters(const cJSON *cases, const char **names) {
    size_t count = 0;
    const cJSON *first = cases->child;
    for (const cJSON *c = first; c; c = c->next) {
        const cJSON *parameters = member(c, "parameters");
        for (const cJSON *p = parameters ? parameters->child : NULL; p; p = p->next) {
            bool known = cJSON_Compare(p, member(member(first, "parameters"), p->string), true);
            for (size_t n = 0; n < count && !known; n++)
                known = strcmp(names[n], p->string) == 0;
            if (!known && count < COLUMNS_MOST)
                names[count++] = p->string;
        }
    }
    return count;
}

/* Scalars that come with a theory in some case. */
static size_t compared_scalars(const cJSON *cases, const char **names) {
    size_t count = 0;
    for (const cJSON *c = cases->child; c; c = c->next) {
        const cJSON *scalars = member(c, "scalars");
        for (const cJSON *s = scalars ? scalars->child : NULL; s; s = s->next) {
            bool known = !cJSON_IsNumber(member(s, "theory"));
            for (size_t n = 0; n < count && !known; n++)
                known = strcmp(names[n], s->string) == 0;
            if (!known && count < COLUMNS_MOST)
                names[count++] = s->string;
        }
    }
    return count;
}

static void value_cell(struct text_table *table, const cJSON *value) {
    if (cJSON_IsString(value))
        table_cell(table, "%s", value->valuestring);
    else
        table_number(table, cJSON_IsNumber(value) ? value->valuedouble : (double)NAN);
}

static const char *last_name(const char *pointer) {
    const char *slash = strrchr(pointer, '/');
    return slash ? slash + 1 : pointer;
}

static void scalar_row(struct text_table *table, const cJSON *one, const char *const *varied,
                       size_t varied_count, const char *name) {
    const cJSON *scalar = member(member(one, "scalars"), name);
    double value = number(scalar, "value"), error = number(scalar, "standard_error");
    double theory = number(scalar, "theory");
    if (!scalar)
        return;
    table_number(table, number(one, "case"));
    for (size_t p = 0; p < varied_count; p++)
        value_cell(table, member(member(one, "parameters"), varied[p]));
    table_number(table, number(one, "realisations"));
    table_cell(table, "%s", name);
    table_number(table, value);
    if (isnan(error))
        table_cell(table, "-");
    else
        table_cell(table, "%.2g", error);
    table_number(table, theory);
    if (theory != 0 && isfinite(value / theory))
        table_cell(table, "%.4f", value / theory);
    else
        table_cell(table, "-");
}

void summary_of_curves(const cJSON *curves, FILE *file) {
    const cJSON *cases = member(curves, "cases");
    const char *varied[COLUMNS_MOST], *scalars[COLUMNS_MOST];
    if (!cJSON_IsArray(cases) || !cases->child)
        return;
    size_t varied_count = varied_parameters(cases, varied);
    size_t scalar_count = compared_scalars(cases, scalars);
    struct text_table table = {.columns = varied_count + 7};
    table_cell(&table, "case");
    for (size_t p = 0; p < varied_count; p++)
        table_cell(&table, "%s", last_name(varied[p]));
    table_cell(&table, "realisations");
    table_cell(&table, "scalar");
    table_cell(&table, "value");
    table_cell(&table, "std error");
    table_cell(&table, "theory");
    table_cell(&table, "ratio");
    for (const cJSON *one = cases->child; one; one = one->next)
        for (size_t s = 0; s < scalar_count; s++)
            scalar_row(&table, one, varied, varied_count, scalars[s]);
    fprintf(file, "%s (%s), study %s\n", text(curves, "name"), text(curves, "state"),
            text(curves, "study"));
    table_print(&table, file);
    table_clear(&table);
}

/* --- status --- */

void summary_of_status(const cJSON *status, FILE *file) {
    const cJSON *jobs = member(status, "jobs"), *realisations = member(status, "realisations");
    char left[48], spent[48];
    duration_text(number(status, "seconds_left"), left, sizeof left);
    duration_text(number(status, "seconds"), spent, sizeof spent);
    fprintf(file, "%s  %s  %s  %s\n", text(status, "id"), text(status, "name"),
            text(status, "kind"), text(status, "state"));
    fprintf(file, "  realisations %.0f of %.0f, jobs %.0f of %.0f (%.0f running, %.0f failed)\n",
            number(realisations, "done"), number(realisations, "total"), number(jobs, "done"),
            number(jobs, "total"), number(jobs, "running"), number(jobs, "failed"));
    fprintf(file, "  workers %.0f, spent %s, left %s\n", number(status, "workers"), spent, left);
    const cJSON *failures = member(status, "failures");
    for (const cJSON *f = failures ? failures->child : NULL; f; f = f->next)
        fprintf(file,
                "  failed: case %.0f, realisations %.0f to %.0f, %.0f attempts, worker %s: %s\n",
                number(f, "case"), number(f, "first"), number(f, "first") + number(f, "count") - 1,
                number(f, "attempts"), text(f, "worker"), text(f, "reason"));
}

void summary_of_list(const cJSON *studies, FILE *file) {
    const cJSON *list = member(studies, "studies");
    struct text_table table = {.columns = 6};
    static const char *const HEADINGS[] = {"id", "name", "kind", "state", "done %", "created"};
    for (size_t h = 0; h < 6; h++)
        table_cell(&table, "%s", HEADINGS[h]);
    for (const cJSON *s = list ? list->child : NULL; s; s = s->next) {
        const cJSON *realisations = member(s, "realisations");
        table_cell(&table, "%s", text(s, "id"));
        table_cell(&table, "%s", text(s, "name"));
        table_cell(&table, "%s", text(s, "kind"));
        table_cell(&table, "%s", text(s, "state"));
        table_cell(&table, "%.1f",
                   100 * number(realisations, "done") / number(realisations, "total"));
        table_cell(&table, "%s", text(s, "created"));
    }
    table_print(&table, file);
    table_clear(&table);
}

/* --- report --- */

void summary_of_report(const cJSON *report, FILE *file) {
    const cJSON *cases = member(report, "cases");
    const char *varied[COLUMNS_MOST];
    if (!cJSON_IsArray(cases) || !cases->child)
        return;
    size_t varied_count = varied_parameters(cases, varied);
    static const char *const NUMBERS[] = {
        "realisations",         "seconds",     "seconds_per_realisation", "statistical_error",
        "discretisation_error", "model_error", "seconds_to_halve_error"};
    static const char *const HEADINGS[] = {"realisations", "seconds",        "s/realisation",
                                           "statistical",  "discretisation", "model",
                                           "s to halve"};
    enum { NUMBER_COUNT = sizeof NUMBERS / sizeof *NUMBERS };
    struct text_table table = {.columns = 1 + varied_count + NUMBER_COUNT};
    table_cell(&table, "case");
    for (size_t p = 0; p < varied_count; p++)
        table_cell(&table, "%s", last_name(varied[p]));
    for (size_t n = 0; n < NUMBER_COUNT; n++)
        table_cell(&table, "%s", HEADINGS[n]);
    for (const cJSON *one = cases->child; one; one = one->next) {
        table_number(&table, number(one, "case"));
        for (size_t p = 0; p < varied_count; p++)
            value_cell(&table, member(member(one, "parameters"), varied[p]));
        for (size_t n = 0; n < NUMBER_COUNT; n++)
            table_number(&table, number(one, NUMBERS[n]));
    }
    fprintf(file, "%s (%s), study %s: cost, and relative errors of the main curve\n",
            text(report, "name"), text(report, "state"), text(report, "study"));
    table_print(&table, file);
    table_clear(&table);
}
