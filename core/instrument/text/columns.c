#include "core/instrument/text/columns.h"
#include "core/instrument/point_grid.h"
#include <gsl/gsl_errno.h>
#include <gsl/gsl_interp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* EVEN: largest distance from an even position, in steps. ROUNDING: the same in units of the last
 * printed digit, which is half of one and a little for the fit. */
static const double EVEN = 0.05, ROUNDING = 0.55;
enum {
    ROWS_LEAST = 4,    /* of what can be a trace or a list */
    ROWS_TRACE = 8,    /* heights that are not positions rise throughout in 1 of 8! cases */
    ROWS_ROUNDED = 16, /* of positions whose last digit is no small part of a step */
    ROWS_NUMBERED = 3, /* with a row or column that numbers the others */
    COLUMNS_NUMBERED = 4,
    DIGITS_MOST = 12,   /* behind the decimal mark */
    POSITIONS_LEAST = 3 /* of a trace */
};

/* A position and its height. */
struct point {
    double x, z;
};

static int by_position(const void *left, const void *right) {
    const struct point *a = left, *b = right;
    return (a->x > b->x) - (a->x < b->x);
}

static struct point *points_of(const struct columns_table *table, size_t x, size_t z) {
    struct point *points = array_create(table->rows, sizeof *points);
    for (size_t row = 0; row < table->rows && points != NULL; row++)
        points[row] = (struct point){table->numbers[row * table->columns + x],
                                     table->numbers[row * table->columns + z]};
    return points;
}

/* Returns the unit of the last printed digit, 10^-d, of which all positions are multiples; 0 where
 * there is none. */
static double last_digit(const struct point *points, size_t n) {
    double scale = 1;
    for (int digits = 0; digits <= DIGITS_MOST; digits++, scale *= 10) {
        size_t at = 0;
        while (at < n && fabs(points[at].x * scale - round(points[at].x * scale)) <= 1e-6)
            at++;
        if (at == n)
            return 1 / scale;
    }
    return 0;
}

/* Returns whether positions in order are even but for their rounding: none is farther from the line
 * of least squares through them. *step is that line's. */
static bool are_even(const struct point *points, size_t n, double *step) {
    const double middle = 0.5 * (double)(n - 1), first = points[0].x;
    double mean = 0, product = 0, square = 0, worst = 0;
    for (size_t p = 0; p < n; p++) {
        const double i = (double)p - middle;
        mean += (points[p].x - first) / (double)n;
        product += i * (points[p].x - first);
        square += i * i;
    }
    *step = product / square;
    for (size_t p = 0; p < n; p++)
        worst = fmax(worst, fabs(points[p].x - first - mean - ((double)p - middle) * *step));
    if (worst <= EVEN * fabs(*step))
        return *step != 0;
    return n >= ROWS_ROUNDED && worst <= ROUNDING * last_digit(points, n) &&
           fabs(*step) > ROUNDING * last_digit(points, n);
}

/* Steps of a column that go up, and that go down. */
struct steps {
    size_t up, down;
};

static struct steps count_steps(const struct columns_table *table, size_t column) {
    struct steps steps = {0, 0};
    for (size_t row = 1; row < table->rows; row++) {
        const double *at = table->numbers + row * table->columns + column;
        steps.up += *at > *(at - table->columns) ? 1 : 0;
        steps.down += *at < *(at - table->columns) ? 1 : 0;
    }
    return steps;
}

static size_t most_of(struct steps steps) {
    return steps.up > steps.down ? steps.up : steps.down;
}

static bool has_holes(const struct columns_table *table, size_t columns) {
    for (size_t row = 0; row < table->rows; row++)
        for (size_t column = 0; column < columns; column++)
            if (isnan(table->numbers[row * table->columns + column]))
                return true;
    return false;
}

static int ask_back(const struct columns_table *table, struct error *err) {
    const bool two = table->columns == 2;
    return error_set(err, ERROR_INPUT,
                     "%zu rows of %zu numbers are either %s or a map of %zu x %zu heights; "
                     "--columns %s or --columns map says which (\"columns\" in studies and "
                     "requests)",
                     table->rows, table->columns,
                     two ? "positions and heights of a trace" : "points x y z", table->columns,
                     table->rows, two ? "xz" : "xyz");
}

