#include "server/show/summary/summary_target.h"
#include "jobs/target.h"
#include "server/show/summary/summary_cells.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* NaN where there is none. */
static double scalar_of(const struct case_result *one, const char *name) {
    const struct scalar *scalar = result_scalar(one, name);
    return scalar != NULL ? scalar->value : (double)NAN;
}

/* A source of the error reached. */
struct part {
    const char *scalar, *name;
    double error; /* relative */
};

enum { PARTS = 5 };

static int compare_parts(const void *a, const void *b) {
    double left = ((const struct part *)a)->error, right = ((const struct part *)b)->error;
    return left > right ? -1 : left < right;
}

/* Lists the sources of which a case has an error, the largest first; returns their number. What
 * older programs published has no error of the solver. */
static size_t parts_of(const struct case_result *one, struct part parts[PARTS]) {
    static const struct part ALL[PARTS] = {{"error_chance", "statistical", 0},
                                           {"error_mesh", "mesh", 0},
                                           {"error_cell", "cell", 0},
                                           {"error_model", "model", 0},
                                           {"error_solver", "solver", 0}};
    size_t count = 0;
    for (size_t a = 0; a < PARTS; a++) {
        parts[count] = ALL[a];
        parts[count].error = scalar_of(one, ALL[a].scalar);
        count += parts[count].error > 0 ? 1 : 0;
    }
    qsort(parts, count, sizeof *parts, compare_parts);
    return count;
}

/* Prints which source keeps the answer from the error asked for, and what more sampling would take:
 * sources add up by their squares, and the statistical one falls as the work grows. */
static void print_left(const struct case_result *one, size_t count, const struct part *parts,
                       FILE *file) {
    double asked = scalar_of(one, "error_asked"), chance = scalar_of(one, "error_chance");
    double bounds = 0;
    const char *most = "";
    for (size_t a = count; a-- > 0;)
        if (strcmp(parts[a].scalar, "error_chance") != 0) {
            bounds = hypot(bounds, parts[a].error);
            most = parts[a].name;
        }
    if (bounds < asked)
        fprintf(file, "Not reached: it would take about %.2g times the work done.\n",
                chance * chance / (asked * asked - bounds * bounds));
    else
        fprintf(file,
                "Not reached: what is left is the %s, which no number of realisations "
                "lessens.\n",
                most);
}

/* less: how many times as much plain sampling takes. */
static void print_work(double less, double consistency, FILE *file) {
    if (less >= 1)
        fprintf(file, "work: 1/%.3g of plain sampling", less);
    else
        fprintf(file, "work: %.3g times that of plain sampling", 1 / less);
    if (!isnan(consistency))
        fprintf(file, "; levels agree within %.2g standard errors", consistency);
    fputc('\n', file);
}

void summary_of_target(const struct case_result *one, FILE *file) {
    double asked = scalar_of(one, "error_asked"), reached = scalar_of(one, "error_reached");
    struct part parts[PARTS];
    size_t count;
    if (isnan(asked))
        return;
    fprintf(file, "error asked %.3g %%, reached %.3g %%", 100 * asked, 100 * reached);
    count = parts_of(one, parts);
    for (size_t a = 0; a < count && count > 1; a++)
        fprintf(file, "%s %s %.2g", a == 0 ? ":" : ",", parts[a].name, 100 * parts[a].error);
    fputs(count > 1 ? " %\n" : "\n", file);
    if (result_scalar(one, "plain_work") != NULL)
        print_work(scalar_of(one, "plain_work") / scalar_of(one, "work"),
                   scalar_of(one, "consistency"), file);
    if (reached > asked)
        print_left(one, count, parts, file);
}

void summary_of_plan(const struct study_case *one, FILE *file) {
    static const char *const HEADINGS[] = {"component", "grid", "realisations at first", "expected",
                                           "CPU time of all"};
    struct text_table table = {.columns = sizeof HEADINGS / sizeof *HEADINGS};
    uint64_t expected[TARGET_PARTS_MOST];
    char time[48];
    if (one->component_count == 0 || one->component_count > TARGET_PARTS_MOST)
        return;
    double seconds = target_expect(one, expected);
    for (size_t h = 0; h < table.columns; h++)
        table_cell(&table, "%s", HEADINGS[h]);
    for (size_t a = 0; a < one->component_count; a++) {
        const struct study_case *component = &one->components[a];
        duration_text((double)expected[a] * component->cost.seconds, time, sizeof time);
        table_cell(&table, "%s", component->role);
        table_cell(&table, "%zu x %zu", component->cost.nx, component->cost.ny);
        table_cell(&table, "%llu", (unsigned long long)component->realisations);
        table_cell(&table, "%llu", (unsigned long long)expected[a]);
        table_cell(&table, "%s", time);
    }
    table_print(&table, file);
    table_clear(&table);
    duration_text(seconds, time, sizeof time);
    fprintf(file, "expected to take about %s of CPU\n", time);
}
