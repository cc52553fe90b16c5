#include "core/map/height_map_file.h"
#include "core/file/point_locale.h"
#include "core/file/text_mark.h"
#include "core/file/written_file.h"
#include "core/map/height_map.h"
#include "core/map/height_map_npy.h"
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Height maps as text: CSV, and x y z lines. */

/* Numbers of a text, line by line; reading them determines the shape. */
struct table {
    double *numbers; /* owned */
    size_t count, capacity;
    size_t rows, columns; /* columns: numbers of the first row */
    size_t ended;         /* rows whose last field is empty */
    size_t line;
};

static int table_append(struct table *table, double number, struct error *err) {
    if (table->count == table->capacity) {
        size_t capacity = table->capacity == 0 ? 4096 : 2 * table->capacity;
        double *numbers = capacity <= SIZE_MAX / sizeof *numbers
                              ? realloc(table->numbers, capacity * sizeof *numbers)
                              : NULL;
        if (numbers == NULL)
            return error_memory(err, capacity * sizeof *numbers, "a height map");
        table->numbers = numbers;
        table->capacity = capacity;
    }
    table->numbers[table->count++] = number;
    return 0;
}

static const char *skip_blank(const char *at, const char *end) {
    while (at < end && (*at == ' ' || *at == '\t' || *at == '\r'))
        at++;
    return at;
}

/* Returns whether a hole stands at `at`: "nan" and then a separator or the end. */
static bool is_hole(const char *at) {
    return strncasecmp(at, "nan", 3) == 0 && strchr(",; \t\r\n", at[3]) != NULL;
}

static const char ALLOWED[] = "allowed: numbers as -1.5e-6, and nan or nothing for holes";

/* Reports a fault of the number in this column of the present row. */
static int refuse_number(const struct table *table, size_t column, const char *at, const char *what,
                         struct error *err) {
    int shown = (int)strcspn(at, ",; \t\r\n");
    return error_set(err, ERROR_INPUT, "row %zu, column %zu (line %zu): '%.*s' %s; %s",
                     table->rows + 1, column, table->line, shown < 40 ? shown : 40, at, what,
                     ALLOWED);
}

static bool is_separator(const char *at, const char *end) {
    return at < end && (*at == ',' || *at == ';');
}

/* Reads one number in plain decimal, or a hole: nan, or nothing before a separator or the end; *at
 * moves behind it. */
static int read_number(const struct table *table, size_t column, const char **at, const char *end,
                       double *number, struct error *err) {
    size_t length = strspn(*at, "+-.0123456789eE");
    char *stop;
    const bool empty = *at == end || is_separator(*at, end);
    if (empty || is_hole(*at)) {
        *number = NAN;
        *at += empty ? 0 : 3;
        return 0;
    }
    *number = strtod(*at, &stop);
    if (length == 0 || stop != *at + length || stop > end)
        return refuse_number(table, column, *at, "is not a number", err);
    if (!isfinite(*number))
        return refuse_number(table, column, *at, "is too large", err);
    *at = stop;
    return 0;
}

/* Spreadsheets write points that are missing as nothing between separators. */
static int read_row(struct table *table, const char *at, const char *end, struct error *err) {
    size_t before = table->count;
    bool more = true;
    while (more) {
        double number;
        at = skip_blank(at, end);
        table->ended += at == end ? 1 : 0;
        int status = read_number(table, table->count - before + 1, &at, end, &number, err);
        if (status == 0)
            status = table_append(table, number, err);
        if (status != 0)
            return status;
        at = skip_blank(at, end);
        more = at < end;
        at += is_separator(at, end) ? 1 : 0;
    }
    if (table->rows++ == 0)
        table->columns = table->count;
    if (table->count - before != table->columns)
        return error_set(err, ERROR_INPUT,
                         "row %zu (line %zu) has %zu numbers, the first row %zu; allowed: as many "
                         "in each",
                         table->rows, table->line, table->count - before, table->columns);
    return 0;
}

