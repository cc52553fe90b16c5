#include "core/instrument/text/text_block.h"
#include "core/instrument/text/text_number.h"
#include "core/map/length_unit.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Keys in lower case of ASCII, as the programs named in README.md write them, and the program's
 * unit where it writes none. */
static const struct row {
    const char *name;
    enum text_key key;
    const char *unit;
} KEYS[] = {
    {"columns", TEXT_COLUMNS, ""},
    {"cols", TEXT_COLUMNS, ""},
    {"nx", TEXT_COLUMNS, ""},
    {"xres", TEXT_COLUMNS, ""},
    {"x-pixels", TEXT_COLUMNS, ""},
    {"x pixels", TEXT_COLUMNS, ""},
    {"w", TEXT_COLUMNS, ""},
    {"horizontal", TEXT_COLUMNS, ""},
    {"horizont.", TEXT_COLUMNS, ""},
    {"points per line", TEXT_COLUMNS, ""},
    {"rows", TEXT_ROWS, ""},
    {"lines", TEXT_ROWS, ""},
    {"ny", TEXT_ROWS, ""},
    {"yres", TEXT_ROWS, ""},
    {"y-pixels", TEXT_ROWS, ""},
    {"y pixels", TEXT_ROWS, ""},
    {"h", TEXT_ROWS, ""},
    {"vertical", TEXT_ROWS, ""},
    {"vertikal", TEXT_ROWS, ""},
    {"number of lines", TEXT_ROWS, ""},
    {"width", TEXT_WIDTH, ""},
    {"breite", TEXT_WIDTH, ""},
    {"largeur", TEXT_WIDTH, ""},
    {"larghezza", TEXT_WIDTH, ""},
    {"anchura", TEXT_WIDTH, ""},
    {"x length", TEXT_WIDTH, ""},
    {"length x", TEXT_WIDTH, ""},
    {"x range", TEXT_WIDTH, ""},
    {"xreal", TEXT_WIDTH, ""},
    {"x-length", TEXT_WIDTH, "nm"},
    {"height", TEXT_HEIGHT, ""},
    {"h\xc3\xb6he", TEXT_HEIGHT, ""},
    {"h\xf6he", TEXT_HEIGHT, ""}, /* Latin-1 */
    {"hauteur", TEXT_HEIGHT, ""},
    {"altezza", TEXT_HEIGHT, ""},
    {"altura", TEXT_HEIGHT, ""},
    {"y length", TEXT_HEIGHT, ""},
    {"length y", TEXT_HEIGHT, ""},
    {"y range", TEXT_HEIGHT, ""},
    {"yreal", TEXT_HEIGHT, ""},
    {"y-length", TEXT_HEIGHT, "nm"},
    {"pixel size", TEXT_DX, ""},
    {"pixelsize", TEXT_DX, ""},
    {"pixel width", TEXT_DX, ""},
    {"xy calibration", TEXT_DX, ""},
    {"xy-justierung", TEXT_DX, ""},
    {"spacing", TEXT_DX, ""},
    {"spacing x", TEXT_DX, ""},
    {"x spacing", TEXT_DX, ""},
    {"x-spacing", TEXT_DX, ""},
    {"x step", TEXT_DX, ""},
    {"x increment", TEXT_DX, ""},
    {"step x", TEXT_DX, ""},
    {"dx", TEXT_DX, ""},
    {"scale x", TEXT_DX, ""},
    {"lateral resolution", TEXT_DX, ""},
    {"pixel height", TEXT_DY, ""},
    {"spacing y", TEXT_DY, ""},
    {"y spacing", TEXT_DY, ""},
    {"y-spacing", TEXT_DY, ""},
    {"y step", TEXT_DY, ""},
    {"y increment", TEXT_DY, ""},
    {"step y", TEXT_DY, ""},
    {"dy", TEXT_DY, ""},
    {"scale y", TEXT_DY, ""},
    {"bit2nm", TEXT_Z_SCALE, "nm"},
    {"scale data", TEXT_Z_SCALE, ""},
    {"z scale", TEXT_Z_SCALE, ""},
    {"z-scale", TEXT_Z_SCALE, ""},
    {"height conversion factor", TEXT_Z_SCALE, ""},
    {"void value", TEXT_VOID, ""},
    {"missing value", TEXT_VOID, ""},
    {"nodata_value", TEXT_VOID, ""},
    {"no data value", TEXT_VOID, ""},
    {"x-unit", TEXT_X_UNIT, ""},
    {"x unit", TEXT_X_UNIT, ""},
    {"unit x", TEXT_X_UNIT, ""},
    {"y-unit", TEXT_Y_UNIT, ""},
    {"y unit", TEXT_Y_UNIT, ""},
    {"unit y", TEXT_Y_UNIT, ""},
    {"xy-unit", TEXT_XY_UNIT, ""},
    {"xy unit", TEXT_XY_UNIT, ""},
    {"xy units", TEXT_XY_UNIT, ""},
    {"lateral unit", TEXT_XY_UNIT, ""},
    {"lateral units", TEXT_XY_UNIT, ""},
    {"z-unit", TEXT_Z_UNIT, ""},
    {"z unit", TEXT_Z_UNIT, ""},
    {"z units", TEXT_Z_UNIT, ""},
    {"unit z", TEXT_Z_UNIT, ""},
    {"value unit", TEXT_Z_UNIT, ""},
    {"value units", TEXT_Z_UNIT, ""},
    {"height unit", TEXT_Z_UNIT, ""},
    {"unit data", TEXT_Z_UNIT, ""},
    {"data unit", TEXT_Z_UNIT, ""},
    {"unit", TEXT_Z_UNIT, ""},
    {"einheit", TEXT_Z_UNIT, ""},
    {"einheiten", TEXT_Z_UNIT, ""},
    {"unit\xc3\xa9s", TEXT_Z_UNIT, ""},
    {"unit\xc3\xa0 valore", TEXT_Z_UNIT, ""},
    {"unidades de valor", TEXT_Z_UNIT, ""},
    {"channel", TEXT_TITLE, ""},
    {"kanal", TEXT_TITLE, ""},
    {"canal", TEXT_TITLE, ""},
    {"canale", TEXT_TITLE, ""},
    {"title", TEXT_TITLE, ""},
};
enum { KEY_COUNT = sizeof KEYS / sizeof KEYS[0], KEY_ROOM = 40 };

