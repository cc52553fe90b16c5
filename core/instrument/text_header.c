#include "core/instrument/text_header.h"
#include "core/map/length_unit.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Keys in lower case of ASCII, as the programs named in README.md write them; the unit is what a
 * program means where it writes none. */
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

/* A part of a line without what stands around words: blanks, quotation marks, brackets. */
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

/* Parts the key, up to the first of : = tab ; , and its unit in brackets ("pixel size [um]",
 * "factor (-> m)") from the value behind it. */
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

/* A number, with comma or point, and the unit behind it. */
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

/* A width without unit is a count of points, as "Width: 1024". */
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

/* The next "key=" of a line with several, "h=650 w=650"; NULL where there is none. */
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
