/* Text exports with headers: matrices of heights and lists of points, as Gwyddion, SPIP, Keyence's
 * programs and many others write them (README.md). */
#include "core/instrument/formats.h"
#include "core/instrument/layers.h"
#include "core/instrument/point_grid.h"
#include "core/instrument/text/columns.h"
#include "core/instrument/text/text_block.h"
#include "core/instrument/text/text_number.h"
#include "core/instrument/unit_of.h"
#include "core/map/height_map.h"
#include "core/map/height_map_file.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Height maps from the numbers of a text export. */

/* All numbers of a block, row by row; NaN for holes. */
struct text_table {
    double *numbers; /* owned */
    size_t rows, columns;
    size_t line; /* of the first row */
};

struct growing {
    double *numbers; /* owned */
    size_t count, capacity;
};

static int append(struct growing *numbers, double number, struct error *err) {
    if (numbers->count == numbers->capacity) {
        size_t capacity = numbers->capacity == 0 ? 1024 : 2 * numbers->capacity;
        double *more = capacity <= SIZE_MAX / sizeof *more
                           ? realloc(numbers->numbers, capacity * sizeof *more)
                           : NULL;
        if (more == NULL)
            return error_memory(err, capacity * sizeof *more, "a height map");
        numbers->numbers = more;
        numbers->capacity = capacity;
    }
    numbers->numbers[numbers->count++] = number;
    return 0;
}

static int refuse(const struct text_field *field, size_t line, size_t column, struct error *err) {
    int shown = field->end - field->at < 40 ? (int)(field->end - field->at) : 40;
    return error_set(err, ERROR_INPUT,
                     "line %zu, column %zu: '%.*s' is not a number as the others; allowed: numbers "
                     "as -1.5e-6, with point or comma throughout, and nan for holes",
                     line, column, shown, field->at);
}

/* Returns whether a field is empty because some programs write a separator after the last number of
 * a row. It is a hole only where a number is missing. */
static bool is_ending(const struct text_field *field, size_t column, size_t columns) {
    return field->last && field->at == field->end && column > 0 &&
           (columns == 0 || column == columns);
}

static int read_row(struct growing *numbers, struct text_line line, struct text_dialect *dialect,
                    size_t *columns, struct error *err) {
    struct text_field field;
    const size_t number_of_line = line.number;
    size_t column = 0;
    int status = 0;
    while (status == 0 && text_field_next(&line, dialect->separator, &field)) {
        double number;
        if (is_ending(&field, column, *columns))
            break;
        if (text_value_of(&field, dialect, &number) == TEXT_OTHER)
            return refuse(&field, number_of_line, column + 1, err);
        status = append(numbers, number, err);
        column++;
    }
    if (*columns == 0)
        *columns = column;
    if (status == 0 && column != *columns)
        return error_set(err, ERROR_INPUT,
                         "line %zu has %zu numbers, not %zu; allowed: as many in each row, and as "
                         "the header says",
                         number_of_line, column, *columns);
    return status;
}

/* columns: of each row, where the header states it; 0: as many as the first row has. */
static int text_table_read(struct text_table *out, const struct text_block *block, const char *end,
                           size_t columns, struct error *err) {
    struct text_line line = block->first;
    struct text_dialect dialect = text_dialect_of(line);
    struct growing numbers = {0};
    const char *next = block->next;
    struct text_table table = {.line = line.number};
    int status = 0;
    bool more = true;
    for (; status == 0 && more; more = text_line_next(&line, &next, end)) {
        if (line.at == line.end)
            continue;
        if (table.rows > 0 && !text_goes_on(line, dialect.separator))
            break; /* the header of the next block, or a comment */
        status = read_row(&numbers, line, &dialect, &columns, err);
        table.rows++;
    }
    table.numbers = numbers.numbers;
    table.columns = columns;
    if (status != 0)
        free(numbers.numbers);
    else
        *out = table;
    return status;
}

/* Returns the unit of a quantity: its own, or that of its axis in the header. */
static const char *unit_for(const struct text_quantity *quantity, const char *of_axis) {
    bool own = quantity->unit[0] != '\0' && !(quantity->usual && of_axis[0] != '\0');
    return own ? quantity->unit : of_axis;
}

