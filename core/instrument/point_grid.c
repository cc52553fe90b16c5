#include "core/instrument/point_grid.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Places along one axis: first + index * step. */
struct line {
    double first, step; /* step 0: one place */
    size_t count;
};

static int compare(const void *a, const void *b) {
    const double *left = a, *right = b;
    return (*left > *right) - (*left < *right);
}

/* Gaps between sorted positions above a tenth of the largest one part neighbouring places, smaller
 * ones are scatter of one place; a step is the mean of those that are at most 1.5 of the smallest,
 * so that places without any point do not widen it. */
static double step_of(const double *sorted, size_t n) {
    double largest = 0, smallest = INFINITY, sum = 0;
    size_t count = 0;
    for (size_t a = 1; a < n; a++)
        largest = fmax(largest, sorted[a] - sorted[a - 1]);
    for (size_t a = 1; a < n; a++) {
        double gap = sorted[a] - sorted[a - 1];
        if (gap > largest / 10)
            smallest = fmin(smallest, gap);
    }
    for (size_t a = 1; a < n; a++) {
        double gap = sorted[a] - sorted[a - 1];
        if (gap > largest / 10 && gap <= 1.5 * smallest) {
            sum += gap;
            count++;
        }
    }
    return count > 0 ? sum / (double)count : 0;
}

static int find_line(struct line *line, const double *positions, size_t n, char axis,
                     struct error *err) {
    for (size_t point = 0; point < n; point++)
        if (!isfinite(positions[point]))
            return error_set(err, ERROR_INPUT, "point %zu has no finite %c", point + 1, axis);
    double *sorted = array_create(n, sizeof *sorted);
    if (sorted == NULL)
        return error_memory(err, n * sizeof *sorted, "a grid of points");
    memcpy(sorted, positions, n * sizeof *sorted);
    qsort(sorted, n, sizeof *sorted, compare);
    double range = sorted[n - 1] - sorted[0], step = step_of(sorted, n);
    *line = (struct line){sorted[0], 0, 1};
    free(sorted);
    double places = step > 0 ? round(range / step) : 0;
    if (!(places <= (double)n * POINT_GRID_PLACES))
        return error_set(err, ERROR_INPUT, "%zu points lie on no regular grid along %c", n, axis);
    if (places > 0) {
        line->step = range / places;
        line->count = (size_t)places + 1;
    }
    return 0;
}

/* The index of the place at which a position lies, or SIZE_MAX. */
static size_t place_of(const struct line *line, double position) {
    if (line->count == 1)
        return 0;
    double at = (position - line->first) / line->step, index = round(at);
    if (!(index >= 0 && index < (double)line->count && fabs(at - index) <= POINT_GRID_TOLERANCE))
        return SIZE_MAX;
    return (size_t)index;
}

/* taken: a byte a place, 1 where a point lies already. */
static int put_points(const struct height_map *map, const struct line lines[2], const double *x,
                      const double *y, const double *z, size_t n, char *taken, struct error *err) {
    for (size_t point = 0; point < n; point++) {
        size_t i = place_of(&lines[0], x[point]), j = place_of(&lines[1], y[point]);
        if (i == SIZE_MAX || j == SIZE_MAX)
            return error_set(err, ERROR_INPUT,
                             "point %zu at (%g, %g) lies on no regular grid: the others have steps "
                             "of %g and %g",
                             point + 1, x[point], y[point], lines[0].step, lines[1].step);
        size_t place = j * map->grid.nx + i;
        if (taken[place] != 0)
            return error_set(err, ERROR_INPUT, "point %zu at (%g, %g) lies where another one does",
                             point + 1, x[point], y[point]);
        taken[place] = 1;
        map->z[place] = z[point];
    }
    return 0;
}

static int fill(struct height_map *map, const struct line lines[2], const double *x,
                const double *y, const double *z, size_t n, struct error *err) {
    size_t places = grid_points(&map->grid);
    char *taken = array_create(places, 1);
    map->z = array_create(places, sizeof *map->z);
    int status = taken == NULL || map->z == NULL
                     ? error_memory(err, places * sizeof *map->z, "a height map")
                     : 0;
    for (size_t place = 0; place < places && status == 0; place++)
        map->z[place] = NAN;
    if (status == 0)
        status = put_points(map, lines, x, y, z, n, taken, err);
    free(taken);
    return status;
}

int point_grid_map(struct height_map *out, const double *x, const double *y, const double *z,
                   size_t n, struct error *err) {
    struct height_map map = {0};
    struct line lines[2];
    if (n < 2)
        return error_set(err, ERROR_INPUT, "%zu points make no map; allowed: 2 and more", n);
    int status = find_line(&lines[0], x, n, 'x', err);
    if (status == 0)
        status = find_line(&lines[1], y, n, 'y', err);
    if (status != 0)
        return status;
    if (lines[0].count > n * POINT_GRID_PLACES / lines[1].count)
        return error_set(err, ERROR_INPUT,
                         "%zu points lie on no regular grid: one of %zu x %zu would be needed", n,
                         lines[0].count, lines[1].count);
    status = height_map_shape(&map, lines[1].count, lines[0].count, 1, err);
    if (status != 0)
        return status;
    map.grid.lx = lines[0].step * (double)map.grid.nx;
    map.grid.ly = (map.grid.ny > 1 ? lines[1].step : lines[0].step) * (double)map.grid.ny;
    status = grid_check(&map.grid, err);
    if (status == 0)
        status = fill(&map, lines, x, y, z, n, err);
    if (status != 0)
        height_map_clear(&map);
    else
        *out = map;
    return status;
}
