#include "core/map/preparation/tip.h"
#include "core/statistics/measured_map.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* Lines of parabolas y + a (x - i)^2, one at each point i that has a height y. */
struct envelope {
    double *height; /* owned, n: of the line */
    double *from;   /* owned, n + 1: where parabola number k begins to be the lowest */
    uint32_t *at;   /* owned, n: its point */
};

static void envelope_clear(struct envelope *envelope) {
    free(envelope->height);
    free(envelope->from);
    free(envelope->at);
}

static int envelope_create(struct envelope *envelope, size_t n, struct error *err) {
    *envelope = (struct envelope){.height = array_create(n, sizeof(double)),
                                  .from = array_create(n + 1, sizeof(double)),
                                  .at = array_create(n, sizeof(uint32_t))};
    if (envelope->height != NULL && envelope->from != NULL && envelope->at != NULL)
        return 0;
    envelope_clear(envelope);
    return error_memory(err, 3 * n * sizeof(double), "parabolas");
}

/* Returns where the parabola at j, behind i, falls below that at i. */
static double crossing(const double *height, double a, uint32_t i, uint32_t j) {
    const double middle = ((double)i + (double)j) / 2;
    return middle + (height[j] - height[i]) / (2 * a * ((double)j - (double)i));
}

/* Finds which parabolas are the lowest somewhere, in their order; returns how many. */
static size_t envelope_build(struct envelope *e, size_t n, double a) {
    size_t count = 0;
    for (uint32_t j = 0; j < n; j++) {
        if (isnan(e->height[j]))
            continue;
        double from = -INFINITY;
        while (count > 0) {
            from = crossing(e->height, a, e->at[count - 1], j);
            if (from > e->from[count - 1])
                break;
            count--;
        }
        e->at[count] = j;
        e->from[count] = count > 0 ? from : -INFINITY;
        count++;
    }
    return count;
}

/* Replaces the n heights of a line, `step` apart, by the lowest parabola over each point, and
 * fills which that is. A line without a height has NaN and 0. */
static void line_erode(struct envelope *e, double *z, uint32_t *apex, size_t n, size_t step,
                       double a) {
    for (size_t i = 0; i < n; i++)
        e->height[i] = z[i * step];
    const size_t count = envelope_build(e, n, a);
    for (size_t i = 0, k = 0; i < n; i++) {
        while (k + 1 < count && e->from[k + 1] < (double)i)
            k++;
        const uint32_t at = count > 0 ? e->at[k] : 0;
        const double distance = (double)i - (double)at;
        z[i * step] = count > 0 ? e->height[at] + a * distance * distance : (double)NAN;
        apex[i * step] = at;
    }
}

/* An eroded image, and the column and row of the tip over each of its points. */
struct eroded {
    const struct grid *grid;
    double *z;              /* owned, points, as the next two */
    uint32_t *column, *row; /* the column is that of the point's own column and row `row` */
};

static void eroded_clear(struct eroded *eroded) {
    free(eroded->z);
    free(eroded->column);
    free(eroded->row);
}

static int eroded_create(struct eroded *out, const struct grid *grid, const double *z,
                         double radius, double sign, struct error *err) {
    const size_t points = grid_points(grid), nx = grid->nx, ny = grid->ny;
    const double dx = grid_dx(grid), dy = grid_dy(grid);
    struct envelope envelope;
    *out = (struct eroded){.grid = grid};
    if (nx >= UINT32_MAX || ny >= UINT32_MAX)
        return error_set(err, ERROR_INPUT, "%zu by %zu points; a tip takes fewer a side", nx, ny);
    out->z = array_create(points, sizeof *out->z);
    out->column = array_create(points, sizeof *out->column);
    out->row = array_create(points, sizeof *out->row);
    if (out->z == NULL || out->column == NULL || out->row == NULL)
        return error_memory(err, points * 2 * sizeof *out->z, "a surface under a tip");
    int status = envelope_create(&envelope, nx > ny ? nx : ny, err);
    if (status != 0)
        return status;
    for (size_t point = 0; point < points; point++)
        out->z[point] = sign * z[point];
    for (size_t j = 0; j < ny; j++)
        line_erode(&envelope, out->z + j * nx, out->column + j * nx, nx, 1, dx * dx / (2 * radius));
    for (size_t i = 0; i < nx && ny > 1; i++)
        line_erode(&envelope, out->z + i, out->row + i, ny, nx, dy * dy / (2 * radius));
    envelope_clear(&envelope);
    return 0;
}

/* Returns the point of the tip over point i, j, in x (axis 0) or y (1). */
static double apex_at(const struct eroded *eroded, size_t i, size_t j, int axis) {
    const size_t nx = eroded->grid->nx;
    const uint32_t row = eroded->row[j * nx + i];
    return axis == 1 ? (double)row : (double)eroded->column[row * nx + i];
}

/* Steps from a point to either side, over which the tip's motion is measured; the tip has not
 * reached a point where it moves less than STILL of what the point does. */
enum { REACH = 2 };
static const double STILL = 0.4;

/* Ends of a span of points around one, inside of n. */
struct span {
    size_t from, to;
};
static struct span span_around(size_t i, size_t n) {
    const size_t from = i > REACH ? i - REACH : 0;
    return (struct span){from, i + REACH < n ? i + REACH : n - 1};
}