/* Scales heights in place by the header's scale and unit, and sets map->z_unit and
 * map->z_of_one. */
static int text_scale_heights(struct height_map *map, const struct text_header *header,
                              struct error *err) {
    const struct text_quantity *scale = &header->numbers[TEXT_Z_SCALE];
    const struct text_quantity *empty = &header->numbers[TEXT_VOID];
    /* SPIP's Bit2nm makes nanometres of numbers without a unit; beside one it has no effect. */
    const bool scaled = scale->there && !(scale->usual && header->z_unit[0] != '\0');
    double metres, factor = scaled ? scale->value : 1;
    /* The unit of a scale is that of the product: "height conversion factor (-> m)". */
    unit_keep(map->z_unit, unit_for(scale, header->z_unit), &metres);
    if (!empty->there && (*map->z_unit != '\0' || scaled))
        map->z_of_one = factor * metres;
    for (size_t point = 0; point < grid_points(&map->grid); point++) {
        bool hole = empty->there && map->z[point] == empty->value;
        map->z[point] = hole ? NAN : map->z[point] * factor * metres;
        if (isinf(map->z[point]))
            return error_set(err, ERROR_INPUT, "a height is too large with the scale %g", factor);
    }
    return 0;
}

/* Returns metres in one unit of x and of y, 1 where they are no lengths, and sets map->xy_unit. */
static int text_lateral_units(struct height_map *map, const char *x_unit, const char *y_unit,
                              double metres[2], struct error *err) {
    char other[UNIT_ROOM];
    unit_keep(map->xy_unit, x_unit, &metres[0]);
    unit_keep(other, y_unit, &metres[1]);
    if (strcmp(map->xy_unit, other) == 0)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "x is in '%.20s' and y in '%.20s'; allowed: lengths for both, or one unit",
                     x_unit, y_unit);
}

/* Returns the distance between points along an axis, in the file's unit; 0 where the header has
 * none. */
static double spacing(const struct text_quantity *step, const struct text_quantity *length,
                      size_t points, const char **unit) {
    const struct text_quantity *known = step->there ? step : length;
    if (!known->there)
        return 0;
    *unit = unit_for(known, *unit);
    return step->there ? step->value : length->value / (double)points;
}

static int check_lengths(const struct text_header *header, struct error *err) {
    static const char *const NAMES[] = {"length along x", "length along y", "spacing along x",
                                        "spacing along y"};
    for (int key = TEXT_WIDTH; key <= TEXT_DY; key++) {
        const struct text_quantity *length = &header->numbers[key];
        if (length->there && !(length->value > 0))
            return error_set(err, ERROR_INPUT, "the header says a %s of %g %s; allowed: above 0",
                             NAMES[key - TEXT_WIDTH], length->value, length->unit);
    }
    return 0;
}

static int set_lengths(struct height_map *map, const struct text_header *header,
                       struct error *err) {
    const struct text_quantity *numbers = header->numbers;
    const char *x_unit = header->x_unit, *y_unit = header->y_unit;
    double metres[2];
    double dx = spacing(&numbers[TEXT_DX], &numbers[TEXT_WIDTH], map->grid.nx, &x_unit);
    double dy = spacing(&numbers[TEXT_DY], &numbers[TEXT_HEIGHT], map->grid.ny, &y_unit);
    if (!numbers[TEXT_DY].there && (dy == 0 || numbers[TEXT_DX].there)) {
        dy = dx;
        y_unit = x_unit;
    }
    if (dx == 0) {
        dx = dy != 0 ? dy : 1;
        x_unit = dy != 0 ? y_unit : "";
        y_unit = x_unit;
    }
    if (dy == 0)
        dy = dx;
    if (y_unit[0] == '\0')
        y_unit = x_unit;
    int status = check_lengths(header, err);
    if (status == 0)
        status = text_lateral_units(map, x_unit, y_unit, metres, err);
    if (status != 0)
        return status;
    map->grid.lx = dx * metres[0] * (double)map->grid.nx;
    map->grid.ly = dy * metres[1] * (double)map->grid.ny;
    status = grid_check(&map->grid, err);
    return status == 0 ? 0 : error_context(err, "the header's lengths");
}