static bool is_around(char c) {
    return text_is_blank(c) || strchr("\"#%:=,;[]()", c) != NULL;
}

/* Removes blanks, quotation marks and brackets from both ends of a part of a line. */
static void trim(const char **at, const char **end) {
    while (*at < *end && is_around(**at))
        ++*at;
    while (*end > *at && is_around((*end)[-1]))
        --*end;
}

void text_unit_copy(char unit[TEXT_UNIT_ROOM], const char *at, const char *end) {
    trim(&at, &end);
    size_t length = 0;
    while (at + length < end && !is_around(at[length]))
        length++;
    length = length < TEXT_UNIT_ROOM ? length : TEXT_UNIT_ROOM - 1;
    memcpy(unit, at, length);
    unit[length] = '\0';
}

/* Splits a line into its key, up to the first of : = tab ; , with its unit in brackets ("pixel size
 * [um]", "factor (-> m)"), and the value that follows. */
static bool part_key(struct text_line line, char key[KEY_ROOM], char unit[TEXT_UNIT_ROOM],
                     const char **value) {
    const char *stop = line.at;
    while (stop < line.end && strchr(":=\t;,", *stop) == NULL)
        stop++;
    if (stop == line.end)
        return false;
    *value = stop + 1;
    const char *at = line.at, *end = stop, *bracket = at;
    while (bracket < stop && *bracket != '[' && *bracket != '(')
        bracket++;
    unit[0] = '\0';
    if (bracket < stop) {
        const char *inside = bracket + 1;
        inside += stop - inside >= 2 && memcmp(inside, "->", 2) == 0 ? 2 : 0;
        text_unit_copy(unit, inside, stop);
        end = bracket;
    }
    trim(&at, &end);
    if (end - at < 1 || end - at >= KEY_ROOM)
        return false;
    for (size_t c = 0; c <= (size_t)(end - at); c++)
        key[c] = (char)(at + c == end ? '\0' : at[c] >= 'A' && at[c] <= 'Z' ? at[c] + 32 : at[c]);
    return true;
}

/* Reads a number, with comma or point, and its unit. */
static bool take_number(const char *at, const char *end, struct text_quantity *out,
                        const char *unit, bool usual) {
    char copy[64], *stop;
    trim(&at, &end);
    size_t length = strspn(at, "+-.,0123456789eE");
    length = length <= (size_t)(end - at) ? length : (size_t)(end - at);
    while (length > 0 && at[length - 1] == ',')
        length--;
    if (length == 0 || length >= sizeof copy)
        return false;
    memcpy(copy, at, length);
    copy[length] = '\0';
    char *comma = strchr(copy, ',');
    if (comma != NULL)
        *comma = '.';
    *out = (struct text_quantity){.value = strtod(copy, &stop)};
    if (*stop != '\0' || !isfinite(out->value))
        return false;
    out->there = true;
    text_unit_copy(out->unit, at + length, end);
    if (*unit != '\0' && out->unit[0] == '\0') {
        text_unit_copy(out->unit, unit, unit + strlen(unit));
        out->usual = usual;
    }
    return true;
}