static int choose_of_two(enum instrument_columns *out, const struct columns_table *table,
                         struct error *err) {
    const size_t all = table->rows - 1, most = most_of(count_steps(table, 0));
    double step;
    *out = COLUMNS_MAP;
    if (4 * most < 3 * all)
        return 0;
    struct point *points = points_of(table, 0, 1);
    if (points == NULL)
        return error_memory(err, table->rows * sizeof *points, "columns of numbers");
    bool sure = are_even(points, table->rows, &step);
    free(points);
    if (!sure)
        sure = most == all && table->rows >= ROWS_TRACE && most_of(count_steps(table, 1)) < all;
    *out = COLUMNS_XZ;
    return sure ? 0 : ask_back(table, err);
}

static struct point_list list_of(const struct columns_table *table) {
    const double *numbers = table->numbers;
    return (struct point_list){
        .n = table->rows, .stride = table->columns, .of = {numbers, numbers + 1, numbers + 2}};
}

static int choose_of_three(enum instrument_columns *out, const struct columns_table *table,
                           struct error *err) {
    const struct point_list points = list_of(table);
    const double metres[2] = {1, 1};
    struct height_map map = {0};
    struct error why;
    int status = point_grid_map(&map, &points, metres, &why);
    bool grid = status == 0 && grid_points(&map.grid) <= 2 * table->rows;
    height_map_clear(&map);
    if (status == ERROR_MEMORY)
        return error_set(err, ERROR_MEMORY, "%s", why.text);
    *out = COLUMNS_XYZ;
    return grid ? 0 : ask_back(table, err);
}

/* --- rows and columns that are numbered --- */

/* A row or column of a table. */
struct series {
    const double *at;
    size_t count, stride;
};

/* Returns whether it is 0, 1, 2 ... or 1, 2, 3 ... throughout. */
static bool is_numbering(const struct series *series) {
    const double first = series->at[0];
    if (first != 0 && first != 1)
        return false;
    for (size_t k = 1; k < series->count; k++)
        if (series->at[k * series->stride] != first + (double)k)
            return false;
    return true;
}

/* Returns whether the one after a numbering rises throughout as well, by a tenth of it or more:
 * both are then heights of a slope. */
static bool goes_on(const struct series *series) {
    const double *at = series->at;
    for (size_t k = 1; k < series->count; k++)
        if (!(at[k * series->stride] > at[(k - 1) * series->stride]))
            return false;
    return at[(series->count - 1) * series->stride] - at[0] >= 0.1 * (double)(series->count - 1);
}

/* Spreadsheets and pandas number columns in a first row, and rows in a first column below an empty
 * corner. Fewer than four numbers without a corner may be heights. */
static int check_numberings(const struct columns_table *table, struct error *err) {
    if (table->rows < ROWS_NUMBERED || table->columns < 2)
        return 0;
    const bool corner = isnan(table->numbers[0]);
    const size_t from = corner ? 1 : 0, stride = table->columns;
    const struct series row = {table->numbers + from, stride - from, 1};
    const struct series after = {row.at + stride, row.count, 1};
    const struct series column = {table->numbers + stride, table->rows - 1, stride};
    const struct series beside = {column.at + 1, column.count, stride};
    const bool columns =
        row.count >= (corner ? 2 : COLUMNS_NUMBERED) && is_numbering(&row) && !goes_on(&after);
    const bool rows =
        corner && column.count >= ROWS_NUMBERED && is_numbering(&column) && !goes_on(&beside);
    if (!columns && !rows)
        return 0;
    return error_set(err, ERROR_INPUT,
                     "the first %s of the numbers, %g to %g, numbers the %s%s; allowed: heights "
                     "alone, without it, or --columns map, which takes it for heights (\"columns\" "
                     "in studies and requests)",
                     columns ? "row" : "column", columns ? row.at[0] : column.at[0],
                     columns ? row.at[row.count - 1] : column.at[(column.count - 1) * stride],
                     columns ? "columns" : "rows",
                     columns && rows ? ", and the first column the rows" : "");
}

int columns_choose(enum instrument_columns *out, const struct columns_table *table,
                   struct error *err) {
    int status = check_numberings(table, err);
    *out = COLUMNS_MAP;
    if (status != 0)
        return status;
    if (table->columns < 2 || table->columns > 3 || table->rows < ROWS_LEAST ||
        has_holes(table, table->columns - 1))
        return 0;
    return table->columns == 2 ? choose_of_two(out, table, err) : choose_of_three(out, table, err);
}