/* Checks a count against the header's. */
static int check_count(const struct text_quantity *said, const char *what, size_t found,
                       struct error *err) {
    if (!said->there || said->value == (double)found)
        return 0;
    return error_set(err, ERROR_INPUT, "the header says %g %s, %zu are there", said->value, what,
                     found);
}

/* Moves the numbers of a matrix of heights into a map, and sets those of the table to NULL. On
 * failure *map may hold heights, which the caller clears. */
static int text_matrix_map(struct height_map *map, struct text_table *table,
                           const struct text_header *header, struct error *err) {
    const struct text_quantity *numbers = header->numbers;
    bool column =
        table->columns == 1 && !(numbers[TEXT_ROWS].there && numbers[TEXT_COLUMNS].there &&
                                 numbers[TEXT_COLUMNS].value == 1);
    size_t nx = column ? table->rows : table->columns, ny = column ? 1 : table->rows;
    int status = check_count(&numbers[TEXT_COLUMNS], "points a row", nx, err);
    if (status == 0)
        status = check_count(&numbers[TEXT_ROWS], "rows", ny, err);
    if (status == 0)
        status = height_map_shape(map, ny, nx, 1, err);
    if (status == 0)
        status = set_lengths(map, header, err);
    if (status != 0)
        return status;
    map->z = table->numbers;
    table->numbers = NULL;
    return text_scale_heights(map, header, err);
}

/* Makes a map of a list of points x y z, in any order, on a regular grid; nodes without a point are
 * holes. */
static int text_points_map(struct height_map *map, const struct text_table *table,
                           const struct text_block *block, struct error *err) {
    const size_t plain[3] = {0, 1, 2};
    const size_t *of = block->columns.named ? block->columns.of : plain;
    const struct text_header *header = &block->header;
    struct point_list points = {.n = table->rows, .stride = table->columns};
    double metres[2];
    for (size_t c = 0; c < 3; c++) {
        if (of[c] >= table->columns)
            return error_set(err, ERROR_INPUT, "a point has %zu numbers, %c is column %zu",
                             table->columns, "xyz"[c], of[c] + 1);
        points.of[c] = table->numbers + of[c];
    }
    int status = text_lateral_units(map, header->x_unit,
                                    header->y_unit[0] != '\0' ? header->y_unit : header->x_unit,
                                    metres, err);
    if (status == 0)
        status = point_grid_map(map, &points, metres, err);
    return status == 0 ? text_scale_heights(map, header, err) : status;
}

/* Makes a profile of lines x z. done: INSTRUMENT_DONE bytes. */
static int text_trace_map(struct height_map *map, const struct text_table *table,
                          const struct text_block *block, char *done, struct error *err) {
    const struct columns_table columns = {table->numbers, table->rows, table->columns};
    const bool named = block->columns.trace || block->columns.named;
    const size_t x = named ? block->columns.of[0] : 0, z = named ? block->columns.of[2] : 1;
    double metres;
    if (x >= table->columns || z >= table->columns)
        return error_set(err, ERROR_INPUT,
                         "a trace has %zu numbers a row, x is column %zu and z %zu", table->columns,
                         x + 1, z + 1);
    unit_keep(map->xy_unit, block->header.x_unit, &metres);
    int status = columns_trace(map, &columns, x, z, metres, done, err);
    if (status != 0)
        return status;
    unit_keep(map->xy_unit, block->header.x_unit, &metres);
    return text_scale_heights(map, &block->header, err);
}

static int choose_block(const struct text_blocks *blocks, const struct instrument_request *request,
                        size_t *out, struct error *err) {
    struct layer *layers = array_create(blocks->count, sizeof *layers);
    if (layers == NULL)
        return error_memory(err, blocks->count * sizeof *layers, "the blocks of a text");
    for (size_t b = 0; b < blocks->count; b++) {
        const struct text_header *header = &blocks->blocks[b].header;
        layers[b] = (struct layer){*header->title != '\0' ? header->title : NULL,
                                   unit_for(&header->numbers[TEXT_Z_SCALE], header->z_unit)};
    }
    int status =
        layer_choose(layers, blocks->count, request->layer, "", out, request->layer_read, err);
    free(layers);
    return status;
}

