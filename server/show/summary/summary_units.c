#include "server/show/summary/summary_units.h"
#include "jobs/units.h"
#include "server/show/quantity.h"
#include "server/show/summary/summary_cells.h"
#include <math.h>
#include <string.h>

enum { UNIT_SIZE = 32 };

/* Returns the scale that all cases have; NaN where they differ, or have none. */
static double common_scale(const struct shown_cases *shown, bool modulus) {
    double common = NAN;
    for (size_t c = 0; c < shown->count; c++) {
        double scales[2];
        units_scales(shown->list[c], &scales[0], &scales[1]);
        if (c > 0 && !same_number(common, scales[modulus]))
            return NAN;
        common = scales[modulus];
    }
    return common;
}

static bool print_scale(const char *name, double scale, const char *si, bool first, FILE *file) {
    char unit[UNIT_SIZE];
    if (isnan(scale))
        return first;
    double readable = unit_readable(si, scale, unit, sizeof unit);
    fprintf(file, "%s%s = %.4g %s", first ? "units: " : ", ", name, scale / readable, unit);
    return false;
}

void print_scales(const struct shown_cases *shown, FILE *file) {
    bool none = print_scale("lambda_s", common_scale(shown, false), "m", true, file);
    none = print_scale("E*", common_scale(shown, true), "Pa", none, file);
    if (!none)
        fputc('\n', file);
}

/* A column of a scalar, in the unit in which its largest value is best read. */
struct column {
    const char *name, *unit;
    double largest; /* in SI units */
};

/* Finds the scalars with a unit and a value; those of the first case that has them come first. */
static size_t find_columns(const struct shown_cases *shown, struct column columns[COLUMNS_MOST]) {
    size_t count = 0;
    for (size_t c = 0; c < shown->count; c++)
        for (size_t s = 0; s < shown->list[c]->scalar_count; s++) {
            const struct scalar *scalar = &shown->list[c]->scalars[s];
            double value = fabs(scalar->value * scalar->unit.scale);
            size_t n = 0;
            if (scalar->unit.unit == NULL || isnan(value))
                continue;
            while (n < count && strcmp(columns[n].name, scalar->name) != 0)
                n++;
            if (n == COLUMNS_MOST)
                continue;
            if (n == count)
                columns[count++] = (struct column){scalar->name, scalar->unit.unit, value};
            columns[n].largest = fmax(columns[n].largest, value);
        }
    return count;
}

static void put_case(const struct shown_cases *shown, size_t c, size_t count,
                     const struct column columns[], struct text_table *table) {
    table_number(table, (double)shown->list[c]->case_number);
    varied_cells(table, shown, c);
    for (size_t n = 0; n < count; n++) {
        const struct scalar *scalar = result_scalar(shown->list[c], columns[n].name);
        char unit[UNIT_SIZE];
        double scale = unit_readable(columns[n].unit, columns[n].largest, unit, sizeof unit);
        if (scalar == NULL || scalar->unit.unit == NULL)
            table_cell(table, "-");
        else
            measured_cell(table, scalar->value * scalar->unit.scale / scale,
                          scalar->standard_error * scalar->unit.scale / scale);
    }
}

void print_units(const struct shown_cases *shown, FILE *file) {
    struct column columns[COLUMNS_MOST];
    size_t count = find_columns(shown, columns);
    struct text_table table = {.columns = 1 + shown->varied_count + count};
    if (count == 0)
        return;
    fputc('\n', file);
    print_scales(shown, file);
    table_cell(&table, "case");
    varied_headings(&table, shown);
    for (size_t n = 0; n < count; n++) {
        char unit[UNIT_SIZE];
        (void)unit_readable(columns[n].unit, columns[n].largest, unit, sizeof unit);
        table_fold(&table);
        table_cell(&table, "%s, %s", columns[n].name, unit);
    }
    for (size_t c = 0; c < shown->count; c++)
        put_case(shown, c, count, columns, &table);
    table_print(&table, file);
    table_clear(&table);
}
