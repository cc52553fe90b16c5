#include "core/map/preparation/map_turn.h"
#include "core/map/preparation/membrane.h"
#include "core/statistics/measured_map.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int map_replace(struct height_map *map, const struct grid *grid, double *z) {
    free(map->z);
    map->z = z;
    map->grid = *grid;
    return 0;
}

static double *points_create(const struct grid *grid, struct error *err) {
    double *z = array_create(grid_points(grid), sizeof *z);
    if (z == NULL)
        error_memory(err, grid_points(grid) * sizeof *z, "a turned map");
    return z;
}

int map_transpose(struct height_map *map, struct error *err) {
    const struct grid *old = &map->grid;
    const struct grid grid = {old->ny, old->nx, old->ly, old->lx};
    if (grid_is_profile(old))
        return error_set(err, ERROR_INPUT, "a profile has no second axis");
    double *z = points_create(&grid, err);
    if (z == NULL)
        return ERROR_MEMORY;
    for (size_t j = 0; j < grid.ny; j++)
        for (size_t i = 0; i < grid.nx; i++)
            z[j * grid.nx + i] = map->z[i * old->nx + j];
    return map_replace(map, &grid, z);
}

static void turn_half(struct height_map *map) {
    for (size_t first = 0, last = grid_points(&map->grid) - 1; first < last; first++, last--) {
        const double z = map->z[first];
        map->z[first] = map->z[last];
        map->z[last] = z;
    }
}

/* (x, y) goes to (-y, x): transposed, with x counted backwards. */
static int turn_quarter(struct height_map *map, struct error *err) {
    int status = map_transpose(map, err);
    for (size_t j = 0; j < map->grid.ny && status == 0; j++)
        for (size_t first = 0, last = map->grid.nx - 1; first < last; first++, last--) {
            double *row = map->z + j * map->grid.nx, z = row[first];
            row[first] = row[last];
            row[last] = z;
        }
    return status;
}

int map_turn_right(struct height_map *map, unsigned right_angles, struct error *err) {
    int status = right_angles % 2 == 1 ? turn_quarter(map, err) : 0;
    if (status == 0 && right_angles % 4 >= 2)
        turn_half(map);
    return status;
}

/* --- splines --- */

enum { SPLINE_MOST = 7, POLES_MOST = 3, MARGIN = 4, PAD = 40 };

/* A B-spline of odd degree through points 1 apart. */
struct spline {
    int degree;
    size_t poles;
    double pole[POLES_MOST]; /* of the recursions that give the coefficients */
};
static const struct spline FIFTH = {5, 2, {-0.43057534709997379, -0.043096288203264654}};
static const struct spline SEVENTH = {
    7, 3, {-0.53528043079643817, -0.12255461519232669, -0.0091486948096082769}};

/* Heights of a line beyond its ends: its own image turned around them, so that slopes go on. */
static double line_height(const double *z, size_t n, size_t step, long i) {
    const long last = (long)n - 1;
    const long beyond = i < 0 ? -i : i > last ? i - last : 0;
    const long inside = beyond < last ? beyond : last;
    if (i < 0)
        return 2 * z[0] - z[(size_t)inside * step];
    if (i > last)
        return 2 * z[(size_t)last * step] - z[(size_t)(last - inside) * step];
    return z[(size_t)i * step];
}

/* Computes the coefficients of the points -MARGIN to n - 1 + MARGIN of a line. room: n + 2 PAD. */
static void line_coefficients(const struct spline *spline, const double *z, size_t n, size_t step,
                              double *room, double *out, size_t out_step) {
    const size_t all = n + 2 * (size_t)PAD;
    for (size_t i = 0; i < all; i++)
        room[i] = line_height(z, n, step, (long)i - PAD);
    for (size_t p = 0; p < spline->poles; p++) {
        const double pole = spline->pole[p], gain = (1 - pole) * (1 - 1 / pole);
        room[0] *= gain / (1 - pole);
        for (size_t i = 1; i < all; i++)
            room[i] = gain * room[i] + pole * room[i - 1];
        room[all - 1] *= -pole / (1 - pole);
        for (size_t i = all - 1; i-- > 0;)
            room[i] = pole * (room[i + 1] - room[i]);
    }
    for (size_t i = 0; i < n + 2 * (size_t)MARGIN; i++)
        out[i * out_step] = room[i + PAD - MARGIN];
}

