#include "core/file/memory_file.h"
#include "core/map/length_unit.h"
#include "schema/json/json.h"
#include "server/show/map/named_values.h"
#include "server/show/plot/plot_words.h"
#include "server/show/table/text_table.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns whether entry n is the first one of its group. */
static bool begins_group(const struct named_values *values, size_t n) {
    const struct named_value *list = values->list;
    return n == 0 || strcmp(list[n].group, list[n - 1].group) != 0;
}

/* Returns whether column n is the first one of its group, or there are no more. */
static bool begins_table(const struct named_values *values, size_t n) {
    const struct named_column *columns = values->columns;
    return n == 0 || n == values->column_count ||
           strcmp(columns[n].group, columns[n - 1].group) != 0;
}

/* The unit in which a value in metres to a power is best read, "\xc2\xb5m^2"; returns how much of
 * the value's unit one of it is. */
static double readable_unit(double value, int power, char text[24]) {
    double metres = 1;
    double length = value != 0 && isfinite(value) ? pow(fabs(value), 1.0 / power) : 1;
    const char *unit = length_unit_readable(length, &metres);
    if (power == 1)
        snprintf(text, 24, "%s", unit);
    else if (power == -1)
        snprintf(text, 24, "1/%s", unit);
    else if (power < 0)
        snprintf(text, 24, "1/%s^%d", unit, -power);
    else
        snprintf(text, 24, "%s^%d", unit, power);
    return pow(metres, power);
}

/* The geometric mean of the largest and the least value of a column but 0; 0: it has none. */
static double column_size(const struct named_column *column) {
    double most = 0, least = INFINITY;
    for (size_t row = 0; row < column->count; row++) {
        double size = fabs(column->values[row]);
        most = size > most ? size : most;
        least = size > 0 && size < least ? size : least;
    }
    return most > 0 ? sqrt(most) * sqrt(least) : 0;
}

/* Returns whether the name is that of another column with an ending: "rms_error" of "rms". */
static bool belongs_to(const char *name, const char *other) {
    size_t length = strlen(other);
    return strncmp(name, other, length) == 0 && name[length] == '_';
}

/* The unit of column c of a table: that in which its own size is best read, or, of the errors, the
 * band or the fit of another column, the unit of that. */
static double column_unit(const struct named_column *columns, size_t count, size_t c,
                          char text[24]) {
    double size = column_size(&columns[c]);
    for (size_t other = 0; other < count; other++)
        if (columns[other].power == columns[c].power &&
            belongs_to(columns[c].name, columns[other].name) && column_size(&columns[other]) > 0)
            size = column_size(&columns[other]);
    return readable_unit(size, columns[c].power, text);
}

/* The largest of the group of entry n that have its unit. */
static double largest_beside(const struct named_values *values, size_t n) {
    const struct named_value *entry = &values->list[n];
    double most = 0;
    for (size_t e = 0; e < values->count; e++) {
        const struct named_value *other = &values->list[e];
        if (other->power == entry->power && strcmp(other->group, entry->group) == 0 &&
            fabs(other->value) > most)
            most = fabs(other->value);
    }
    return most;
}

/* Returns the entry of this group and name; NULL where there is none. */
static const struct named_value *entry_of(const struct named_values *values, const char *group,
                                          const char *name, size_t length, const char *ending) {
    for (size_t e = 0; e < values->count; e++) {
        const struct named_value *entry = &values->list[e];
        if (strcmp(entry->group, group) == 0 && strncmp(entry->name, name, length) == 0 &&
            strcmp(entry->name + length, ending) == 0)
            return entry;
    }
    return NULL;
}

/* Returns the value of which a name is the error or an end of the interval; its own otherwise. */
static size_t length_of_owner(const struct named_values *values, const char *group,
                              const char *name) {
    static const char *const ENDINGS[] = {"_error", "_low", "_high"};
    const size_t length = strlen(name);
    for (size_t e = 0; e < sizeof ENDINGS / sizeof *ENDINGS; e++) {
        const size_t ending = strlen(ENDINGS[e]);
        if (length > ending && strcmp(name + length - ending, ENDINGS[e]) == 0 &&
            entry_of(values, group, name, length - ending, "") != NULL)
            return length - ending;
    }
    return length;
}

static double value_beside(const struct named_values *values, const char *group, const char *name,
                           size_t length, const char *ending) {
    const struct named_value *entry = entry_of(values, group, name, length, ending);
    return entry != NULL ? entry->value : (double)NAN;
}

/* Returns the standard error of entry n, or half the interval around it; NaN where none is known.
 * Errors and ends of intervals have that of their value. */
static double error_of_entry(const struct named_values *values, size_t n) {
    const char *group = values->list[n].group, *name = values->list[n].name;
    const size_t length = length_of_owner(values, group, name);
    const double error = value_beside(values, group, name, length, "_error");
    const double low = value_beside(values, group, name, length, "_low");
    const double high = value_beside(values, group, name, length, "_high");
    return isfinite(error) ? error : (high - low) / 2;
}

/* Prints a value, in the unit it is printed in, to two digits of its error in that unit, or to six
 * digits. Beside `largest` what is rounding is 0; that is not known of numbers without a unit. */
static void print_rounded(FILE *file, double value, double error, double largest) {
    static const double ROUNDING = 1e-13, SMALL = 1e-4, LARGE = 1e5;
    const bool has_error = error > 0 && isfinite(error);
    const int decimals = has_error ? 1 - (int)floor(log10(error)) : 0;
    if (fabs(value) < ROUNDING * largest)
        fputs("0", file);
    else if (!has_error)
        fprintf(file, value == floor(value) ? "%.10g" : "%.6g", value);
    else if (decimals > 9 || (value != 0 && fabs(value) < SMALL))
        fprintf(file, "%.4g", value);
    else if (decimals >= 0)
        fprintf(file, "%.*f", decimals, value);
    else if (error < LARGE)
        fprintf(file, "%.0f", round(value * pow(10, decimals)) * pow(10, -decimals));
    else
        fprintf(file, "%.*g", (int)fmax(2, 2 + floor(log10(fabs(value) / error))), value);
}

