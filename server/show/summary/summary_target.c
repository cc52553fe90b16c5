#include "server/show/summary/summary_target.h"
#include "jobs/target.h"
#include "server/show/summary/summary_cells.h"
#include <math.h>

/* NaN where there is none. */
static double scalar_of(const struct case_result *one, const char *name) {
    const struct scalar *scalar = result_scalar(one, name);
    return scalar != NULL ? scalar->value : (double)NAN;
}

/* Prints which source keeps the answer from the error asked for, and what more sampling would take:
 * sources add up by their squares, and the statistical one falls as the work grows. */
static void print_left(const struct case_result *one, FILE *file) {
    static const char *const SOURCES[] = {"error_mesh", "error_cell", "error_model"};
    static const char *const NAMES[] = {"mesh", "cell", "model"};
    enum { COUNT = sizeof SOURCES / sizeof *SOURCES };
    double asked = scalar_of(one, "error_asked"), chance = scalar_of(one, "error_chance");
    double bounds = 0;
    size_t most = 0;
    for (size_t a = 0; a < COUNT; a++) {
        if (result_scalar(one, SOURCES[a]) != NULL)
            bounds = hypot(bounds, scalar_of(one, SOURCES[a]));
        if (scalar_of(one, SOURCES[a]) > scalar_of(one, SOURCES[most]))
            most = a;
    }
    if (bounds < asked)
        fprintf(file, "Not reached: it would take about %.2g times the work done.\n",
                chance * chance / (asked * asked - bounds * bounds));
    else
        fprintf(file,
                "Not reached: what is left is the %s, which no number of realisations "
                "lessens.\n",
                NAMES[most]);
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
    if (isnan(asked))
        return;
    fprintf(file, "error asked %.3g %%, reached %.3g %%", 100 * asked, 100 * reached);
    if (result_scalar(one, "error_mesh") != NULL)
        fprintf(file, ": statistical %.2g, mesh %.2g, cell %.2g, model %.2g %%",
                100 * scalar_of(one, "error_chance"), 100 * scalar_of(one, "error_mesh"),
                100 * scalar_of(one, "error_cell"), 100 * scalar_of(one, "error_model"));
    fputc('\n', file);
    if (result_scalar(one, "plain_work") != NULL)
        print_work(scalar_of(one, "plain_work") / scalar_of(one, "work"),
                   scalar_of(one, "consistency"), file);
    if (reached > asked)
        print_left(one, file);
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