static void copy_title(char title[TEXT_TITLE_ROOM], const char *at, const char *end) {
    trim(&at, &end);
    size_t length = (size_t)(end - at) < TEXT_TITLE_ROOM ? (size_t)(end - at) : TEXT_TITLE_ROOM - 1;
    memcpy(title, at, length);
    title[length] = '\0';
}

static const struct row *row_of(const char *key) {
    for (size_t k = 0; k < KEY_COUNT; k++)
        if (strcmp(KEYS[k].name, key) == 0)
            return &KEYS[k];
    return NULL;
}

/* Returns what a key means: a width without unit is a count of points, as in "Width: 1024". */
static enum text_key meant(enum text_key key, const struct text_quantity *number) {
    bool length = number->unit[0] != '\0' || number->value != floor(number->value);
    if (key == TEXT_WIDTH && !length)
        return TEXT_COLUMNS;
    return key == TEXT_HEIGHT && !length ? TEXT_ROWS : key;
}

static bool take_value(struct text_header *header, const struct row *row, const char *unit,
                       const char *value, const char *end) {
    struct text_quantity number;
    switch (row->key) {
    case TEXT_TITLE:
        copy_title(header->title, value, end);
        return true;
    case TEXT_Z_UNIT:
        text_unit_copy(header->z_unit, value, end);
        break;
    case TEXT_XY_UNIT:
        text_unit_copy(header->y_unit, value, end);
        text_unit_copy(header->x_unit, value, end);
        break;
    case TEXT_X_UNIT:
        text_unit_copy(header->x_unit, value, end);
        break;
    case TEXT_Y_UNIT:
        text_unit_copy(header->y_unit, value, end);
        break;
    default:
        if (!take_number(value, end, &number, *unit != '\0' ? unit : row->unit, *unit == '\0'))
            return false;
        header->numbers[meant(row->key, &number)] = number;
    }
    header->keyed = true;
    return true;
}

/* Finds the next "key=" of a line with several, "h=650 w=650"; NULL where there is none. */
static const char *next_pair(const char *value, const char *end) {
    while (value < end && text_is_blank(*value))
        value++;
    while (value < end && !text_is_blank(*value))
        value++;
    return memchr(value, '=', (size_t)(end - value)) != NULL ? value : NULL;
}

bool text_header_take(struct text_header *header, struct text_line line) {
    char key[KEY_ROOM], unit[TEXT_UNIT_ROOM];
    const char *value;
    bool known = false;
    for (struct text_line rest = line; rest.at != NULL && part_key(rest, key, unit, &value);
         rest.at = next_pair(value, line.end)) {
        const struct row *row = row_of(key);
        if (row == NULL)
            break;
        known = take_value(header, row, unit, value, line.end) || known;
    }
    return known;
}

enum { BLOCKS_MOST = 1000, LINES_SEEN = 100, BYTES_SEEN = 16384 };

static bool is_one_of(const char *at, size_t length, const char *const *words) {
    for (; *words != NULL; words++)
        if (strlen(*words) == length && strncasecmp(at, *words, length) == 0)
            return true;
    return false;
}

/* Returns which of x, y and z a column is named for: "X", "y [um]", "Z(nm)", "x in mm", "y1",
 * "Lateral um"; 3 where for none. */
static size_t axis_of(const struct text_field *field) {
    static const char *const ALONG[] = {"lateral", "distance", "position", NULL};
    static const char *const HEIGHTS[] = {"height", "raw", "elevation", "topography", NULL};
    const char *at = field->at, *end;
    while (at < field->end && (*at == '#' || text_is_blank(*at)))
        at++;
    for (end = at; end < field->end && strchr(" [(/_\"", *end) == NULL;)
        end++;
    const size_t length = (size_t)(end - at);
    if (is_one_of(at, length, ALONG))
        return 0;
    if (is_one_of(at, length, HEIGHTS))
        return 2;
    const size_t axis = length > 0 ? (size_t)(*at | 32) - 'x' : 3;
    bool word = length > 2 || (length == 2 && (at[1] < '0' || at[1] > '9'));
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

/* Completes columns by which of x, y and z were found: all of a list, or x and one of heights,
 * which some programs call y, of a trace. Returns false where it is neither. */
static bool complete(struct text_columns *columns, struct text_header *header,
                     const bool found[3]) {
    columns->named = found[0] && found[1] && found[2];
    columns->trace = !columns->named && found[0] && (found[1] || found[2]);
    if (columns->trace && !found[2]) {
        columns->of[2] = columns->of[1];
        memcpy(header->z_unit, header->y_unit, sizeof header->z_unit);
        header->y_unit[0] = '\0';
    }
    return columns->named || columns->trace;
}

/* Reads a line that names columns x, y and z, or those of a trace. Between blanks, a unit in
 * brackets belongs to the name before it. */
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
    columns.count = column;
    if (!complete(&columns, &header, found))
        return false;
    block->columns = columns;
    block->header = header;
    return true;
}

