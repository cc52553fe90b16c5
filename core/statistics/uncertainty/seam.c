#include "core/statistics/uncertainty/seam.h"
#include "core/vectors.h"
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ORDERS = 3, ORDER_MOST = 4 };

/* Differences of these orders are compared: a low one sees a step in a rough map, a high one also a
 * small step in a smooth map, where slopes differ. */
static const size_t ORDER[ORDERS] = {1, 2, 4};
static const double WEIGHT[ORDERS][ORDER_MOST + 1] = {{-1, 1}, {1, -2, 1}, {1, -4, 6, -4, 1}};

enum { LANES = 64 };

struct room {
    double limit;           /* of the square of a difference */
    double *square, *count; /* a value a point of the longer side */
    double *row;            /* nx + ORDER_MOST: a row, and its first points again */
};

/* Adds the squares of n differences of points at[k][i], k = 0 .. ORDER[d], up to a limit each, and
 * counts those that are there. */
WIDE_VECTORS static void squares_add(size_t n, size_t d, const double *const *at, double limit,
                                     double *restrict square, double *restrict count) {
    double difference[LANES];
    for (size_t i = 0; i < n; i++)
        difference[i] = 0;
    for (size_t k = 0; k <= ORDER[d]; k++)
        for (size_t i = 0; i < n; i++)
            difference[i] += WEIGHT[d][k] * at[k][i];
    for (size_t i = 0; i < n; i++) {
        bool there = difference[i] == difference[i];
        double one = difference[i] * difference[i];
        square[i] += there ? (one < limit ? one : limit) : 0;
        count[i] += there ? 1 : 0;
    }
}

/* Fill square[p] with the mean square, over the lines that cross the seam, of the difference that
 * begins at point p; those with p + order >= n cross the seam. NaN where no line has one. */
static void squares_along_x(const struct grid *grid, const double *z, size_t d,
                            const struct room *room) {
    size_t nx = grid->nx;
    for (size_t p = 0; p < nx; p++)
        room->square[p] = room->count[p] = 0;
    for (size_t j = 0; j < grid->ny; j++) {
        memcpy(room->row, z + j * nx, nx * sizeof *z);
        for (size_t k = 0; k < ORDER_MOST; k++)
            room->row[nx + k] = room->row[k];
        for (size_t p = 0; p < nx; p += LANES) {
            const double *at[ORDER_MOST + 1];
            for (size_t k = 0; k <= ORDER[d]; k++)
                at[k] = room->row + p + k;
            squares_add(nx - p < LANES ? nx - p : LANES, d, at, room->limit, room->square + p,
                        room->count + p);
        }
    }
    for (size_t p = 0; p < nx; p++)
        room->square[p] /= room->count[p];
}

static void squares_along_y(const struct grid *grid, const double *z, size_t d,
                            const struct room *room) {
    size_t nx = grid->nx, ny = grid->ny;
    for (size_t p = 0; p < ny; p++) {
        double square[LANES] = {0}, count[LANES] = {0};
        for (size_t i = 0; i < nx; i += LANES) {
            const double *at[ORDER_MOST + 1];
            for (size_t k = 0; k <= ORDER[d]; k++)
                at[k] = z + (p + k) % ny * nx + i;
            squares_add(nx - i < LANES ? nx - i : LANES, d, at, room->limit, square, count);
        }
        for (size_t l = 1; l < LANES; l++) {
            square[0] += square[l];
            count[0] += count[l];
        }
        room->square[p] = square[0] / count[0];
    }
}

/* Returns the mean over the `order` differences that cross the seam, over the largest mean of as
 * many in a row inside. */
static double seam_over_inside(const double *square, size_t n, size_t order) {
    double seam = 0, most = 0;
    for (size_t p = n - order; p < n; p++)
        seam += square[p];
    for (size_t first = 0; first + 2 * order <= n; first++) {
        double inside = 0;
        for (size_t p = first; p < first + order; p++)
            inside += square[p];
        most = inside > most ? inside : most; /* not so where NaN */
    }
    if (seam == 0)
        return 0;
    return isnan(seam) || most == 0 ? (double)INFINITY : sqrt(seam / most);
}

/* Returns the most that the square of a difference counts: a single spike would make all positions
 * that it is in the roughest ones. It is beyond what differences have that are distributed as a
 * Gaussian, by the median of every so many inside. A profile has one line, whose differences are
 * all there is to compare with. */
static double square_limit(const struct grid *grid, const double *z, size_t d, int axis) {
    enum { MOST = 4096, STRIDE = 7919 };                 /* a prime, as lines may be alike */
    static const double DEVIATIONS = 6, MEDIAN = 0.6745; /* of |x| of a Gaussian, in deviations */
    const size_t points = grid_points(grid), order = ORDER[d], stride = axis == 0 ? 1 : grid->nx;
    const size_t n = axis == 0 ? grid->nx : grid->ny;
    double size[MOST];
    size_t count = 0;
    if (grid_is_profile(grid))
        return (double)INFINITY;
    for (size_t s = 0, p = 0; s < points && count < MOST; s++, p = (p + STRIDE) % points) {
        const size_t at = axis == 0 ? p % n : p / grid->nx;
        double difference = 0;
        if (at + order >= n)
            continue;
        for (size_t k = 0; k <= order; k++)
            difference += WEIGHT[d][k] * z[p + k * stride];
        if (!isnan(difference))
            size[count++] = fabs(difference);
    }
    const double middle = count > 0 ? gsl_stats_median(size, 1, count) : 0;
    return middle > 0 ? pow(DEVIATIONS / MEDIAN * middle, 2) : (double)INFINITY;
}

static double lines_seam(const struct grid *grid, const double *z, int axis, struct room *room) {
    size_t n = axis == 0 ? grid->nx : grid->ny;
    double largest = 0;
    if (n < SEAM_POINTS)
        return (double)INFINITY;
    for (size_t d = 0; d < ORDERS; d++) {
        room->limit = square_limit(grid, z, d, axis);
        if (axis == 0)
            squares_along_x(grid, z, d, room);
        else
            squares_along_y(grid, z, d, room);
        largest = fmax(largest, seam_over_inside(room->square, n, ORDER[d]));
    }
    return largest;
}

int seam_measure(const struct grid *grid, const double *z, struct seam *out, struct error *err) {
    size_t nx = grid->nx, ny = grid->ny, most = nx > ny ? nx : ny;
    size_t count = 2 * most + nx + ORDER_MOST;
    double *values = array_create(count, sizeof *values);
    if (values == NULL)
        return error_memory(err, count * sizeof *values, "differences of heights");
    struct room room = {(double)INFINITY, values, values + most, values + 2 * most};
    out->x = lines_seam(grid, z, 0, &room);
    out->y = grid_is_profile(grid) ? 0 : lines_seam(grid, z, 1, &room);
    free(values);
    return 0;
}
