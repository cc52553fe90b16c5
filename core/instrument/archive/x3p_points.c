#include "core/instrument/archive/x3p_points.h"
#include "core/instrument/little_endian.h"
#include "core/instrument/point_grid.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct x3p_points {
    struct x3p_layout layout;
    size_t first, n;          /* points of the layer: from `first` on, n of them */
    size_t taken;             /* points of all layers */
    size_t marked;            /* of these, number of points marked as valid or not */
    double *values[X3P_AXES]; /* owned; metres, n; NULL for an incremental axis */
};

int x3p_points_create(struct x3p_points **out, const struct x3p_layout *layout, size_t layer,
                      struct error *err) {
    struct x3p_points *points = array_create(1, sizeof *points);
    if (points == NULL)
        return error_memory(err, sizeof *points, "points");
    points->layout = *layout;
    points->n = layout->n / layout->layers;
    points->first = layer * points->n;
    for (int axis = 0; axis < X3P_AXES; axis++) {
        if (!layout->axes[axis].absolute)
            continue;
        points->values[axis] = array_create(points->n, sizeof(double));
        if (points->values[axis] == NULL) {
            x3p_points_destroy(&points);
            return error_memory(err, layout->n * sizeof(double), "points");
        }
    }
    *out = points;
    return 0;
}

void x3p_points_destroy(struct x3p_points **points) {
    if (*points == NULL)
        return;
    for (int axis = 0; axis < X3P_AXES; axis++)
        free((*points)->values[axis]);
    free(*points);
    *points = NULL;
}

/* Stores a number of the present point, if it is of the layer. */
static void keep(struct x3p_points *points, int axis, double number) {
    const struct x3p_axis *scale = &points->layout.axes[axis];
    if (points->taken - points->first < points->n)
        points->values[axis][points->taken - points->first] =
            scale->offset + number * scale->increment;
}

static int check_room(const struct x3p_points *points, struct error *err) {
    if (points->taken < points->layout.n)
        return 0;
    return error_set(err, ERROR_INPUT, "there are more points than the %zu that Record3 says",
                     points->layout.n);
}

/* Some instruments write infinity where nothing was measured. */
static double number_at(const char *at, char type) {
    if (type == 'D' || type == 'F') {
        double number = type == 'D' ? little_double(at) : (double)little_float(at);
        return isinf(number) ? (double)NAN : number;
    }
    if (type == 'I') {
        uint64_t bits = little_integer(at, 2);
        return (double)bits - ((bits & 0x8000) != 0 ? 0x1p16 : 0);
    }
    uint64_t bits = little_integer(at, 4);
    return (double)bits - ((bits & 0x80000000) != 0 ? 0x1p32 : 0);
}

int x3p_points_take_binary(struct x3p_points *points, const char *bytes, size_t count,
                           struct error *err) {
    const struct x3p_layout *layout = &points->layout;
    if (count % layout->record != 0)
        return error_set(err, ERROR_INPUT, "the data end within a point, which takes %zu bytes",
                         layout->record);
    for (const char *end = bytes + count; bytes < end; points->taken++) {
        int status = check_room(points, err);
        if (status != 0)
            return status;
        for (int axis = 0; axis < X3P_AXES; axis++) {
            if (layout->axes[axis].absolute)
                keep(points, axis, number_at(bytes, layout->axes[axis].type));
            bytes += layout->axes[axis].bytes;
        }
    }
    return 0;
}

/* --- listed points --- */

/* Reads a number up to ';' or the end, without blanks around it; *at moves behind the ';'. */
static bool read_number(const char **at, double *number) {
    static const char BLANKS[] = " \t\r\n";
    const char *text = *at + strspn(*at, BLANKS);
    size_t length = strspn(text, "+-.0123456789eE");
    char *stop;
    if (strncasecmp(text, "nan", 3) == 0) {
        *number = NAN;
        length = 3;
    } else {
        *number = strtod(text, &stop);
        if (length == 0 || stop != text + length)
            return false;
    }
    text += length;
    text += strspn(text, BLANKS);
    *at = *text == ';' ? text + 1 : text;
    return *text == ';' || *text == '\0';
}

/* Reads the numbers of a listed point: of each absolute axis, or of all three axes. */
static bool read_numbers(const char *text, const struct x3p_layout *layout,
                         double numbers[X3P_AXES], bool *all) {
    size_t count = 0;
    while (count < X3P_AXES && (count == 0 || *text != '\0'))
        if (!read_number(&text, &numbers[count++]))
            return false;
    *all = count == X3P_AXES;
    return *text == '\0' && text[-1] != ';' && (*all || count == layout->absolute);
}

int x3p_points_take_text(struct x3p_points *points, const char *text, struct error *err) {
    const struct x3p_layout *layout = &points->layout;
    double numbers[X3P_AXES] = {NAN, NAN, NAN};
    bool all = true;
    int status = check_room(points, err);
    if (status != 0)
        return status;
    if (*text != '\0' && !read_numbers(text, layout, numbers, &all))
        return error_set(err, ERROR_INPUT,
                         "point %zu is '%.60s'; allowed: %zu numbers with ; between, as 1e-6, or "
                         "nothing for a hole",
                         points->taken + 1, text, layout->absolute);
    for (size_t axis = 0, number = 0; axis < X3P_AXES; axis++)
        if (layout->axes[axis].absolute)
            keep(points, (int)axis, numbers[all ? axis : number++]);
    points->taken++;
    return 0;
}

