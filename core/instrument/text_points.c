#include "core/instrument/text_map.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A regular axis: points at first + step i. */
struct axis {
    double first, step;
    size_t count;
};

/* Coordinates are printed with few digits: so far off the grid, in steps, is on it; and what
 * differs by less than the second, in parts of the range, is one coordinate. */
static const double OFF_GRID = 0.05, SAME = 1e-7;
enum { NODES_A_POINT = 64 };

static int by_value(const void *left, const void *right) {
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

static double coordinate(const struct text_table *table, size_t column, size_t point) {
    return table->numbers[point * table->columns + column];
}

/* Whether all n sorted coordinates lie on the axis, and no two that differ at one point of it. */
static bool lie_on(const struct axis *axis, const double *sorted, size_t n) {
    double same = SAME * (sorted[n - 1] - sorted[0]);
    for (size_t point = 0; point < n; point++) {
        double steps = (sorted[point] - axis->first) / axis->step;
        if (!(fabs(steps - round(steps)) <= OFF_GRID))
            return false;
        if (point > 0 && sorted[point] - sorted[point - 1] > same &&
            round(steps) == round((sorted[point - 1] - axis->first) / axis->step))
            return false;
    }
    return true;
}

/* The counts of distinct coordinates, and the least distance of two. */
static size_t distinct(const double *sorted, size_t n, double *least) {
    double same = SAME * (sorted[n - 1] - sorted[0]);
    size_t count = 1;
    *least = INFINITY;
    for (size_t point = 1; point < n; point++) {
        double gap = sorted[point] - sorted[point - 1];
        if (gap <= same)
            continue;
        count++;
        *least = fmin(*least, gap);
    }
    return count;
}

/* First as many points as there are distinct coordinates; where whole columns are missing, as many
 * as the least distance makes. */
static bool find_axis(const double *sorted, size_t n, struct axis *out) {
    double range = sorted[n - 1] - sorted[0], least;
    size_t count = distinct(sorted, n, &least);
    *out = (struct axis){sorted[0], 0, 1};
    if (count == 1)
        return true;
    *out = (struct axis){sorted[0], range / (double)(count - 1), count};
    if (lie_on(out, sorted, n))
        return true;
    double steps = round(range / least);
    if (!(steps >= 1 && steps <= (double)NODES_A_POINT * (double)n))
        return false;
    *out = (struct axis){sorted[0], range / steps, (size_t)steps + 1};
    return lie_on(out, sorted, n);
}

static int read_axis(const struct text_table *table, size_t column, char name, double *sorted,
                     struct axis *out, struct error *err) {
    for (size_t point = 0; point < table->rows; point++) {
        sorted[point] = coordinate(table, column, point);
        if (isnan(sorted[point]))
            return error_set(err, ERROR_INPUT, "point %zu has no %c", point + 1, name);
    }
    qsort(sorted, table->rows, sizeof *sorted, by_value);
    if (find_axis(sorted, table->rows, out))
        return 0;
    return error_set(err, ERROR_INPUT,
                     "the points' %c from %g to %g are not equally spaced; allowed: points on a "
                     "regular grid along x and y, in any order, with some missing",
                     name, sorted[0], sorted[table->rows - 1]);
}

static size_t node_of(const struct axis *axis, double at) {
    return axis->count == 1 ? 0 : (size_t)round((at - axis->first) / axis->step);
}

static int place(struct height_map *map, const struct text_table *table, const size_t of[3],
                 const struct axis axes[2], struct error *err) {
    unsigned char *taken = array_create(grid_points(&map->grid), 1);
    int status = 0;
    if (taken == NULL)
        return error_memory(err, grid_points(&map->grid), "the points of a map");
    for (size_t node = 0; node < grid_points(&map->grid); node++)
        map->z[node] = NAN;
    for (size_t point = 0; point < table->rows && status == 0; point++) {
        double x = coordinate(table, of[0], point), y = coordinate(table, of[1], point);
        size_t node = node_of(&axes[1], y) * axes[0].count + node_of(&axes[0], x);
        if (taken[node] != 0)
            status = error_set(err, ERROR_INPUT, "point %zu at (%g, %g) is there twice", point + 1,
                               x, y);
        taken[node] = 1;
        map->z[node] = coordinate(table, of[2], point);
    }
    free(taken);
    return status;
}

static int set_shape(struct height_map *map, const struct axis axes[2],
                     const struct text_header *header, struct error *err) {
    double metres[2];
    const char *y_unit = header->y_unit[0] != '\0' ? header->y_unit : header->x_unit;
    int status = height_map_shape(map, axes[1].count, axes[0].count, 1, err);
    if (status == 0)
        status = text_lateral_units(map, header->x_unit, y_unit, metres, err);
    if (status != 0)
        return status;
    bool profile = axes[1].count == 1;
    map->grid.lx = axes[0].step * metres[0] * (double)axes[0].count;
    map->grid.ly =
        (profile ? axes[0].step * metres[0] : axes[1].step * metres[1]) * (double)axes[1].count;
    return grid_check(&map->grid, err);
}

int text_points_map(struct height_map *map, const struct text_table *table,
                    const struct text_block *block, struct error *err) {
    const size_t plain[3] = {0, 1, 2};
    const size_t *of = block->columns.named ? block->columns.of : plain;
    struct axis axes[2];
    for (size_t c = 0; c < 3; c++)
        if (of[c] >= table->columns)
            return error_set(err, ERROR_INPUT, "a point has %zu numbers, %c is column %zu",
                             table->columns, "xyz"[c], of[c] + 1);
    double *sorted = array_create(table->rows, sizeof *sorted);
    if (sorted == NULL)
        return error_memory(err, table->rows * sizeof *sorted, "the points of a map");
    int status = read_axis(table, of[0], 'x', sorted, &axes[0], err);
    if (status == 0)
        status = read_axis(table, of[1], 'y', sorted, &axes[1], err);
    free(sorted);
    if (status != 0)
        return status;
    if ((double)axes[0].count * (double)axes[1].count > (double)NODES_A_POINT * (double)table->rows)
        return error_set(
            err, ERROR_INPUT,
            "%zu points lie on a grid of %zu x %zu; allowed: one point for %d nodes at "
            "least",
            table->rows, axes[0].count, axes[1].count, NODES_A_POINT);
    status = set_shape(map, axes, &block->header, err);
    if (status != 0)
        return status;
    map->z = array_create(grid_points(&map->grid), sizeof *map->z);
    if (map->z == NULL)
        return error_memory(err, grid_points(&map->grid) * sizeof *map->z, "a height map");
    status = place(map, table, of, axes, err);
    return status == 0 ? text_scale_heights(map, &block->header, err) : status;
}
