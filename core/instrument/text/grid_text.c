/* Grids of programs for terrain, as text: Surfer's DSAA and ESRI's ASCII grid. Neither states
 * units. */
#include "core/instrument/formats.h"
#include "core/instrument/layers.h"
#include "core/instrument/text/text_number.h"
#include "core/map/height_map.h"
#include <math.h>
#include <string.h>
#include <strings.h>

/* The words of a text between blanks and ends of lines. */

struct word_reader {
    const char *at, *end; /* borrowed: what is not read yet */
    size_t line;          /* of the last word, from 1 */
    struct text_dialect dialect;
};

static bool is_between(char c) {
    return text_is_blank(c) || c == '\n';
}

static struct word_reader word_reader_of(const char *text, size_t size) {
    return (struct word_reader){.at = text, .end = text + size, .line = 1, .dialect = {' ', '\0'}};
}

/* Returns the next word, of length 0 after the last. */
static struct text_field word_next(struct word_reader *reader) {
    while (reader->at < reader->end && is_between(*reader->at)) {
        reader->line += *reader->at == '\n' ? 1 : 0;
        reader->at++;
    }
    struct text_field word = {reader->at, reader->at, false};
    while (word.end < reader->end && !is_between(*word.end))
        word.end++;
    reader->at = word.end;
    word.last = word.end == reader->end;
    return word;
}

static int refuse(const struct word_reader *reader, const struct text_field *word, const char *what,
                  const char *allowed, struct error *err) {
    if (word->at == word->end)
        return error_set(err, ERROR_INPUT, "the file ends before %s", what);
    return error_set(err, ERROR_INPUT, "line %zu: %s is '%.*s'; allowed: %s", reader->line, what,
                     word->end - word->at < 40 ? (int)(word->end - word->at) : 40, word->at,
                     allowed);
}

/* Reads the next word as a number; a word for a hole is NaN where holes are allowed, and refused
 * elsewhere. */
static int word_number(struct word_reader *reader, const char *what, bool holes, double *out,
                       struct error *err) {
    struct text_field word = word_next(reader);
    enum text_value value = text_value_of(&word, &reader->dialect, out);
    if (value == TEXT_NUMBER || (value == TEXT_HOLE && holes && word.at < word.end))
        return 0;
    return refuse(reader, &word, what, holes ? "a number, and nan for a hole" : "a number", err);
}

/* Reads the next word as a count from 1 to 2^31. */
static int word_count(struct word_reader *reader, const char *what, size_t *out,
                      struct error *err) {
    double count;
    struct text_field word = word_next(reader);
    if (text_value_of(&word, &reader->dialect, &count) != TEXT_NUMBER || !(count >= 1) ||
        !(count <= 2147483648.0) || count != floor(count))
        return refuse(reader, &word, what, "1 to 2147483648", err);
    *out = (size_t)count;
    return 0;
}

/* Reads the heights of a map whose shape is set into map->z; nothing may follow them. */
static int word_heights(struct word_reader *reader, struct height_map *map, struct error *err) {
    size_t points = grid_points(&map->grid), rest = (size_t)(reader->end - reader->at);
    int status = 0;
    if (points > rest / 2 + 1) /* a height and its separator */
        return error_set(err, ERROR_INPUT,
                         "%zu x %zu points do not fit into %zu bytes; the file is cut off or its "
                         "counts are wrong",
                         map->grid.nx, map->grid.ny, rest);
    map->z = array_create(points, sizeof *map->z);
    if (map->z == NULL)
        return error_memory(err, points * sizeof *map->z, "a height map");
    for (size_t point = 0; point < points && status == 0; point++)
        status = word_number(reader, "a height", true, &map->z[point], err);
    if (status != 0)
        return status;
    struct text_field more = word_next(reader);
    if (more.at < more.end)
        return error_set(err, ERROR_INPUT,
                         "line %zu: more heights than the %zu x %zu of the header", reader->line,
                         map->grid.nx, map->grid.ny);
    return 0;
}

typedef int grid_reader(struct height_map *map, struct word_reader *reader, struct error *err);

static int read_grid(struct height_map *out, const char *data, size_t size,
                     const struct instrument_request *request, grid_reader *read,
                     struct error *err) {
    struct height_map map = {0};
    if (layer_check_only(request->layer, err) != 0)
        return ERROR_INPUT;
    struct word_reader reader = word_reader_of(data, size);
    int status = text_check(data, size, err);
    if (status == 0)
        status = read(&map, &reader, err);
    if (status == 0)
        *out = map;
    else
        height_map_clear(&map);
    return status;
}

static bool owns_surfer(const char *data, size_t size) {
    return size >= 5 && memcmp(data, "DSAA", 4) == 0 && strchr(" \t\r\n", data[4]) != NULL;
}

/* Reads the range of an axis, from its first point to its last. */
static int read_range(struct word_reader *reader, const char *what, size_t count, double *step,
                      struct error *err) {
    double first, last;
    int status = word_number(reader, what, false, &first, err);
    if (status == 0)
        status = word_number(reader, what, false, &last, err);
    if (status != 0)
        return status;
    *step = count > 1 ? (last - first) / (double)(count - 1) : 1;
    if (*step > 0 && isfinite(*step))
        return 0;
    return error_set(err, ERROR_INPUT, "%s goes from %g to %g; allowed: up", what, first, last);
}

