/* Where a measured surface lies among random surfaces like it: a table a case. */
#include "server/show/summary_like.h"
#include "core/plain_text.h"
#include "server/show/summary_cells.h"
#include <math.h>
#include <string.h>

static const char PERCENTILE[] = "percentile_";

static const struct scalar *other(const struct case_result *one, const char *before,
                                  const char *quantity) {
    char name[120];
    snprintf(name, sizeof name, "%s_%s", before, quantity);
    return result_scalar(one, name);
}

static const char *quantity_of(const struct scalar *scalar) {
    bool is = strncmp(scalar->name, PERCENTILE, sizeof PERCENTILE - 1) == 0;
    return is ? scalar->name + sizeof PERCENTILE - 1 : NULL;
}

static void percentile_cell(struct text_table *table, const struct scalar *scalar) {
    if (isnan(scalar->value))
        table_cell(table, "-");
    else
        table_cell(table, "%.1f", scalar->value);
}

static void put_row(struct text_table *table, const struct case_result *one,
                    const struct scalar *scalar) {
    const char *quantity = quantity_of(scalar);
    const struct scalar *measured = other(one, "measured", quantity);
    const struct scalar *mean = other(one, "piece", quantity);
    double n = (double)one->realisations;
    table_cell(table, "%s", quantity);
    table_number(table, measured != NULL ? measured->value : (double)NAN);
    measured_cell(table, mean != NULL ? mean->value : (double)NAN,
                  mean != NULL ? mean->standard_error : (double)NAN);
    table_number(table, mean != NULL ? mean->standard_error * sqrt(n) : (double)NAN);
    percentile_cell(table, scalar);
}

static void print_name(const struct case_result *one, FILE *file) {
    const struct result_parameter *name = result_parameter(one, "/surface/like/file");
    fprintf(file, "\ncase %llu: the measured surface ", (unsigned long long)one->case_number);
    text_print_plain(file, name != NULL && name->text != NULL ? name->text : "?");
}

/* Contact tells percentiles by curves. */
static bool is_expected(const struct case_result *one) {
    return result_parameter(one, "/surface/like/file") != NULL &&
           result_parameter(one, "/contact/model") == NULL;
}

static void print_head(const struct case_result *one, FILE *file) {
    const struct result_parameter *unit = result_parameter(one, "/surface/like/unit");
    const struct result_parameter *length = result_parameter(one, "/surface/like/wavelength");
    print_name(one, file);
    fputs(" among pieces of random ones like it, lengths in lambda_s", file);
    if (length != NULL && unit != NULL && unit->text != NULL && *unit->text != '\0') {
        fprintf(file, " = %.4g ", length->number);
        text_print_plain(file, unit->text);
    }
    fputc('\n', file);
}

void summary_of_like(const struct case_result *one, FILE *file) {
    struct text_table table = {.columns = 5};
    static const char *const HEADINGS[] = {"quantity", "measured", "mean", "deviation",
                                           "percentile"};
    size_t rows = 0;
    for (size_t h = 0; h < sizeof HEADINGS / sizeof *HEADINGS; h++)
        table_cell(&table, "%s", HEADINGS[h]);
    for (size_t s = 0; s < one->scalar_count; s++)
        if (quantity_of(&one->scalars[s]) != NULL) {
            put_row(&table, one, &one->scalars[s]);
            rows++;
        }
    if (rows > 0) {
        print_head(one, file);
        table_print(&table, file);
    } else if (is_expected(one)) {
        print_name(one, file);
        fputs(" is not placed among random ones: pieces of its size need a cell of at least twice "
              "its sides, and a whole number of the grid's points between two of its own\n",
              file);
    }
    table_clear(&table);
}
