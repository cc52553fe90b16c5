#include "server/show/table/text_table.h"
#include "core/error.h"
#include "core/file/plain_text.h"
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

static void append(struct text_table *table, char *text) {
    if (table->cells == table->capacity) {
        size_t capacity = table->capacity > 0 ? 2 * table->capacity : 256;
        char **larger = realloc(table->text, capacity * sizeof *larger);
        if (larger == NULL) {
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
        append(table, text_make_plain(text));
    va_end(arguments);
}

void table_number(struct text_table *table, double value) {
    if (isnan(value))
        table_cell(table, "-");
    else
        table_cell(table, "%.5g", value);
}

/* Counts characters on a screen: bytes that begin a UTF-8 sequence. */
static size_t width_of(const char *text) {
    size_t width = 0;
    for (; *text != '\0'; text++)
        width += ((unsigned char)*text & 0xc0) != 0x80;
    return width;
}

static bool is_numeric(const char *text) {
    return isdigit((unsigned char)*text) || ((*text == '-' || *text == '+') && text[1] != '-');
}

/* How a column shapes: its width, and whether all cells below the heading are numbers. */
struct column_shape {
    size_t width;
    bool numeric;
};

static struct column_shape shape_of(const struct text_table *table, size_t column) {
    size_t rows = table->cells / table->columns;
    struct column_shape shape = {0, rows > 1};
    for (size_t row = 0; row < rows; row++) {
        const char *cell = table->text[row * table->columns + column];
        size_t width = width_of(cell);
        shape.width = width > shape.width ? width : shape.width;
        shape.numeric = shape.numeric && (row == 0 || is_numeric(cell));
    }
    return shape;
}

static void print_cell(const char *cell, const struct column_shape *shape, bool first, bool last,
                       FILE *file) {
    int padding = (int)(shape->width - width_of(cell));
    fprintf(file, "%s%*s%s%*s", first ? "" : "  ", shape->numeric ? padding : 0, "", cell,
            shape->numeric || last ? 0 : padding, "");
}

/* Columns begin to end - 1 of all rows, with the first `keys` columns in front of them. */
static void print_part(const struct text_table *table, const struct column_shape *shapes,
                       size_t keys, size_t begin, size_t end, FILE *file) {
    for (size_t row = 0; row < table->cells / table->columns; row++) {
        char *const *cells = table->text + row * table->columns;
        for (size_t c = 0; c < keys && begin > 0; c++)
            print_cell(cells[c], &shapes[c], c == 0, false, file);
        for (size_t c = begin; c < end; c++)
            print_cell(cells[c], &shapes[c], c == 0, c + 1 == end, file);
        fputc('\n', file);
    }
}

static size_t width_between(const struct column_shape *shapes, size_t begin, size_t end) {
    size_t width = 0;
    for (size_t c = begin; c < end; c++)
        width += shapes[c].width + 2;
    return width;
}

/* Returns the columns of the terminal, or those of the table. */
static size_t room_of(const struct text_table *table, FILE *file) {
    struct winsize size;
    bool known = isatty(fileno(file)) != 0 && ioctl(fileno(file), TIOCGWINSZ, &size) == 0;
    if (known && size.ws_col > 0)
        return size.ws_col;
    return table->room > 0 ? table->room : SIZE_MAX / 2;
}

void table_fold(struct text_table *table) {
    if (table->fold_count < TABLE_FOLDS_MOST)
        table->folds[table->fold_count++] = table->cells;
}

/* Prints a row between bars; a bar within a cell is escaped. */
static void print_between_bars(const struct text_table *table, size_t row, FILE *file) {
    for (size_t c = 0; c < table->columns; c++) {
        fputs(c > 0 ? " " : "| ", file);
        for (const char *text = table->text[row * table->columns + c]; *text != '\0'; text++)
            fprintf(file, *text == '|' ? "\\%c" : "%c", *text);
        fputs(" |", file);
    }
    fputc('\n', file);
}

static void print_markdown(const struct text_table *table, const struct column_shape *shapes,
                           FILE *file) {
    for (size_t row = 0; row < table->cells / table->columns; row++) {
        print_between_bars(table, row, file);
        for (size_t c = 0; c < table->columns && row == 0; c++)
            fprintf(file, "%s%s", c > 0 ? " " : "| ", shapes[c].numeric ? "---: |" : "--- |");
        if (row == 0)
            fputc('\n', file);
    }
}

void table_print(const struct text_table *table, FILE *file) {
    struct column_shape *shapes =
        table->failed ? NULL : array_create(table->columns, sizeof *shapes);
    if (shapes == NULL || table->columns == 0) {
        free(shapes);
        fprintf(file, "(no memory for a table)\n");
        return;
    }
    for (size_t c = 0; c < table->columns; c++)
        shapes[c] = shape_of(table, c);
    if (table->markdown) {
        print_markdown(table, shapes, file);
        free(shapes);
        return;
    }
    size_t keys = table->fold_count > 0 ? table->folds[0] : 0, room = room_of(table, file);
    size_t begin = 0, end = 0, key_width = width_between(shapes, 0, keys);
    for (size_t fold = 0; fold <= table->fold_count; fold++) {
        size_t next = fold < table->fold_count ? table->folds[fold] : table->columns;
        /* the last gap is no width */
        bool fits = (begin > 0 ? key_width : 0) + width_between(shapes, begin, next) <= room + 2;
        if (!fits && end > keys) {
            print_part(table, shapes, keys, begin, end, file);
            fputc('\n', file);
            begin = end;
        }
        end = next;
    }
    print_part(table, shapes, keys, begin, end, file);
    free(shapes);
}

void table_clear(struct text_table *table) {
    for (size_t i = 0; i < table->cells; i++)
        free(table->text[i]);
    free(table->text);
    *table = (struct text_table){.columns = table->columns, .room = table->room};
}

void print_folded(FILE *file, const char *text) {
    while (strlen(text) > TABLE_ROOM) {
        size_t length = TABLE_ROOM;
        while (length > 0 && text[length] != ' ')
            length--;
        if (length == 0)
            length = strcspn(text, " ");
        fprintf(file, "%.*s\n", (int)length, text);
        text += length + (text[length] == ' ');
        if (*text == '\0')
            return;
    }
    fprintf(file, "%s\n", text);
}
