#include "schema/json/json.h"
#include "server/show/characterisation.h"
#include "server/show/text_table.h"
#include <math.h>
#include <string.h>

/* Returns whether entry n is the first one of its group. */
static bool begins_group(const struct characterisation *characterisation, size_t n) {
    const struct characteristic *list = characterisation->list;
    return n == 0 || strcmp(list[n].group, list[n - 1].group) != 0;
}

/* Returns whether column n is the first one of its group, or there are no more. */
static bool begins_table(const struct characterisation *characterisation, size_t n) {
    const struct characteristic_column *columns = characterisation->columns;
    return n == 0 || n == characterisation->column_count ||
           strcmp(columns[n].group, columns[n - 1].group) != 0;
}

enum { ROWS_SHOWN = 20 };

/* Of longer columns the rows 0, 1, 2, 3, 4, 6, 8, 12, 16, ... are shown, and the last one. */
static bool is_row_shown(size_t row, size_t count) {
    size_t power = 1;
    while (2 * power <= row)
        power *= 2;
    return count <= ROWS_SHOWN || row == 0 || row == power || 2 * row == 3 * power ||
           row + 1 == count;
}

/* Prints the columns of one group. */
static void table_of_columns(FILE *file, const struct characteristic_column *columns,
                             size_t count) {
    struct text_table table = {.columns = count};
    for (size_t c = 0; c < count; c++)
        table_cell(&table, "%s", columns[c].name);
    for (size_t row = 0; row < columns->count; row++)
        for (size_t c = 0; c < count && is_row_shown(row, columns->count); c++)
            table_number(&table, columns[c].values[row]);
    fprintf(file, "%s\n", columns->group);
    table_print(&table, file);
    table_clear(&table);
}

void characterisation_print(FILE *file, const struct characterisation *characterisation) {
    for (size_t n = 0; n < characterisation->count; n++) {
        const struct characteristic *entry = &characterisation->list[n];
        if (begins_group(characterisation, n))
            fprintf(file, "%s\n", entry->group);
        if (entry->text != NULL)
            fprintf(file, "  %-18s %s\n", entry->name, entry->text);
        else if (isfinite(entry->value))
            fprintf(file, "  %-18s %.10g\n", entry->name, entry->value);
        else
            fprintf(file, "  %-18s -\n", entry->name);
    }
    size_t first = 0;
    for (size_t c = 1; c <= characterisation->column_count; c++)
        if (begins_table(characterisation, c)) {
            table_of_columns(file, characterisation->columns + first, c - first);
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

static bool print_columns_json(FILE *file, const struct characterisation *characterisation) {
    bool done = true;
    for (size_t c = 0; c < characterisation->column_count && done; c++) {
        const struct characteristic_column *column = &characterisation->columns[c];
        done = print_name_json(file, column->group, begins_table(characterisation, c),
                               c > 0 ? "}," : ",", column->name);
        fputc('[', file);
        for (size_t row = 0; row < column->count; row++) {
            fputs(row > 0 ? "," : "", file);
            json_print_number(file, column->values[row]);
        }
        fputc(']', file);
    }
    fputs(characterisation->column_count > 0 ? "}" : "", file);
    return done;
}

bool characterisation_print_json(FILE *file, const struct characterisation *characterisation) {
    bool done = true;
    fputc('{', file);
    for (size_t n = 0; n < characterisation->count && done; n++) {
        const struct characteristic *entry = &characterisation->list[n];
        done = print_name_json(file, entry->group, begins_group(characterisation, n),
                               n > 0 ? "}," : "", entry->name);
        if (entry->text == NULL)
            json_print_number(file, entry->value);
        else
            done = done && json_print_text(file, entry->text);
    }
    fputs(characterisation->count > 0 ? "}" : "", file);
    done = done && print_columns_json(file, characterisation);
    fputc('}', file);
    return done;
}