/* Reads a line of two or three units of length alone, which are those of x and z, or of x, y and
 * z. */
static bool take_unit_line(struct text_block *block, struct text_line line) {
    char units[3][TEXT_UNIT_ROOM];
    struct text_field field;
    const char separator = separator_of_names(line);
    size_t count = 0;
    double metres;
    while (text_field_next(&line, separator, &field)) {
        if (count == 3)
            return false;
        text_unit_copy(units[count], field.at, field.end);
        if (!length_unit_metres(units[count], strlen(units[count]), &metres))
            return false;
        count++;
    }
    if (count < 2)
        return false;
    block->columns = (struct text_columns){count == 3, count == 2, {0, 1, count - 1}, count};
    memcpy(block->header.x_unit, units[0], sizeof units[0]);
    memcpy(block->header.z_unit, units[count - 1], sizeof units[0]);
    if (count == 3)
        memcpy(block->header.y_unit, units[1], sizeof units[1]);
    return true;
}

/* Reads units of the columns, which the line after the names may hold. */
static bool take_units(struct text_block *block, struct text_line line) {
    char *const units[3] = {block->header.x_unit, block->header.y_unit, block->header.z_unit};
    struct text_field field;
    const char separator = separator_of_names(line);
    const bool trace = block->columns.trace;
    bool taken = false;
    if (!block->columns.named && !trace)
        return take_unit_line(block, line);
    for (size_t column = 0; text_field_next(&line, separator, &field); column++)
        for (size_t axis = 0; axis < 3; axis++) {
            char unit[TEXT_UNIT_ROOM];
            double metres;
            text_unit_copy(unit, field.at, field.end);
            if (block->columns.of[axis] != column || (trace && axis == 1) ||
                !length_unit_metres(unit, strlen(unit), &metres))
                continue;
            memcpy(units[axis], unit, sizeof unit);
            taken = true;
        }
    return taken;
}

/* Reads one line before the numbers of a block; returns false where nothing in it is known. */
static bool take_header_line(struct text_block *block, struct text_line line) {
    return text_header_take(&block->header, line) || take_names(block, line) ||
           take_units(block, line);
}

/* Returns whether a line is the number of the rows that follow names or units of columns. */
static bool is_count(const struct text_block *block, struct text_line line, const char *next,
                     const char *end) {
    const size_t digits = strspn(line.at, "0123456789");
    struct text_line row = line;
    struct text_field field;
    if ((!block->columns.named && !block->columns.trace) || digits == 0 ||
        digits != (size_t)(line.end - line.at) || !text_line_next(&row, &next, end) ||
        !text_is_row(row))
        return false;
    const char separator = text_dialect_of(row).separator;
    return text_field_next(&row, separator, &field) && !field.last;
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

int text_blocks_find(struct text_blocks *out, const char *text, size_t size, struct error *err) {
    struct text_blocks blocks = {0};
    struct text_block block = {0};
    struct text_line line = {0};
    const char *next = text, *end = text + size;
    char separator = '\0'; /* of the block whose numbers are being passed; 0: none */
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
        } else if (*line.at != '#' && text_is_row(line) && !is_count(&block, line, next, end)) {
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

/* Returns whether a number of a line has a decimal comma. */
static bool has_decimal_comma(struct text_line line) {
    struct text_dialect dialect = text_dialect_of(line);
    struct text_field field;
    double number;
    while (text_field_next(&line, dialect.separator, &field))
        (void)text_value_of(&field, &dialect, &number);
    return dialect.decimal == ',';
}

/* Returns the end of the lines by which a text is recognised. It is that of a line, since a number
 * that is cut, as 1.5e-, is none. */
static const char *end_of_seen(const char *text, size_t size) {
    if (size <= BYTES_SEEN)
        return text + size;
    const char *stop = memchr(text + BYTES_SEEN, '\n', size - BYTES_SEEN);
    return stop != NULL ? stop : text + size;
}

bool text_blocks_own(const char *text, size_t size) {
    struct text_block block = {0};
    struct text_line line = {0};
    const char *next = text, *end = end_of_seen(text, size);
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
    return rows > 0 && (block.header.keyed || block.columns.named || block.columns.trace);
}
