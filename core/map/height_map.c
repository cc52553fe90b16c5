#include "core/map/height_map.h"
#include "core/map/height_map_npy.h"
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char *const HEIGHT_MAP_NAMES[HEIGHT_MAP_FORMATS] = {"npy", "csv", "xyz"};

void height_map_clear(struct height_map *map) {
    free(map->z);
    *map = (struct height_map){0};
}

enum height_map_format height_map_format_of(const char *name) {
    const char *dot = strrchr(name, '.');
    enum height_map_format format = HEIGHT_MAP_NPY;
    while (format < HEIGHT_MAP_FORMATS &&
           (dot == NULL || strcasecmp(dot + 1, HEIGHT_MAP_NAMES[format]) != 0))
        format++;
    return format;
}

/* Numbers of a text, line by line; the shape is found on the way. */
struct table {
    double *numbers; /* owned */
    size_t count, capacity;
    size_t rows, columns; /* columns: numbers of the first row */
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

/* One number in plain decimal; *at moves behind it. */
static int read_number(const struct table *table, const char **at, const char *end, double *number,
                       struct error *err) {
    size_t length = strspn(*at, "+-.0123456789eE");
    char *stop;
    *number = strtod(*at, &stop);
    if (length == 0 || stop != *at + length || stop > end) {
        int shown = (int)strcspn(*at, ",; \t\r\n");
        return error_set(err, ERROR_INPUT, "line %zu: '%.*s' is not a number", table->line,
                         shown < 40 ? shown : 40, *at);
    }
    if (!isfinite(*number))
        return error_set(err, ERROR_INPUT, "line %zu: '%.*s' is too large", table->line,
                         length < 40 ? (int)length : 40, *at);
    *at = stop;
    return 0;
}

static int read_row(struct table *table, const char *at, const char *end, struct error *err) {
    size_t before = table->count;
    while ((at = skip_blank(at, end)) < end) {
        double number;
        int status = read_number(table, &at, end, &number, err);
        if (status == 0)
            status = table_append(table, number, err);
        if (status != 0)
            return status;
        at = skip_blank(at, end);
        if (at < end && (*at == ',' || *at == ';') && skip_blank(++at, end) == end)
            return error_set(err, ERROR_INPUT, "line %zu ends with a separator", table->line);
    }
    if (table->rows++ == 0)
        table->columns = table->count;
    if (table->count - before != table->columns)
        return error_set(err, ERROR_INPUT, "line %zu has %zu numbers, the first row %zu",
                         table->line, table->count - before, table->columns);
    return 0;
}

static int read_table(struct table *table, const char *text, size_t size, struct error *err) {
    const char *end = text + size;
    if (memchr(text, 0, size) != NULL)
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
    return 0;
}

int height_map_shape(struct height_map *map, size_t ny, size_t nx, double dx, struct error *err) {
    const size_t most = (size_t)1 << 31;
    if (nx < 2 || ny < 1 || nx > most || ny > most / nx)
        return error_set(err, ERROR_INPUT,
                         "a map of %zu rows of %zu points: at least 2 points a row and at most "
                         "2^31 in all are read",
                         ny, nx);
    map->grid = (struct grid){nx, ny, dx * (double)nx, dx * (double)ny};
    return grid_check(&map->grid, err);
}

static int parse_csv(struct height_map *map, struct table *table, double dx, struct error *err) {
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

/* Checks that point number `point` is where a regular grid has it. */
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

static int parse_xyz(struct height_map *map, const struct table *table, struct error *err) {
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

int height_map_parse(struct height_map *out, enum height_map_format format, const char *text,
                     size_t size, double dx, struct error *err) {
    struct height_map map = {0};
    struct table table = {0};
    int status = 0;
    dx = dx == 0 ? 1 : dx;
    if (!(dx > 0 && isfinite(dx)))
        return error_set(err, ERROR_INPUT, "the spacing of points must be above 0, not %g", dx);
    if (format == HEIGHT_MAP_NPY)
        status = height_map_npy_parse(&map, text, size, dx, err);
    else {
        status = read_table(&table, text, size, err);
        if (status == 0)
            status = format == HEIGHT_MAP_CSV ? parse_csv(&map, &table, dx, err)
                                              : parse_xyz(&map, &table, err);
    }
    free(table.numbers);
    if (status != 0)
        height_map_clear(&map);
    else
        *out = map;
    return status;
}

static void write_csv(FILE *file, const struct grid *grid, const double *z) {
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            fprintf(file, "%.17g%c", z[j * grid->nx + i], i + 1 < grid->nx ? ',' : '\n');
}

static void write_xyz(FILE *file, const struct grid *grid, const double *z) {
    double dy = grid_is_profile(grid) ? 0 : grid_dy(grid);
    for (size_t j = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++)
            fprintf(file, "%.17g %.17g %.17g\n", (double)i * grid_dx(grid), (double)j * dy,
                    z[j * grid->nx + i]);
}

int height_map_write(FILE *file, enum height_map_format format, const struct grid *grid,
                     const double *z, struct error *err) {
    errno = 0;
    if (format == HEIGHT_MAP_NPY)
        height_map_npy_write(file, grid, z);
    else if (format == HEIGHT_MAP_CSV)
        write_csv(file, grid, z);
    else
        write_xyz(file, grid, z);
    if (fflush(file) != 0 || ferror(file) != 0)
        return error_set(err, ERROR_SYSTEM, "cannot write the surface: %s",
                         errno != 0 ? strerror(errno) : "the write failed");
    return 0;
}