static int read_table(struct table *table, const char *text, size_t size, struct error *err) {
    const char *end = text + size;
    if (text_mark_is_utf16(text, size, NULL))
        return error_set(err, ERROR_INPUT, "the text is in UTF-16; allowed: UTF-8");
    text += text_mark_length(text, size);
    if (memchr(text, 0, (size_t)(end - text)) != NULL)
        return error_set(err, ERROR_INPUT, "this is no text file: it holds a zero byte");
    for (const char *at = text; at < end;) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        stop = stop != NULL ? stop : end;
        table->line++;
        const char *first = skip_blank(at, stop);
        if (first < stop && *first != '#') {
            int status = read_row(table, first, stop, err);
            if (status != 0)
                return status;
        }
        at = stop + (stop < end);
    }
    if (table->rows == 0)
        return error_set(err, ERROR_INPUT, "the file holds no number");
    if (table->ended == table->rows)
        return error_set(err, ERROR_INPUT,
                         "every row ends with a separator; allowed: one between two numbers, and "
                         "nothing after the last of a row that is a hole");
    return 0;
}

static int csv_map(struct height_map *map, struct table *table, double dx, struct error *err) {
    bool column = table->columns == 1; /* a profile, one height a line */
    int status = height_map_shape(map, column ? 1 : table->rows,
                                  column ? table->rows : table->columns, dx, err);
    if (status != 0)
        return status;
    map->z = table->numbers;
    table->numbers = NULL;
    return 0;
}

/* Tolerance of coordinates, which are printed with few digits, in steps of the grid. */
static const double OFF_GRID = 0.01;

/* Checks that point number `point` is on the regular grid. */
static int check_point(const struct table *table, size_t nx, size_t point, double dx, double dy,
                       struct error *err) {
    const double *first = table->numbers, *at = table->numbers + 3 * point;
    size_t i = point % nx, j = point / nx;
    double x = first[0] + (double)i * dx, y = first[1] + (double)j * dy;
    if (fabs(at[0] - x) <= OFF_GRID * dx && fabs(at[1] - y) <= OFF_GRID * dy)
        return 0;
    return error_set(
        err, ERROR_INPUT,
        "point %zu is at (%g, %g), not at (%g, %g): points must lie on a regular grid, "
        "row by row, x fastest",
        point + 1, at[0], at[1], x, y);
}

static int xyz_map(struct height_map *map, const struct table *table, struct error *err) {
    if (table->columns != 3)
        return error_set(err, ERROR_INPUT, "an xyz file has 3 numbers a line, not %zu",
                         table->columns);
    const double *points = table->numbers;
    size_t n = table->rows, nx = 1;
    while (nx < n && points[3 * nx + 1] == points[1])
        nx++;
    if (nx < 2 || n % nx != 0)
        return error_set(err, ERROR_INPUT,
                         "%zu points do not make rows of %zu: points must lie on a regular grid, "
                         "row by row, x fastest",
                         n, nx);
    double dx = (points[3 * (nx - 1)] - points[0]) / (double)(nx - 1);
    size_t ny = n / nx;
    double dy = ny > 1 ? (points[3 * (n - 1) + 1] - points[1]) / (double)(ny - 1) : dx;
    if (!(dx > 0 && dy > 0))
        return error_set(err, ERROR_INPUT, "x must rise along a row, and y from row to row");
    int status = height_map_shape(map, ny, nx, 1, err);
    map->grid.lx = dx * (double)nx;
    map->grid.ly = dy * (double)ny;
    for (size_t point = 0; point < n && status == 0; point++)
        status = check_point(table, nx, point, dx, dy, err);
    if (status != 0)
        return status;
    map->z = array_create(n, sizeof *map->z);
    if (map->z == NULL)
        return error_memory(err, n * sizeof *map->z, "a height map");
    for (size_t point = 0; point < n; point++)
        map->z[point] = points[3 * point + 2];
    return 0;
}

/* text[size] must be 0. On failure *map may hold heights, which the caller clears. */
static int height_map_csv_parse(struct height_map *map, const char *text, size_t size, double dx,
                                struct error *err) {
    struct table table = {0};
    int status = read_table(&table, text, size, err);
    if (status == 0)
        status = csv_map(map, &table, dx, err);
    free(table.numbers);
    return status;
}

static int height_map_xyz_parse(struct height_map *map, const char *text, size_t size,
                                struct error *err) {
    struct table table = {0};
    int status = read_table(&table, text, size, err);
    if (status == 0)
        status = xyz_map(map, &table, err);
    free(table.numbers);
    return status;
}

