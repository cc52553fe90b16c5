#include "core/instrument/point_grid.h"
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* Nodes along one axis: first + step i. */
struct axis {
    double first, step; /* step 0: one node */
    size_t count;
};

/* Coordinates are printed with few digits. OFF_GRID is the largest distance from the grid, in
 * steps; differences below SAME, over the range, are no differences. */
static const double OFF_GRID = 0.05, SAME = 1e-7;
enum { NODES_A_POINT = 64 };

static double coordinate(const struct point_list *points, int axis, size_t point) {
    return points->of[axis][point * points->stride];
}

static int by_value(const void *left, const void *right) {
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* Counts distinct coordinates, and finds their least distance. */
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

/* Returns the step of measured coordinates. Gaps above a tenth of the largest gap separate
 * neighbouring nodes; smaller ones are scatter about one node. The step is the mean of those that
 * are at most 1.5 of the smallest, so that nodes without any point do not widen it. */
static double scattered_step(const double *sorted, size_t n) {
    double largest = 0, smallest = INFINITY, sum = 0;
    size_t count = 0;
    for (size_t point = 1; point < n; point++)
        largest = fmax(largest, sorted[point] - sorted[point - 1]);
    for (size_t point = 1; point < n; point++) {
        double gap = sorted[point] - sorted[point - 1];
        if (gap > largest / 10)
            smallest = fmin(smallest, gap);
    }
    for (size_t point = 1; point < n; point++) {
        double gap = sorted[point] - sorted[point - 1];
        if (gap > largest / 10 && gap <= 1.5 * smallest) {
            sum += gap;
            count++;
        }
    }
    return sum / (double)count;
}

/* Makes an axis of so many steps, and returns the first of n sorted coordinates that is not on it:
 * it is farther than `off` steps from a node, or differs from the last one at its node by more than
 * `scatter`. Returns n where all are on it. out->count is 1 where the steps are too many. */
static size_t first_off(struct axis *out, const double *sorted, size_t n, double steps, double off,
                        double scatter) {
    double range = sorted[n - 1] - sorted[0];
    *out = (struct axis){sorted[0], 0, 1};
    if (!(steps >= 1 && steps <= (double)NODES_A_POINT * (double)n))
        return 0;
    *out = (struct axis){sorted[0], range / steps, (size_t)steps + 1};
    for (size_t point = 0; point < n; point++) {
        double at = (sorted[point] - out->first) / out->step;
        if (!(fabs(at - round(at)) <= off))
            return point;
        if (point > 0 && sorted[point] - sorted[point - 1] > scatter &&
            round(at) == round((sorted[point - 1] - out->first) / out->step))
            return point;
    }
    return n;
}

/* Printed coordinates have as many nodes as there are distinct ones or, with missing columns, as
 * many as follow from the least distance. */
static int find_axis(struct axis *out, const double *sorted, size_t n, bool measured, char name,
                     struct error *err) {
    double range = sorted[n - 1] - sorted[0], least;
    if (!isfinite(range))
        return error_set(err, ERROR_INPUT, "%c from %g to %g: too far apart for a grid", name,
                         sorted[0], sorted[n - 1]);
    size_t count = distinct(sorted, n, &least), off;
    *out = (struct axis){sorted[0], 0, 1};
    if (count == 1)
        return 0;
    if (measured)
        off = first_off(out, sorted, n, round(range / scattered_step(sorted, n)),
                        POINT_GRID_TOLERANCE, INFINITY);
    else
        off = first_off(out, sorted, n, (double)(count - 1), OFF_GRID, SAME * range);
    if (off < n && !measured)
        off = first_off(out, sorted, n, round(range / least), OFF_GRID, SAME * range);
    if (off == n)
        return 0;
    if (out->count == 1)
        return error_set(err, ERROR_INPUT, "%zu points lie on no regular grid along %c", n, name);
    return error_set(err, ERROR_INPUT,
                     "%c = %g lies on no regular grid of steps of %g from %g on; "
                     "allowed: points in any order, some missing, equally spaced along x and y",
                     name, sorted[off], out->step, out->first);
}

/* sorted: room for a coordinate of each point. */
static int read_axis(struct axis *out, const struct point_list *points, int axis, double *sorted,
                     struct error *err) {
    for (size_t point = 0; point < points->n; point++) {
        sorted[point] = coordinate(points, axis, point);
        if (!isfinite(sorted[point]))
            return error_set(err, ERROR_INPUT, "point %zu has no finite %c", point + 1, "xy"[axis]);
    }
    qsort(sorted, points->n, sizeof *sorted, by_value);
    return find_axis(out, sorted, points->n, points->measured, "xy"[axis], err);
}

static size_t node_of(const struct axis *axis, double at) {
    return axis->count == 1 ? 0 : (size_t)round((at - axis->first) / axis->step);
}

/* taken: a byte a node, 1 where a point lies already. */
static int place(double *heights, unsigned char *taken, const struct axis axes[2],
                 const struct point_list *points, struct error *err) {
    for (size_t point = 0; point < points->n; point++) {
        double x = coordinate(points, 0, point), y = coordinate(points, 1, point);
        size_t node = node_of(&axes[1], y) * axes[0].count + node_of(&axes[0], x);
        if (taken[node] != 0)
            return error_set(err, ERROR_INPUT, "point %zu at (%g, %g) lies where another one does",
                             point + 1, x, y);
        taken[node] = 1;
        heights[node] = coordinate(points, 2, point);
    }
    return 0;
}

static int fill(struct height_map *map, const struct axis axes[2], const struct point_list *points,
                struct error *err) {
    size_t nodes = grid_points(&map->grid);
    unsigned char *taken = array_create(nodes, 1);
    map->z = array_create(nodes, sizeof *map->z);
    int status = taken == NULL || map->z == NULL
                     ? error_memory(err, nodes * sizeof *map->z, "a height map")
                     : 0;
    for (size_t node = 0; node < nodes && status == 0; node++)
        map->z[node] = NAN;
    if (status == 0)
        status = place(map->z, taken, axes, points, err);
    free(taken);
    if (status != 0)
        height_map_clear(map);
    return status;
}

int point_grid_map(struct height_map *map, const struct point_list *points, const double metres[2],
                   struct error *err) {
    struct axis axes[2];
    if (points->n < 2)
        return error_set(err, ERROR_INPUT, "%zu points make no map; allowed: 2 and more",
                         points->n);
    double *sorted = array_create(points->n, sizeof *sorted);
    if (sorted == NULL)
        return error_memory(err, points->n * sizeof *sorted, "the points of a map");
    int status = read_axis(&axes[0], points, 0, sorted, err);
    if (status == 0)
        status = read_axis(&axes[1], points, 1, sorted, err);
    free(sorted);
    if (status != 0)
        return status;
    if ((double)axes[0].count * (double)axes[1].count > (double)NODES_A_POINT * (double)points->n)
        return error_set(err, ERROR_INPUT,
                         "%zu points lie on a grid of %zu x %zu; allowed: one point for %d nodes "
                         "at least",
                         points->n, axes[0].count, axes[1].count, NODES_A_POINT);
    status = height_map_shape(map, axes[1].count, axes[0].count, 1, err);
    if (status != 0)
        return status;
    double dx = axes[0].step * metres[0];
    map->grid.lx = dx * (double)axes[0].count;
    map->grid.ly = (axes[1].count == 1 ? dx : axes[1].step * metres[1]) * (double)axes[1].count;
    status = grid_check(&map->grid, err);
    return status == 0 ? fill(map, axes, points, err) : status;
}