/* Finds what the columns of a block are. Names of columns show it, as do lengths of a matrix; three
 * columns with a unit along x are points. */
static int choose_columns(enum instrument_columns *out, const struct text_block *block,
                          const struct text_table *table, bool points, struct error *err) {
    const struct columns_table columns = {table->numbers, table->rows, table->columns};
    const struct text_quantity *numbers = block->header.numbers;
    bool matrix = false;
    for (int key = TEXT_COLUMNS; key <= TEXT_DY; key++)
        matrix = matrix || numbers[key].there;
    const bool trace = block->columns.trace && block->columns.count == table->columns;
    const bool list = table->columns == 3 && (points || block->header.x_unit[0] != '\0');
    if (block->columns.named || (list && !trace && !matrix))
        *out = COLUMNS_XYZ;
    else if (trace)
        *out = COLUMNS_XZ;
    else if (matrix)
        *out = COLUMNS_MAP;
    else
        return columns_choose(out, &columns, err);
    return 0;
}

static int read_columns(struct height_map *map, const struct text_block *block,
                        struct text_table *table, bool points,
                        const struct instrument_request *request, struct error *err) {
    enum instrument_columns kind = request->columns;
    char done[INSTRUMENT_DONE] = "";
    int status = 0;
    if (kind == COLUMNS_AUTO)
        status = choose_columns(&kind, block, table, points, err);
    if (status != 0)
        return status;
    if (kind == COLUMNS_XYZ)
        status = text_points_map(map, table, block, err);
    else if (kind == COLUMNS_XZ)
        status = text_trace_map(map, table, block, done, err);
    else
        status = text_matrix_map(map, table, &block->header, err);
    if (request->done != NULL)
        memcpy(request->done, done, sizeof done);
    return status;
}

static int read_block(struct height_map *map, const struct text_block *block, const char *end,
                      bool points, const struct instrument_request *request, struct error *err) {
    const struct text_quantity *columns = &block->header.numbers[TEXT_COLUMNS];
    bool stated = !block->columns.named && columns->there && columns->value > 1 &&
                  columns->value < 2147483648.0;
    struct text_table table = {0};
    int status = text_table_read(&table, block, end, stated ? (size_t)columns->value : 0, err);
    if (status == 0)
        status = read_columns(map, block, &table, points, request, err);
    free(table.numbers);
    return status;
}

static int read_text(struct height_map *out, const char *data, size_t size, bool points,
                     const struct instrument_request *request, struct error *err) {
    struct text_blocks blocks = {0};
    struct height_map map = {0};
    size_t chosen;
    int status = text_check(data, size, err);
    if (status == 0)
        status = text_blocks_find(&blocks, data, size, err);
    if (status == 0)
        status = choose_block(&blocks, request, &chosen, err);
    if (status == 0)
        status = read_block(&map, &blocks.blocks[chosen], data + size, points, request, err);
    text_blocks_clear(&blocks);
    if (status == 0)
        *out = map;
    else
        height_map_clear(&map);
    return status;
}

static int read_export(struct height_map *out, const char *data, size_t size,
                       const struct instrument_request *request, struct error *err) {
    return read_text(out, data, size, false, request, err);
}

/* A plain list in the program's own order is read as such, bit for bit. */
static int read_points(struct height_map *out, const char *data, size_t size,
                       const struct instrument_request *request, struct error *err) {
    struct error why;
    const bool list = request->columns == COLUMNS_AUTO || request->columns == COLUMNS_XYZ;
    if (request->layer == NULL && list && !text_blocks_own(data, size)) {
        int status = height_map_parse(out, HEIGHT_MAP_XYZ, data, size, 0, &why);
        if (status == ERROR_MEMORY)
            return error_set(err, ERROR_MEMORY, "%s", why.text);
        if (status == 0)
            return 0;
    }
    return read_text(out, data, size, true, request, err);
}

const struct instrument_format INSTRUMENT_TEXT = {"text", "", text_blocks_own, read_export};
const struct instrument_format INSTRUMENT_POINTS = {"xyz", "xyz", NULL, read_points};