int x3p_points_take_valid(struct x3p_points *points, const char *bytes, size_t count,
                          struct error *err) {
    if (count > (points->layout.n + 7) / 8 - points->marked / 8)
        return error_set(
            err, ERROR_INPUT,
            "there are more bits of valid points than the %zu points that Record3 says",
            points->layout.n);
    for (size_t bit = 0; bit < 8 * count && points->marked < points->layout.n; bit++) {
        size_t point = points->marked++ - points->first;
        if (point < points->n && ((unsigned char)bytes[bit / 8] >> bit % 8 & 1) == 0)
            points->values[X3P_Z][point] = NAN;
    }
    return 0;
}

/* --- the map --- */

/* Finds the step along an axis of a matrix with stored positions. Those of all points that are no
 * holes must be regular. */
static int regular_step(const struct x3p_points *points, int axis, double *step,
                        struct error *err) {
    const double *positions = points->values[axis], *z = points->values[X3P_Z];
    size_t nx = points->layout.nx, low = SIZE_MAX, high = 0;
    double at_low = 0, at_high = 0;
    for (size_t point = 0; point < points->n; point++) {
        size_t index = axis == X3P_X ? point % nx : point / nx;
        if (isnan(z[point]))
            continue;
        if (low == SIZE_MAX || index < low) {
            low = index;
            at_low = positions[point];
        }
        if (index >= high) {
            high = index;
            at_high = positions[point];
        }
    }
    *step = low < high ? (at_high - at_low) / (double)(high - low) : 0;
    if (!(*step > 0 && isfinite(*step)))
        return error_set(err, ERROR_INPUT, "positions do not rise along %c", "xy"[axis]);
    for (size_t point = 0; point < points->n; point++) {
        size_t index = axis == X3P_X ? point % nx : point / nx;
        double position = at_low + ((double)index - (double)low) * *step;
        if (!isnan(z[point]) &&
            !(fabs(positions[point] - position) <= POINT_GRID_TOLERANCE * *step))
            return error_set(err, ERROR_INPUT,
                             "row %zu, column %zu: the point lies at %c = %g m, and on a regular "
                             "grid at %g m",
                             point / nx + 1, point % nx + 1, "xy"[axis], positions[point],
                             position);
    }
    return 0;
}

static int step_along(const struct x3p_points *points, int axis, double *step, struct error *err) {
    *step = points->layout.axes[axis].increment;
    return points->values[axis] != NULL ? regular_step(points, axis, step, err) : 0;
}

/* Moves the heights into the map on success. */
static int matrix_map(struct x3p_points *points, struct height_map *map, struct error *err) {
    double dx = 0, dy = 0;
    int status = height_map_shape(map, points->layout.ny, points->layout.nx, 1, err);
    if (status == 0)
        status = step_along(points, X3P_X, &dx, err);
    if (status == 0 && points->layout.ny > 1)
        status = step_along(points, X3P_Y, &dy, err);
    if (status != 0)
        return status;
    map->grid.lx = dx * (double)map->grid.nx;
    map->grid.ly = (map->grid.ny > 1 ? dy : dx) * (double)map->grid.ny;
    status = grid_check(&map->grid, err);
    if (status != 0)
        return status;
    map->z = points->values[X3P_Z];
    points->values[X3P_Z] = NULL;
    return 0;
}

static int check_taken(const struct x3p_points *points, struct error *err) {
    if (points->taken != points->layout.n)
        return error_set(err, ERROR_INPUT, "there are %zu points where Record3 says %zu",
                         points->taken, points->layout.n);
    if (points->marked != 0 && points->marked != points->layout.n)
        return error_set(err, ERROR_INPUT, "there are %zu bits of valid points for %zu points",
                         points->marked, points->layout.n);
    for (size_t point = 0; point < points->n; point++)
        if (isinf(points->values[X3P_Z][point]))
            return error_set(err, ERROR_INPUT, "point %zu: the height is not finite", point + 1);
    return 0;
}

/* Points without height do not count: their positions are arbitrary. */
static int list_map(struct x3p_points *points, struct height_map *map, struct error *err) {
    double *x = points->values[X3P_X], *y = points->values[X3P_Y], *z = points->values[X3P_Z];
    size_t n = 0;
    for (size_t point = 0; point < points->n; point++) {
        if (isnan(z[point]))
            continue;
        x[n] = x[point];
        y[n] = y[point];
        z[n++] = z[point];
    }
    const struct point_list list = {.n = n, .stride = 1, .of = {x, y, z}, .measured = true};
    return point_grid_map(map, &list, (const double[]){1, 1}, err);
}

int x3p_points_map(struct x3p_points *points, struct height_map *out, struct error *err) {
    struct height_map map = {0};
    int status = check_taken(points, err);
    if (status == 0)
        status = points->layout.list ? list_map(points, &map, err) : matrix_map(points, &map, err);
    if (status != 0)
        return status;
    for (size_t point = 0; point < grid_points(&map.grid); point++)
        if (isnan(map.z[point]))
            map.z[point] = NAN; /* one of many */
    strcpy(map.xy_unit, "m");
    strcpy(map.z_unit, "m");
    *out = map;
    return 0;
}
