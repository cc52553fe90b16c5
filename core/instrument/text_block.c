#include "core/instrument/text_block.h"
#include "core/instrument/text_number.h"
#include "core/map/length_unit.h"
#include <stdlib.h>
#include <string.h>

enum { BLOCKS_MOST = 1000, LINES_SEEN = 100, BYTES_SEEN = 16384 };

/* Which of x, y and z a column is named for: "X", "y [um]", "Z(nm)", "x in mm"; 3 where for none.
 */
static size_t axis_of(const struct text_field *field) {
    const char *at = field->at;
    while (at < field->end && (*at == '#' || text_is_blank(*at)))
        at++;
    size_t axis = at < field->end ? (size_t)(*at | 32) - 'x' : 3;
    bool word = at + 1 < field->end && strchr(" [(/_\"", at[1]) == NULL;
    return axis < 3 && !word ? axis : 3;
}

static void take_column_unit(struct text_header *header, size_t axis, const char *at,
                             const char *end) {
    char *const units[3] = {header->x_unit, header->y_unit, header->z_unit};
    char unit[TEXT_UNIT_ROOM];
    double metres;
    const char *last = end;
    while (last > at && (text_is_blank(last[-1]) || last[-1] == ')' || last[-1] == ']'))
        last--;
    const char *first = last;
    while (first > at && strchr(" [(/_", first[-1]) == NULL)
        first--;
    text_unit_copy(unit, first, last);
    if (length_unit_metres(unit, strlen(unit), &metres))
        memcpy(units[axis], unit, sizeof unit);
}

static char separator_of_names(struct text_line line) {
    for (const char *mark = ";\t,"; *mark != '\0'; mark++)
        if (memchr(line.at, *mark, (size_t)(line.end - line.at)) != NULL)
            return *mark;
    return ' ';
}

/* A line that names columns x, y and z. Between blanks, a unit in brackets belongs to the name
 * before it. */
static bool take_names(struct text_block *block, struct text_line line) {
    const char separator = separator_of_names(line);
    struct text_columns columns = {0};
    struct text_header header = block->header;
    struct text_field field;
    size_t column = 0, last = 3;
    bool found[3] = {false, false, false};
    while (text_field_next(&line, separator, &field)) {
        if (separator == ' ' && field.at < field.end && strchr("[(#", *field.at) != NULL &&
            axis_of(&field) == 3) {
            if (last < 3)
                take_column_unit(&header, last, field.at, field.end);
            continue;
        }
        last = axis_of(&field);
        if (last < 3 && !found[last]) {
            found[last] = true;
            columns.of[last] = column;
            if (field.end - field.at > 1)
                take_column_unit(&header, last, field.at + 1, field.end);
        }
        column++;
    }
    columns.named = found[0] && found[1] && found[2];
    if (!columns.named)
        return false;
    block->columns = columns;
    block->header = header;
    return true;
}

/* The line behind the names may hold a unit for each column. */
static bool take_units(struct text_block *block, struct text_line line) {
    char *const units[3] = {block->header.x_unit, block->header.y_unit, block->header.z_unit};
    struct text_field field;
    const char separator = separator_of_names(line);
    bool taken = false;
    for (size_t column = 0; block->columns.named && text_field_next(&line, separator, &field);
         column++)
        for (size_t axis = 0; axis < 3; axis++) {
            char unit[TEXT_UNIT_ROOM];
            double metres;
            text_unit_copy(unit, field.at, field.end);
            if (block->columns.of[axis] != column ||
                !length_unit_metres(unit, strlen(unit), &metres))
                continue;
            memcpy(units[axis], unit, sizeof unit);
            taken = true;
        }
    return taken;
}

/* One line before the numbers of a block; false where nothing in it is known. */
static bool take_header_line(struct text_block *block, struct text_line line) {
    return text_header_take(&block->header, line) || take_names(block, line) ||
           take_units(block, line);
}

static int add_block(struct text_blocks *blocks, const struct text_block *block, size_t line,
                     struct error *err) {
    if (blocks->count == BLOCKS_MOST)
        return error_set(err, ERROR_INPUT, "line %zu: more than %d blocks of numbers", line,
                         BLOCKS_MOST);
    struct text_block *more = realloc(blocks->blocks, (blocks->count + 1) * sizeof *blocks->blocks);
    if (more == NULL)
        return error_memory(err, (blocks->count + 1) * sizeof *more, "the blocks of a text");
    blocks->blocks = more;
    blocks->blocks[blocks->count++] = *block;
    return 0;
}

bool text_goes_on(struct text_line line, char separator) {
    struct text_dialect dialect = {.separator = separator};
    struct text_field field;
    double number;
    if (*line.at == '#')
        return false;
    if (strchr("+-.0123456789", *line.at) != NULL)
        return true;
    return text_field_next(&line, separator, &field) &&
           text_value_of(&field, &dialect, &number) != TEXT_OTHER;
}

int text_blocks_find(struct text_blocks *out, const struct text_file *file, struct error *err) {
    struct text_blocks blocks = {0};
    struct text_block block = {0};
    struct text_line line = {0};
    const char *next = file->text, *end = file->text + file->size;
    char separator = '\0'; /* of the block whose numbers are passed; 0: none */
    int status = 0;
    while (status == 0 && text_line_next(&line, &next, end)) {
        if (line.at == line.end || (separator != '\0' && text_goes_on(line, separator)))
            continue;
        if (separator != '\0') {
            struct text_block begun = {0};
            if (take_header_line(&begun, line)) {
                block = begun;
                separator = '\0';
            } else if (*line.at != '#') {
                status = error_set(
                    err, ERROR_INPUT,
                    "line %zu: '%.*s' is among the numbers; allowed: numbers, and "
                    "nan for holes",
                    line.number, line.end - line.at < 40 ? (int)(line.end - line.at) : 40, line.at);
            }
        } else if (*line.at != '#' && text_is_row(line)) {
            block.first = line;
            block.next = next;
            separator = text_dialect_of(line).separator;
            status = add_block(&blocks, &block, line.number, err);
        } else {
            (void)take_header_line(&block, line);
        }
    }
    if (status == 0 && blocks.count == 0)
        status = error_set(err, ERROR_INPUT, "the file holds no line of numbers");
    if (status != 0)
        text_blocks_clear(&blocks);
    else
        *out = blocks;
    return status;
}

void text_blocks_clear(struct text_blocks *blocks) {
    free(blocks->blocks);
    *blocks = (struct text_blocks){0};
}

/* Whether a number of a line has a comma for its point. */
static bool has_decimal_comma(struct text_line line) {
    struct text_dialect dialect = text_dialect_of(line);
    struct text_field field;
    double number;
    while (text_field_next(&line, dialect.separator, &field))
        (void)text_value_of(&field, &dialect, &number);
    return dialect.decimal == ',';
}

bool text_blocks_own(const char *text, size_t size) {
    struct text_block block = {0};
    struct text_line line = {0};
    const char *next = text, *end = text + (size < BYTES_SEEN ? size : BYTES_SEEN);
    size_t rows = 0;
    if (memchr(text, 0, (size_t)(end - text)) != NULL)
        return false;
    while (line.number < LINES_SEEN && rows < 10 && text_line_next(&line, &next, end)) {
        bool row = line.at < line.end && *line.at != '#' && text_is_row(line);
        rows += row ? 1 : 0;
        if (row && has_decimal_comma(line))
            return true;
        if (line.at < line.end && !row && rows == 0)
            (void)take_header_line(&block, line);
    }
    return rows > 0 && (block.header.keyed || block.columns.named);
}
