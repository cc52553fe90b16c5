/* What theory expects: a table a case for a few cases, a row each for many. */
#include "server/show/summary.h"
#include "server/show/summary_cells.h"
#include <math.h>

enum { TABLES_MOST = 3 };

/* Of many cases these are shown. */
static const char *const HEADLINES[] = {"nayak_alpha",
                                        "nayak_alpha_continuous",
                                        "summit_density",
                                        "summit_height_mean",
                                        "summit_height_variance",
                                        "summit_height_skewness",
                                        "summit_height_kurtosis",
                                        "summit_curvature_mean"};
enum { HEADLINE_COUNT = sizeof HEADLINES / sizeof *HEADLINES };

static bool has_grid(const struct shown_cases *shown, const char *name) {
    for (size_t c = 0; c < shown->count; c++) {
        const struct scalar *scalar = result_scalar(shown->list[c], name);
        if (scalar != NULL && !isnan(scalar->grid))
            return true;
    }
    return false;
}

static void print_rows(const struct shown_cases *shown, FILE *file) {
    struct text_table table = {.columns = 1 + shown->varied_count + HEADLINE_COUNT};
    bool grid[HEADLINE_COUNT];
    for (size_t h = 0; h < HEADLINE_COUNT; h++)
        table.columns += grid[h] = has_grid(shown, HEADLINES[h]);
    table_cell(&table, "case");
    varied_headings(&table, shown);
    for (size_t h = 0; h < HEADLINE_COUNT; h++) {
        table_fold(&table);
        table_cell(&table, "%s", HEADLINES[h]);
        if (grid[h])
            table_cell(&table, "grid");
    }
    for (size_t c = 0; c < shown->count; c++) {
        table_number(&table, (double)shown->list[c]->case_number);
        varied_cells(&table, shown, c);
        for (size_t h = 0; h < HEADLINE_COUNT; h++) {
            const struct scalar *scalar = result_scalar(shown->list[c], HEADLINES[h]);
            table_number(&table, scalar != NULL ? scalar->value : (double)NAN);
            if (grid[h])
                table_number(&table, scalar != NULL ? scalar->grid : (double)NAN);
        }
    }
    table_print(&table, file);
    table_clear(&table);
}

static void print_case(const struct shown_cases *shown, size_t c, FILE *file) {
    const struct case_result *one = shown->list[c];
    struct text_table table = {.columns = 4};
    if (shown->count > 1) {
        fprintf(file, "%scase %llu: ", c > 0 ? "\n" : "", (unsigned long long)one->case_number);
        print_swept(shown, c, file);
        fputs("by theory\n", file);
    }
    table_cell(&table, "expected");
    table_cell(&table, "without a grid");
    table_cell(&table, "on the grid");
    table_cell(&table, "ratio");
    for (size_t s = 0; s < one->scalar_count; s++) {
        const struct scalar *scalar = &one->scalars[s];
        table_cell(&table, "%s", scalar->name);
        table_number(&table, scalar->value);
        table_number(&table, scalar->grid);
        table_number(&table, scalar->grid / scalar->value);
    }
    table_print(&table, file);
    table_clear(&table);
}

void summary_of_theory(const struct study_result *study, FILE *file) {
    struct shown_cases shown;
    if (study->case_count == 0)
        return;
    if (!shown_of_results(study, &shown)) {
        fputs("(no memory for a table)\n", file);
        return;
    }
    if (shown.count > TABLES_MOST)
        print_rows(&shown, file);
    for (size_t c = 0; c < shown.count && shown.count <= TABLES_MOST; c++)
        print_case(&shown, c, file);
    shown_clear(&shown);
}