/* Coefficients of the heights of a map: (nx + 2 MARGIN) by (ny + 2 MARGIN). */
static int coefficients_create(double **out, const struct grid *grid, const double *z,
                               const struct spline *spline, struct error *err) {
    const size_t nx = grid->nx, ny = grid->ny;
    const size_t wide = nx + 2 * (size_t)MARGIN, high = ny + 2 * (size_t)MARGIN;
    const size_t longest = (nx > ny ? nx : ny) + 2 * (size_t)PAD;
    double *c = *out = array_create(wide * high, sizeof *c);
    double *room = array_create(2 * longest, sizeof *room);
    if (c == NULL || room == NULL) {
        free(room);
        return error_memory(err, (wide * high + 2 * longest) * sizeof *c, "a spline");
    }
    for (size_t j = 0; j < ny; j++)
        line_coefficients(spline, z + j * nx, nx, 1, room, c + (j + MARGIN) * wide, 1);
    for (size_t i = 0; i < wide; i++) {
        double *line = room + longest;
        for (size_t j = 0; j < ny; j++)
            line[j] = c[(j + MARGIN) * wide + i];
        line_coefficients(spline, line, ny, 1, room, c + i, wide);
    }
    free(room);
    return 0;
}

/* Fills the degree + 1 weights of the coefficients from *first on at a position within n points
 * (de Boor 1978). */
static void weights_at(const struct spline *spline, double position, size_t n, size_t *first,
                       double *weight) {
    const double inside = fmin(fmax(position, 0), (double)(n - 1));
    const size_t cell = inside < (double)(n - 1) ? (size_t)inside : n - 2;
    const double t = inside - (double)cell;
    weight[0] = 1;
    for (int d = 1; d <= spline->degree; d++) {
        weight[d] = t * weight[d - 1] / d;
        for (int k = d - 1; k > 0; k--)
            weight[k] = ((t + d - k) * weight[k - 1] + (k + 1 - t) * weight[k]) / d;
        weight[0] = (1 - t) * weight[0] / d;
    }
    *first = cell + MARGIN - (size_t)(spline->degree / 2);
}

/* The new points, and where they lie in the old ones. */
struct turned {
    const struct grid *from;
    struct grid to;
    double sine, cosine;
};

/* Fills the position of a new point among the old ones. */
static void position_of(const struct turned *turned, size_t i, size_t j, double *x, double *y) {
    const struct grid *from = turned->from, *to = &turned->to;
    const double u = ((double)i - (double)(to->nx - 1) / 2) * grid_dx(to);
    const double v = ((double)j - (double)(to->ny - 1) / 2) * grid_dy(to);
    *x = (turned->cosine * u + turned->sine * v) / grid_dx(from) + (double)(from->nx - 1) / 2;
    *y = (turned->cosine * v - turned->sine * u) / grid_dy(from) + (double)(from->ny - 1) / 2;
}

static int interpolate(const struct turned *turned, const double *z, const struct spline *spline,
                       double *out, struct error *err) {
    const struct grid *from = turned->from, *to = &turned->to;
    const size_t wide = from->nx + 2 * (size_t)MARGIN;
    double *coefficients = NULL;
    int status = coefficients_create(&coefficients, from, z, spline, err);
    for (size_t j = 0, point = 0; j < to->ny && status == 0; j++)
        for (size_t i = 0; i < to->nx; i++, point++) {
            double x, y, across[SPLINE_MOST + 1], up[SPLINE_MOST + 1], sum = 0;
            size_t column, row;
            position_of(turned, i, j, &x, &y);
            weights_at(spline, x, from->nx, &column, across);
            weights_at(spline, y, from->ny, &row, up);
            for (int b = 0; b <= spline->degree; b++) {
                const double *c = coefficients + (row + (size_t)b) * wide + column;
                double line = 0;
                for (int a = 0; a <= spline->degree; a++)
                    line += across[a] * c[a];
                sum += up[b] * line;
            }
            out[point] = sum;
        }
    free(coefficients);
    return status;
}

/* Returns the mean square of the slope of a - b; of a where b is NULL. */
static double slope_square(const struct grid *grid, const double *a, const double *b) {
    const double spacing[2] = {grid_dx(grid), grid_dy(grid)};
    const size_t step[2] = {1, grid->nx};
    double total = 0;
    for (int axis = 0; axis < 2; axis++) {
        struct average squares = {0};
        for (size_t j = 0; j + (axis == 1 ? 1 : 0) < grid->ny; j++)
            for (size_t i = 0; i + (axis == 0 ? 1 : 0) < grid->nx; i++) {
                const size_t at = j * grid->nx + i, next = at + step[axis];
                const double rise = a[next] - a[at] - (b != NULL ? b[next] - b[at] : 0);
                average_add(&squares, rise * rise);
            }
        total += average_value(&squares) / (spacing[axis] * spacing[axis]);
    }
    return total;
}