/* Returns how far the tip moves per step of the point, in the direction where it moves least: the
 * lesser eigenvalue of the symmetric part of its gradient. */
static double least_move(const struct eroded *eroded, size_t i, size_t j) {
    const struct grid *grid = eroded->grid;
    const struct span x = span_around(i, grid->nx), y = span_around(j, grid->ny);
    const double dx = grid_dx(grid), dy = grid_is_profile(grid) ? dx : grid_dy(grid);
    const double nx = (double)(x.to - x.from), ny = (double)(y.to - y.from);
    const double xx = (apex_at(eroded, x.to, j, 0) - apex_at(eroded, x.from, j, 0)) / nx;
    if (grid_is_profile(grid))
        return xx;
    const double yy = (apex_at(eroded, i, y.to, 1) - apex_at(eroded, i, y.from, 1)) / ny;
    const double yx = (apex_at(eroded, x.to, j, 1) - apex_at(eroded, x.from, j, 1)) / nx * dy / dx;
    const double xy = (apex_at(eroded, i, y.to, 0) - apex_at(eroded, i, y.from, 0)) / ny * dx / dy;
    return (xx + yy) / 2 - hypot((xx - yy) / 2, (xy + yx) / 2);
}

/* Farther away than this from its point the least is not that of one smooth part of the image. */
static const double STEP_MOST = 0.75;

/* Returns how much lower than at its point the envelope over point i, j is between the points of
 * the image: the least of the parabola through the nine around the tip, near its point; 0 beside
 * holes and sides, and where they have no least. */
static double between_points(const struct eroded *eroded, const double *image, size_t i, size_t j,
                             double radius) {
    const struct grid *grid = eroded->grid;
    const bool profile = grid_is_profile(grid);
    const size_t nx = grid->nx, row = eroded->row[j * nx + i];
    const size_t column = eroded->column[row * nx + i];
    if (column == 0 || column + 1 == nx || (!profile && (row == 0 || row + 1 == grid->ny)))
        return 0;
    const double ax = grid_dx(grid) * grid_dx(grid) / radius;
    const double ay = profile ? 1 : grid_dy(grid) * grid_dy(grid) / radius;
    const double *at = image + row * nx + column, *up = profile ? at : at - nx,
                 *down = profile ? at : at + nx;
    const double x = (at[1] - at[-1]) / 2 + ax * ((double)column - (double)i);
    const double y = (down[0] - up[0]) / 2 + (profile ? 0 : ay * ((double)row - (double)j));
    const double xx = at[1] - 2 * at[0] + at[-1] + ax, yy = up[0] - 2 * at[0] + down[0] + ay;
    const double xy = (down[1] - down[-1] - up[1] + up[-1]) / 4;
    const double determinant = xx * yy - xy * xy;
    if (!(xx > 0 && determinant > 0))
        return 0;
    const double step_x = (yy * x - xy * y) / determinant, step_y = (xx * y - xy * x) / determinant;
    return fabs(step_x) <= STEP_MOST && fabs(step_y) <= STEP_MOST ? (x * step_x + y * step_y) / 2
                                                                  : 0;
}

/* Lowers the points that the tip reached to the least between points, and marks the others; returns
 * how many of these there are. */
static size_t eroded_judge(struct eroded *eroded, const double *image, double radius,
                           unsigned char *untrusted) {
    const struct grid *grid = eroded->grid;
    size_t count = 0;
    for (size_t j = 0, point = 0; j < grid->ny; j++)
        for (size_t i = 0; i < grid->nx; i++, point++) {
            const bool hole = isnan(image[point]);
            const bool reached = hole || least_move(eroded, i, j) >= STILL;
            count += reached ? 0 : 1;
            if (untrusted != NULL)
                untrusted[point] = reached ? 0 : 1;
            if (reached && !hole)
                eroded->z[point] -= between_points(eroded, image, i, j, radius);
        }
    return count;
}

int tip_erode(const struct grid *grid, double *z, double radius, unsigned char *untrusted,
              struct tip_result *out, struct error *err) {
    struct eroded eroded;
    struct average squares = {0};
    *out = (struct tip_result){0};
    int status = eroded_create(&eroded, grid, z, radius, 1, err);
    if (status == 0)
        out->untrusted = eroded_judge(&eroded, z, radius, untrusted);
    for (size_t point = 0; point < grid_points(grid) && status == 0; point++)
        if (!isnan(z[point])) {
            const double change = z[point] - eroded.z[point];
            average_add(&squares, change * change);
            z[point] = eroded.z[point];
        }
    out->rms = squares.count > 0 ? sqrt(average_value(&squares)) : 0;
    eroded_clear(&eroded);
    return status;
}

int tip_dilate(const struct grid *grid, double *z, double radius, struct error *err) {
    struct eroded eroded;
    int status = eroded_create(&eroded, grid, z, radius, -1, err);
    for (size_t point = 0; point < grid_points(grid) && status == 0; point++)
        z[point] = isnan(z[point]) ? z[point] : -eroded.z[point];
    eroded_clear(&eroded);
    return status;
}
