#include "server/text_table.h"
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static void append(struct text_table *table, char *text) {
    if (table->cells == table->capacity) {
        size_t capacity = table->capacity ? 2 * table->capacity : 256;
        char **larger = realloc(table->text, capacity * sizeof *larger);
        if (!larger) {
            free(text);
            table->failed = true;
            return;
        }
        table->text = larger;
        table->capacity = capacity;
    }
    table->text[table->cells++] = text;
}

void table_cell(struct text_table *table, const char *format, ...) {
    va_list arguments;
    char *text = NULL;
    va_start(arguments, format);
    if (table->failed || vasprintf(&text, format, arguments) < 0)
        table->failed = true;
    else
        append(table, text);
    va_end(arguments);
}

void table_number(struct text_table *table, double value) {
    if (isnan(value))
        table_cell(table, "-");
    else
        table_cell(table, "%.5g", value);
}

/* Characters on a screen: bytes that begin a UTF-8 sequence. */
static size_t width_of(const char *text) {
    size_t width = 0;
    for (; *text; text++)
        width += ((unsigned char)*text & 0xc0) != 0x80;
    return width;
}

static bool is_numeric(const char *text) {
    return isdigit((unsigned char)*text) || ((*text == '-' || *text == '+') && text[1] != '-');
}

void table_print(const struct text_table *table, FILE *file) {
    if (table->failed || !table->columns) {
        fprintf(file, "(no memory for a table)\n");
        return;
    }
    size_t rows = table->cells / table->columns;
    for (size_t row = 0; row < rows; row++) {
        for (size_t column = 0; column < table->columns; column++) {
            size_t widest = 0;
            bool numeric = rows > 1;
            for (size_t r = 0; r < rows; r++) {
                const char *cell = table->text[r * table->columns + column];
                size_t width = width_of(cell);
                widest = width > widest ? width : widest;
                numeric = numeric && (r == 0 || is_numeric(cell));
            }
            const char *cell = table->text[row * table->columns + column];
            int padding = (int)(widest - width_of(cell));
            bool last = column + 1 == table->columns;
            fprintf(file, "%s%*s%s%*s", column ? "  " : "", numeric ? padding : 0, "", cell,
                    numeric || last ? 0 : padding, "");
        }
        fputc('\n', file);
    }
}

void table_clear(struct text_table *table) {
    for (size_t i = 0; i < table->cells; i++)
        free(table->text[i]);
    free(table->text);
    *table = (struct text_table){.columns = table->columns};
}