enum { ROWS_SHOWN = 20, COLUMNS_SHOWN = NAMED_COLUMNS_MOST };

/* Of longer columns the rows 0, 1, 2, 3, 4, 6, 8, 12, 16, ... are shown, and the last one. */
static bool is_row_shown(size_t row, size_t count) {
    size_t power = 1;
    while (2 * power <= row)
        power *= 2;
    return count <= ROWS_SHOWN || row == 0 || row == power || 2 * row == 3 * power ||
           row + 1 == count;
}

/* Prints the columns of one group. */
static void table_of_columns(FILE *file, bool in_metres, const struct named_column *columns,
                             size_t count) {
    struct text_table table = {.columns = count};
    double unit[COLUMNS_SHOWN];
    for (size_t c = 0; c < count; c++) {
        char text[24];
        unit[c] = 1;
        if (in_metres && columns[c].power != 0) {
            unit[c] = column_unit(columns, count, c, text);
            table_cell(&table, "%s[%s]", columns[c].name, text);
        } else
            table_cell(&table, "%s", columns[c].name);
    }
    for (size_t row = 0; row < columns->count; row++)
        for (size_t c = 0; c < count && is_row_shown(row, columns->count); c++) {
            double value = columns[c].values[row] / unit[c];
            table_number(&table, isfinite(value) ? value : (double)NAN); /* as a single one */
        }
    fprintf(file, "%s\n", columns->group);
    table_print(&table, file);
    table_clear(&table);
}

enum { NAME_WIDTH = 18 };

/* Returns how wide the names of the group are printed that begins with entry n. */
static int name_width(const struct named_values *values, size_t n) {
    size_t width = NAME_WIDTH, first = n;
    for (; n < values->count && (n == first || !begins_group(values, n)); n++) {
        size_t length = strlen(values->list[n].name);
        width = length > width ? length : width;
    }
    return (int)width;
}

static void entry_print(FILE *file, const struct named_values *values, size_t n, int width) {
    const struct named_value *entry = &values->list[n];
    fprintf(file, "  %-*s ", width, entry->name);
    if (entry->text != NULL)
        fprintf(file, "%s\n", entry->text);
    else if (isfinite(entry->value)) {
        const bool has_unit = values->in_metres && entry->power != 0;
        const double most = entry->power != 0 ? largest_beside(values, n) : 0;
        char unit[24] = "";
        const double one = has_unit ? readable_unit(most, entry->power, unit) : 1;
        print_rounded(file, entry->value / one, error_of_entry(values, n) / one, most / one);
        fprintf(file, "%s%s\n", has_unit ? " " : "", unit);
    } else
        fprintf(file, "-\n");
}

void named_values_print(FILE *file, const struct named_values *values) {
    int width = NAME_WIDTH;
    for (size_t n = 0; n < values->count; n++) {
        if (begins_group(values, n)) {
            width = name_width(values, n);
            fprintf(file, "%s\n", values->list[n].group);
        }
        entry_print(file, values, n, width);
    }
    size_t first = 0;
    for (size_t c = 1; c <= values->column_count; c++)
        if (begins_table(values, c)) {
            table_of_columns(file, values->in_metres, values->columns + first, c - first);
            first = c;
        }
}

/* Prints the name of an entry, and that of its group before the first of it. */
static bool print_name_json(FILE *file, const char *group, bool begins, const char *before,
                            const char *name) {
    bool done = true;
    if (begins) {
        fputs(before, file);
        done = json_print_text(file, group);
    }
    fputs(begins ? ":{" : ",", file);
    done = done && json_print_text(file, name);
    fputc(':', file);
    return done;
}

static bool print_columns_json(FILE *file, const struct named_values *values) {
    bool done = true;
    for (size_t c = 0; c < values->column_count && done; c++) {
        const struct named_column *column = &values->columns[c];
        done = print_name_json(file, column->group, begins_table(values, c), c > 0 ? "}," : ",",
                               column->name);
        fputc('[', file);
        for (size_t row = 0; row < column->count; row++) {
            fputs(row > 0 ? "," : "", file);
            json_print_number(file, column->values[row]);
        }
        fputc(']', file);
    }
    fputs(values->column_count > 0 ? "}" : "", file);
    return done;
}

bool named_values_print_json(FILE *file, const struct named_values *values) {
    bool done = true;
    fputc('{', file);
    for (size_t n = 0; n < values->count && done; n++) {
        const struct named_value *entry = &values->list[n];
        done = print_name_json(file, entry->group, begins_group(values, n), n > 0 ? "}," : "",
                               entry->name);
        if (entry->text == NULL)
            json_print_number(file, entry->value);
        else
            done = done && json_print_text(file, entry->text);
    }
    fputs(values->count > 0 ? "}" : "", file);
    done = done && print_columns_json(file, values);
    fputc('}', file);
    return done;
}

int named_values_draw_metadata(FILE *file, const struct named_values *values, struct error *err) {
    struct memory_file memory;
    if (!memory_file_open(&memory))
        return error_memory(err, 0, "the numbers of a page");
    bool done = named_values_print_json(memory.file, values);
    char *text = memory_file_close(&memory, NULL);
    done = done && text != NULL;
    if (done) {
        fputs("<metadata>", file);
        svg_text(file, text);
        fputs("</metadata>\n", file);
    }
    free(text);
    return done ? 0 : error_memory(err, 0, "the numbers of a page");
}