/* --- traces --- */

/* Even positions from `first` on. */
struct line {
    double first, step;
    size_t n;
};

static int set_line(struct height_map *map, const struct line *line, double metres,
                    struct error *err) {
    int status = height_map_shape(map, 1, line->n, line->step * metres, err);
    if (status != 0)
        return status;
    map->z = array_create(line->n, sizeof *map->z);
    return map->z != NULL ? 0 : error_memory(err, line->n * sizeof *map->z, "a profile");
}

/* Finds even positions of which at most a tenth is missing: all distances are whole steps. */
static bool find_gaps(struct line *out, const struct point *points, size_t n) {
    const double range = points[n - 1].x - points[0].x;
    double least = INFINITY;
    for (size_t p = 1; p < n; p++)
        least = fmin(least, points[p].x - points[p - 1].x);
    const double steps = round(range / least);
    if (!(steps <= 1.1 * (double)(n - 1)))
        return false;
    *out = (struct line){points[0].x, range / steps, (size_t)steps + 1};
    for (size_t p = 0; p < n; p++) {
        const double at = (points[p].x - out->first) / out->step;
        if (!(fabs(at - round(at)) <= EVEN))
            return false;
    }
    return true;
}

static void place_points(double *heights, const struct line *line, const struct point *points,
                         size_t n) {
    for (size_t i = 0; i < line->n; i++)
        heights[i] = NAN;
    for (size_t p = 0; p < n; p++)
        heights[(size_t)round((points[p].x - line->first) / line->step)] = points[p].z;
}

/* Interpolates at the nodes of the line from the m points of `whole` that have heights. A node
 * beside a position without one, among all n of `points`, is a hole. */
static void interpolate(double *heights, const struct line *line, const struct point *points,
                        size_t n, const gsl_interp *cubics, const double *x, const double *z,
                        size_t m) {
    size_t after = 0;
    gsl_interp_accel near = {0, 0, 0};
    for (size_t i = 0; i < line->n; i++) {
        const double at = fmin(line->first + (double)i * line->step, points[n - 1].x);
        while (after < n && points[after].x < at)
            after++;
        const bool beside = isnan(points[after].z) ||
                            (after > 0 && points[after].x > at && isnan(points[after - 1].z));
        heights[i] =
            beside || at < x[0] || at > x[m - 1] ? NAN : gsl_interp_eval(cubics, x, z, at, &near);
    }
}

static int resample(double *heights, const struct line *line, const struct point *points, size_t n,
                    struct error *err) {
    double *x = array_create(2 * n, sizeof *x), *z = x != NULL ? x + n : NULL;
    gsl_interp *cubics = NULL;
    size_t m = 0;
    for (size_t p = 0; p < n && x != NULL; p++)
        if (!isnan(points[p].z)) {
            x[m] = points[p].x;
            z[m++] = points[p].z;
        }
    int status = x == NULL ? error_memory(err, 2 * n * sizeof *x, "a trace") : 0;
    if (status == 0 && m < POSITIONS_LEAST)
        status = error_set(err, ERROR_INPUT, "%zu of %zu positions have heights; at least %d do", m,
                           n, POSITIONS_LEAST);
    if (status == 0 && (cubics = gsl_interp_alloc(gsl_interp_steffen, m)) == NULL)
        status = error_memory(err, m * 4 * sizeof *x, "a trace");
    if (status == 0 && gsl_interp_init(cubics, x, z, m) != GSL_SUCCESS)
        status = error_set(err, ERROR_INPUT, "the positions cannot be interpolated");
    if (status == 0)
        interpolate(heights, line, points, n, cubics, x, z, m);
    gsl_interp_free(cubics);
    free(x);
    return status;
}

/* Checks positions in order: finite, and each of them once. */
static int check_positions(const struct point *points, size_t n, struct error *err) {
    for (size_t p = 1; p < n; p++)
        if (points[p].x == points[p - 1].x)
            return error_set(err, ERROR_INPUT,
                             "x = %.12g has two heights, %g and %g; allowed: each position once",
                             points[p].x, points[p - 1].z, points[p].z);
    return isfinite(points[n - 1].x - points[0].x)
               ? 0
               : error_set(err, ERROR_INPUT, "x from %g to %g: too far apart", points[0].x,
                           points[n - 1].x);
}