static int surfer(struct height_map *map, struct word_reader *reader, struct error *err) {
    const double empty = 1.70141e38; /* Surfer's "blanked" values are not below this */
    size_t nx, ny;
    double dx = 1, dy = 1, ignored;
    (void)word_next(reader);
    int status = word_count(reader, "the count of columns", &nx, err);
    if (status == 0)
        status = word_count(reader, "the count of rows", &ny, err);
    if (status == 0)
        status = read_range(reader, "x", nx, &dx, err);
    if (status == 0)
        status = read_range(reader, "y", ny, &dy, err);
    if (status == 0)
        status = word_number(reader, "the least z", false, &ignored, err);
    if (status == 0)
        status = word_number(reader, "the greatest z", false, &ignored, err);
    if (status == 0)
        status = height_map_shape(map, ny, nx, dx, err);
    if (status != 0)
        return status;
    map->grid.ly = (ny > 1 ? dy : dx) * (double)ny;
    status = grid_check(&map->grid, err);
    if (status == 0)
        status = word_heights(reader, map, err);
    for (size_t point = 0; status == 0 && point < grid_points(&map->grid); point++)
        if (map->z[point] >= empty)
            map->z[point] = NAN;
    return status;
}

static int read_surfer(struct height_map *out, const char *data, size_t size,
                       const struct instrument_request *request, struct error *err) {
    return read_grid(out, data, size, request, surfer, err);
}

static bool owns_esri(const char *data, size_t size) {
    return size >= 6 && strncasecmp(data, "ncols", 5) == 0 && strchr(" \t", data[5]) != NULL;
}

enum { COLUMNS, ROWS, CELL, CELL_X, CELL_Y, EMPTY, KEYS };

struct esri {
    double values[KEYS];
    bool there[KEYS];
};

static int key_of(const struct text_field *word) {
    static const char *const NAMES[KEYS] = {"ncols", "nrows", "cellsize",
                                            "dx",    "dy",    "nodata_value"};
    for (int key = 0; key < KEYS; key++)
        if (strlen(NAMES[key]) == (size_t)(word->end - word->at) &&
            strncasecmp(NAMES[key], word->at, (size_t)(word->end - word->at)) == 0)
            return key;
    return KEYS;
}

/* Returns whether a word is of the header: it begins with a letter and is no hole. */
static bool is_name(const struct text_field *word, struct text_dialect dialect) {
    double number;
    return word->at < word->end && (*word->at | 32) >= 'a' && (*word->at | 32) <= 'z' &&
           text_value_of(word, &dialect, &number) == TEXT_OTHER;
}

/* Reads pairs of a name and a number, up to the first height. */
static int read_pairs(struct esri *grid, struct word_reader *reader, struct error *err) {
    struct word_reader before = *reader;
    struct text_field word = word_next(reader);
    int status = 0;
    while (status == 0 && is_name(&word, reader->dialect)) {
        double value;
        int key = key_of(&word);
        status = word_number(reader, "a value of the header", false, &value, err);
        if (status == 0 && key < KEYS) {
            grid->values[key] = value;
            grid->there[key] = true;
        }
        before = *reader;
        word = word_next(reader);
    }
    *reader = before;
    return status;
}

static int check_pairs(struct esri *grid, struct error *err) {
    for (int key = COLUMNS; key <= ROWS; key++)
        if (!(grid->values[key] >= 1 && grid->values[key] <= 2147483648.0 &&
              grid->values[key] == floor(grid->values[key])))
            return error_set(err, ERROR_INPUT, "%s is %g; allowed: 1 to 2147483648",
                             key == COLUMNS ? "ncols" : "nrows", grid->values[key]);
    for (int key = CELL_X; key <= CELL_Y; key++) {
        if (!grid->there[key])
            grid->values[key] = grid->values[CELL];
        if (!(grid->values[key] > 0))
            return error_set(err, ERROR_INPUT, "cellsize is %g; allowed: above 0",
                             grid->values[key]);
    }
    return 0;
}

static int esri(struct height_map *map, struct word_reader *reader, struct error *err) {
    struct esri grid = {.values[EMPTY] = -9999, .there[EMPTY] = true};
    int status = read_pairs(&grid, reader, err);
    if (status == 0)
        status = check_pairs(&grid, err);
    if (status == 0)
        status = height_map_shape(map, (size_t)grid.values[ROWS], (size_t)grid.values[COLUMNS],
                                  grid.values[CELL_X], err);
    if (status != 0)
        return status;
    map->grid.ly = grid.values[CELL_Y] * (double)map->grid.ny;
    status = grid_check(&map->grid, err);
    if (status == 0)
        status = word_heights(reader, map, err);
    if (status != 0)
        return status;
    for (size_t point = 0; point < grid_points(&map->grid); point++)
        if (map->z[point] == grid.values[EMPTY])
            map->z[point] = NAN;
    height_map_reverse_rows(map); /* they stand from the highest y down */
    return 0;
}

static int read_esri(struct height_map *out, const char *data, size_t size,
                     const struct instrument_request *request, struct error *err) {
    return read_grid(out, data, size, request, esri, err);
}

const struct instrument_format INSTRUMENT_SURFER = {"surfer", "grd", owns_surfer, read_surfer};
const struct instrument_format INSTRUMENT_ESRI = {"esri", "", owns_esri, read_esri};