static void height_write(FILE *file, double z, char stop) {
    if (isnan(z))
        fprintf(file, "nan%c", stop); /* without the sign that printf() may write */
    else
        fprintf(file, "%.17g%c", z, stop);
}

static void height_map_csv_write(FILE *file, const struct grid *grid, const double *z) {
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            height_write(file, z[j * grid->nx + i], i + 1 < grid->nx ? ',' : '\n');
}

static void height_map_xyz_write(FILE *file, const struct grid *grid, const double origin[2],
                                 const double *z) {
    double dy = grid_is_profile(grid) ? 0 : grid_dy(grid);
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++) {
            fprintf(file, "%.17g %.17g ", origin[0] + (double)i * grid_dx(grid),
                    origin[1] + (double)j * dy);
            height_write(file, z[j * grid->nx + i], '\n');
        }
}

const char *const HEIGHT_MAP_NAMES[HEIGHT_MAP_FORMATS] = {"npy", "csv", "xyz"};

enum height_map_format height_map_format_of(const char *name) {
    const char *dot = strrchr(name, '.');
    enum height_map_format format = HEIGHT_MAP_NPY;
    while (format < HEIGHT_MAP_FORMATS &&
           (dot == NULL || strcasecmp(dot + 1, HEIGHT_MAP_NAMES[format]) != 0))
        format++;
    return format;
}

/* Reports that texts of numbers could not be given a decimal point. */
static int refuse_locale(struct error *err) {
    return error_set(err, ERROR_MEMORY, "cannot allocate the locale that texts are read in");
}

int height_map_parse(struct height_map *out, enum height_map_format format, const char *text,
                     size_t size, double dx, struct error *err) {
    struct height_map map = {0};
    int status = 0;
    dx = dx == 0 ? 1 : dx;
    if (!(dx > 0 && isfinite(dx)))
        return error_set(err, ERROR_INPUT, "the spacing of points must be above 0, not %g", dx);
    locale_t before = point_locale_begin();
    if (before == (locale_t)0)
        return refuse_locale(err);
    if (format == HEIGHT_MAP_NPY)
        status = height_map_npy_parse(&map, text, size, dx, err);
    else if (format == HEIGHT_MAP_CSV)
        status = height_map_csv_parse(&map, text, size, dx, err);
    else
        status = height_map_xyz_parse(&map, text, size, err);
    point_locale_end(before);
    if (status != 0)
        height_map_clear(&map);
    else
        *out = map;
    return status;
}

static int write_from(FILE *file, enum height_map_format format, const struct grid *grid,
                      const double origin[2], const double *z, struct error *err) {
    locale_t before = point_locale_begin();
    if (before == (locale_t)0)
        return refuse_locale(err);
    errno = 0;
    if (format == HEIGHT_MAP_NPY)
        height_map_npy_write(file, grid, z);
    else if (format == HEIGHT_MAP_CSV)
        height_map_csv_write(file, grid, z);
    else
        height_map_xyz_write(file, grid, origin, z);
    bool failed = fflush(file) != 0 || ferror(file) != 0;
    int reason = errno;
    point_locale_end(before);
    if (failed)
        return error_set(err, ERROR_SYSTEM, "cannot write the surface: %s",
                         reason != 0 ? strerror(reason) : "the write failed");
    return 0;
}

static const double HERE[2] = {0, 0};

int height_map_write(FILE *file, enum height_map_format format, const struct grid *grid,
                     const double *z, struct error *err) {
    return write_from(file, format, grid, HERE, z, err);
}

int height_map_save(const char *path, enum height_map_format format, const struct grid *grid,
                    const double *z, struct error *err) {
    return height_map_save_from(path, format, grid, HERE, z, err);
}

int height_map_save_from(const char *path, enum height_map_format format, const struct grid *grid,
                         const double origin[2], const double *z, struct error *err) {
    struct written_file file;
    int status = written_file_open(&file, path, err);
    if (status != 0)
        return status;
    status = write_from(file.stream, format, grid, origin, z, err);
    if (status != 0)
        error_context(err, "%s", path);
    return written_file_close(&file, status, err);
}