/* For positions that are not even. */
static int uneven(struct height_map *map, const struct point *points, size_t n, double metres,
                  char *done, struct error *err) {
    struct line line;
    double least = INFINITY, largest = 0;
    int status = check_positions(points, n, err);
    if (status != 0)
        return status;
    if (find_gaps(&line, points, n)) {
        snprintf(done, INSTRUMENT_DONE, "x z, %zu rows at even positions, %zu of which are missing",
                 n, line.n - n);
        status = set_line(map, &line, metres, err);
        if (status == 0)
            place_points(map->z, &line, points, n);
        return status;
    }
    line = (struct line){points[0].x, (points[n - 1].x - points[0].x) / (double)(n - 1), n};
    for (size_t p = 1; p < n; p++) {
        least = fmin(least, points[p].x - points[p - 1].x);
        largest = fmax(largest, points[p].x - points[p - 1].x);
    }
    snprintf(done, INSTRUMENT_DONE,
             "x z, %zu rows at uneven positions, %.3g to %.3g of their mean distance apart; "
             "resampled at it by monotone cubics",
             n, least / line.step, largest / line.step);
    status = set_line(map, &line, metres, err);
    return status == 0 ? resample(map->z, &line, points, n, err) : status;
}

static int trace_of(struct height_map *map, struct point *points, size_t n, double metres,
                    char *done, struct error *err) {
    struct line line = {0, 0, n};
    for (size_t p = 0; p < n; p++)
        if (!isfinite(points[p].x))
            return error_set(err, ERROR_INPUT, "row %zu has no finite position", p + 1);
    bool even = are_even(points, n, &line.step);
    if (!even || line.step < 0) {
        qsort(points, n, sizeof *points, by_position);
        even = are_even(points, n, &line.step);
    }
    if (!even)
        return uneven(map, points, n, metres, done, err);
    snprintf(done, INSTRUMENT_DONE, "x z, %zu rows at even positions", n);
    int status = set_line(map, &line, metres, err);
    for (size_t p = 0; p < n && status == 0; p++)
        map->z[p] = points[p].z;
    return status;
}

int columns_trace(struct height_map *map, const struct columns_table *table, size_t x, size_t z,
                  double metres, char *done, struct error *err) {
    if (table->rows < POSITIONS_LEAST)
        return error_set(err, ERROR_INPUT, "%zu rows; a trace has at least %d", table->rows,
                         POSITIONS_LEAST);
    struct point *points = points_of(table, x, z);
    if (points == NULL)
        return error_memory(err, table->rows * sizeof *points, "a trace");
    int status = trace_of(map, points, table->rows, metres, done, err);
    free(points);
    if (status != 0)
        height_map_clear(map);
    return status;
}

static int check_columns(const struct columns_table *table, enum instrument_columns asked,
                         struct error *err) {
    const size_t needed = asked == COLUMNS_XZ ? 2 : asked == COLUMNS_XYZ ? 3 : 1;
    if (table->columns >= needed)
        return 0;
    return error_set(err, ERROR_INPUT, "--columns %s needs %zu numbers a row, not %zu",
                     asked == COLUMNS_XZ ? "xz" : "xyz", needed, table->columns);
}

int columns_of_plain(struct height_map *map, enum instrument_columns asked, char *done,
                     struct error *err) {
    const bool column = asked != COLUMNS_XZ && asked != COLUMNS_XYZ && map->grid.ny == 1;
    const struct columns_table table = {map->z, map->grid.ny, map->grid.nx};
    const double metres[2] = {1, 1};
    struct height_map made = {0};
    int status = 0;
    if (column)
        return 0;
    if (asked == COLUMNS_AUTO)
        status = columns_choose(&asked, &table, err);
    if (status == 0)
        status = check_columns(&table, asked, err);
    if (status != 0 || asked == COLUMNS_MAP)
        return status;
    const struct point_list points = list_of(&table);
    if (asked == COLUMNS_XYZ)
        status = point_grid_map(&made, &points, metres, err);
    else
        status = columns_trace(&made, &table, 0, 1, 1, done, err);
    if (status != 0)
        return status;
    if (asked == COLUMNS_XYZ)
        snprintf(done, INSTRUMENT_DONE, "x y z, %zu points", table.rows);
    height_map_clear(map);
    *map = made;
    return 0;
}