static void mark_holes(const struct turned *turned, const double *z, double *out) {
    const struct grid *from = turned->from, *to = &turned->to;
    for (size_t j = 0, point = 0; j < to->ny; j++)
        for (size_t i = 0; i < to->nx; i++, point++) {
            double x, y;
            position_of(turned, i, j, &x, &y);
            const size_t column = (size_t)fmin(fmax(x, 0), (double)(from->nx - 2));
            const size_t row = (size_t)fmin(fmax(y, 0), (double)(from->ny - 2));
            const double *cell = z + row * from->nx + column;
            if (isnan(cell[0] + cell[1] + cell[from->nx] + cell[from->nx + 1]))
                out[point] = (double)NAN;
        }
}

/* The heights with their holes filled, for a spline through all of them; the map's own where it has
 * none. */
static int whole_heights(double **out, const struct height_map *map, struct error *err) {
    const size_t points = grid_points(&map->grid);
    *out = map->z;
    if (height_map_holes(map) == 0)
        return 0;
    double *z = points_create(&map->grid, err);
    if (z == NULL)
        return ERROR_MEMORY;
    memcpy(z, map->z, points * sizeof *z);
    int status = membrane_fill(&map->grid, z, BOUNDARY_OPEN, err);
    if (status != 0)
        free(z);
    else
        *out = z;
    return status;
}

/* The largest rectangle along the axes in one of width w and height h that is turned. */
static void rectangle_inside(double w, double h, double sine, double cosine, double *width,
                             double *height) {
    const double longer = fmax(w, h), shorter = fmin(w, h), s = fabs(sine), c = fabs(cosine);
    if (shorter <= 2 * s * c * longer || fabs(s - c) < 1e-10) {
        const double half = shorter / 2; /* two corners lie on the longer sides */
        *width = w >= h ? half / s : half / c;
        *height = w >= h ? half / c : half / s;
        return;
    }
    *width = (w * c - h * s) / (c * c - s * s);
    *height = (h * c - w * s) / (c * c - s * s);
}

static int turned_choose(struct turned *out, const struct grid *grid, double angle,
                         struct error *err) {
    const double dx = grid_dx(grid), dy = grid_dy(grid), spacing = fmin(dx, dy);
    double width, height;
    *out = (struct turned){.from = grid, .sine = sin(angle), .cosine = cos(angle)};
    rectangle_inside((double)(grid->nx - 1) * dx, (double)(grid->ny - 1) * dy, out->sine,
                     out->cosine, &width, &height);
    const double nx = floor(width / spacing + 1e-9) + 1, ny = floor(height / spacing + 1e-9) + 1;
    if (!(nx >= 2 && ny >= 2 && nx * ny <= 0x1p31))
        return error_set(err, ERROR_INPUT,
                         "the largest rectangle in the turned map has %g by %g points; allowed: 2 "
                         "by 2 at least, 2^31 in all",
                         nx, ny);
    out->to = (struct grid){(size_t)nx, (size_t)ny, nx * spacing, ny * spacing};
    return 0;
}

int map_turn(struct height_map *map, double angle, struct map_turn_result *out, struct error *err) {
    struct turned turned;
    double *whole = NULL, *z = NULL, *fifth = NULL;
    if (map->grid.ny < 2)
        return error_set(err, ERROR_INPUT, "a profile has no second axis");
    int status = turned_choose(&turned, &map->grid, angle, err);
    if (status == 0)
        status = whole_heights(&whole, map, err);
    if (status == 0) {
        z = points_create(&turned.to, err);
        fifth = z != NULL ? points_create(&turned.to, err) : NULL;
        status = fifth != NULL ? 0 : ERROR_MEMORY;
    }
    if (status == 0)
        status = interpolate(&turned, whole, &FIFTH, fifth, err);
    if (status == 0)
        status = interpolate(&turned, whole, &SEVENTH, z, err);
    if (status == 0) {
        const double slope = slope_square(&turned.to, z, NULL);
        out->slope_change = slope > 0 ? sqrt(slope_square(&turned.to, z, fifth) / slope) : 0;
        if (whole != map->z)
            mark_holes(&turned, map->z, z);
    }
    if (whole != map->z)
        free(whole);
    free(fifth);
    if (status != 0)
        free(z);
    return status == 0 ? map_replace(map, &turned.to, z) : status;
}
