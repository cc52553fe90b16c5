#include "core/map/preparation/despike.h"
#include "core/statistics/measured_map.h"
#include "core/vectors.h"
#include <gsl/gsl_statistics.h>
#include <math.h>
#include <stdlib.h>

enum { NEIGHBOURS_MOST = 8, PROFILE_REACH = 3 };
/* 1/G^-1(3/4): a standard deviation over the median of the sizes of Gaussian values. */
static const double DEVIATION = 1.4826022185056018;

/* Sorts a few values, by insertion. */
static void sort_few(double *values, size_t count) {
    for (size_t a = 1; a < count; a++) {
        const double value = values[a];
        size_t b = a;
        for (; b > 0 && values[b - 1] > value; b--)
            values[b] = values[b - 1];
        values[b] = value;
    }
}

static double median_of_few(double *values, size_t count) {
    sort_few(values, count);
    return (values[(count - 1) / 2] + values[count / 2]) / 2;
}

static void take(double z, double *values, size_t *count) {
    if (!isnan(z))
        values[(*count)++] = z;
}

/* Returns how many neighbours of point i, j have heights, which it lists. */
static size_t neighbours_list(const struct grid *grid, const double *z, size_t i, size_t j,
                              double values[NEIGHBOURS_MOST]) {
    size_t count = 0;
    if (grid_is_profile(grid)) {
        const size_t first = i > PROFILE_REACH ? i - PROFILE_REACH : 0;
        for (size_t a = first; a <= i + PROFILE_REACH && a < grid->nx; a++)
            if (a != i)
                take(z[a], values, &count);
        return count;
    }
    for (size_t b = j > 0 ? j - 1 : 0; b <= j + 1 && b < grid->ny; b++)
        for (size_t a = i > 0 ? i - 1 : 0; a <= i + 1 && a < grid->nx; a++)
            if (a != i || b != j)
                take(z[b * grid->nx + a], values, &count);
    return count;
}

/* Returns the neighbours' deviation from their median; 0 of none. */
static double own_deviation(const struct grid *grid, const double *z, size_t i, size_t j) {
    double values[NEIGHBOURS_MOST];
    const size_t count = neighbours_list(grid, z, i, j, values);
    if (count == 0)
        return 0;
    const double median = median_of_few(values, count);
    for (size_t n = 0; n < count; n++)
        values[n] = fabs(values[n] - median);
    return DEVIATION * median_of_few(values, count);
}

/* Lines through a point: along both axes and both diagonals. */
enum { LINES = 4, PREDICTIONS_MOST = 8, PREDICTIONS_MANY = 4 };
static const int STEP_X[LINES] = {1, 0, 1, 1}, STEP_Y[LINES] = {0, 1, 1, -1};

/* Returns the height so many steps along a line; NaN beyond the sides. */
static double height_along(const struct grid *grid, const double *z, size_t i, size_t j, int line,
                           int steps) {
    const long x = (long)i + (long)steps * STEP_X[line], y = (long)j + (long)steps * STEP_Y[line];
    const bool inside = x >= 0 && y >= 0 && x < (long)grid->nx && y < (long)grid->ny;
    return inside ? z[(size_t)y * grid->nx + (size_t)x] : (double)NAN;
}

/* Returns how far a height is from the cubic through two on either side of it; NaN without them. */
static double off_both(const struct grid *grid, const double *z, size_t i, size_t j, int line) {
    const double near =
        height_along(grid, z, i, j, line, -1) + height_along(grid, z, i, j, line, 1);
    const double far = height_along(grid, z, i, j, line, -2) + height_along(grid, z, i, j, line, 2);
    return z[j * grid->nx + i] - (4 * near - far) / 6;
}

/* Returns how far it is from the parabola through three on one side. */
static double off_one(const struct grid *grid, const double *z, size_t i, size_t j, int line,
                      int side) {
    return z[j * grid->nx + i] - 3 * height_along(grid, z, i, j, line, side) +
           3 * height_along(grid, z, i, j, line, 2 * side) -
           height_along(grid, z, i, j, line, 3 * side);
}

/* Robust deviations of heights from predictions by both sides, and by one. */
struct deviations {
    double both, one;
};

/* Adds a distance in deviations; one that is 0 everywhere counts as 0. */
static void take_share(double off, double deviation, double *values, size_t *count) {
    if (!isnan(off))
        values[(*count)++] = deviation > 0 ? off / deviation : 0;
}

/* Lists how many deviations a height is from its predictions: those from both sides, and where
 * these are few those from one. */
static size_t predictions_list(const struct grid *grid, const double *z, size_t i, size_t j,
                               const struct deviations *by, double off[PREDICTIONS_MOST]) {
    const int lines = grid_is_profile(grid) ? 1 : LINES, axes = grid_is_profile(grid) ? 1 : 2;
    size_t count = 0;
    for (int line = 0; line < lines; line++)
        take_share(off_both(grid, z, i, j, line), by->both, off, &count);
    if (count == LINES)
        return count;
    for (int line = 0; line < axes; line++)
        for (int side = -1; side <= 1; side += 2)
            take_share(off_one(grid, z, i, j, line, side), by->one, off, &count);
    return count;
}

/* Returns how many deviations a height is from all predictions, on one side of them, but the
 * nearest where there are many; 0 with few. */
static double distance_at(const struct grid *grid, const double *z, size_t i, size_t j,
                          const struct deviations *by) {
    double off[PREDICTIONS_MOST];
    const size_t count = isnan(z[j * grid->nx + i]) ? 0 : predictions_list(grid, z, i, j, by, off);
    const size_t left_out = count >= PREDICTIONS_MANY ? 1 : 0;
    if (count < 2)
        return 0;
    sort_few(off, count);
    return fmax(fmax(off[left_out], -off[count - 1 - left_out]), 0);
}

/* So many heights say what the deviation is: of larger maps it is that of some rows. */
enum { SAMPLE = 1 << 18 };

/* Returns the robust deviation of heights from their predictions along an axis, from one side or
 * both; of maps that are mostly level its root mean square. room: points. */
static double deviation_along(const struct grid *grid, const double *z, int line, bool one,
                              double *room) {
    struct sum squares = {0};
    size_t count = 0;
    const size_t sampled = grid_points(grid) / SAMPLE, rows = sampled > 1 ? sampled : 1;
    const size_t every = rows < grid->ny ? rows : grid->ny;
    for (size_t j = every / 2; j < grid->ny; j += every)
        for (size_t i = 0; i < grid->nx; i++)
            take(fabs(one ? off_one(grid, z, i, j, line, 1) : off_both(grid, z, i, j, line)), room,
                 &count);
    if (count == 0)
        return 0;
    for (size_t n = 0; n < count; n++)
        sum_add(&squares, room[n] * room[n]);
    static const double ROUNDING = 1e-9;
    const double deviation = DEVIATION * gsl_stats_median(room, 1, count);
    const double rms = sqrt(sum_value(&squares) / (double)count);
    return deviation > ROUNDING * rms ? deviation : rms;
}

/* The root mean square of those along both axes. */
static double deviation_measure(const struct grid *grid, const double *z, bool one, double *room) {
    const double along_x = deviation_along(grid, z, 0, one, room);
    const double along_y = grid_is_profile(grid) ? along_x : deviation_along(grid, z, 1, one, room);
    return sqrt((along_x * along_x + along_y * along_y) / 2);
}

/* --- which points are looked at --- */

/* Of n points of a row, fills 0 where the predictions from both sides along the axes are no farther
 * than `most`: then no distance is, as at most two others remain. A plain loop, so that the
 * compiler makes vectors of it. */
WIDE_VECTORS static void suspects_fill(const double *restrict row, size_t nx, size_t n, double most,
                                       double *restrict suspect) {
    const double *up = row - nx, *down = row + nx, *top = up - nx, *bottom = down + nx;
    const double *left = row - 1, *right = row + 1, *first = row - 2, *last = row + 2;
    for (size_t i = 0; i < n; i++) {
        double x = row[i] - (4 * (left[i] + right[i]) - (first[i] + last[i])) / 6;
        double y = row[i] - (4 * (up[i] + down[i]) - (top[i] + bottom[i])) / 6;
        suspect[i] = (fabs(x) <= most ? 0. : 1.) + (fabs(y) <= most ? 0. : 1.);
    }
}

enum { TOGETHER = 64, SIDE = 2 };

/* Whether a point has two on all sides. */
static bool is_inside(const struct grid *grid, size_t i, size_t j) {
    return i >= SIDE && i + SIDE < grid->nx && j >= SIDE && j + SIDE < grid->ny;
}

/* As many deviations of the neighbours count for one of the map: theirs hold slopes, too. */
static const double OWN = 0.5;

/* Returns how many deviations a height is off, of the map or more of its neighbours. */
static double distance_of(const struct grid *grid, const double *z, size_t i, size_t j, double most,
                          const struct deviations *by) {
    double found = distance_at(grid, z, i, j, by);
    if (found > most) {
        const double own = OWN * own_deviation(grid, z, i, j);
        const struct deviations least = {fmax(by->both, own), fmax(by->one, own)};
        found = distance_at(grid, z, i, j, &least);
    }
    return found;
}

/* Fills the distances of a row; 0 of those that are no farther than `most` at first sight. */
static void row_measure(const struct grid *grid, const double *z, size_t j, double most,
                        const struct deviations *by, double *distance) {
    static const double ROUNDING = 1e-9;
    const size_t nx = grid->nx;
    for (size_t i = 0; i < nx;) {
        double suspect[TOGETHER] = {1};
        bool inside = is_inside(grid, i, j);
        size_t n = inside ? nx - SIDE - i < TOGETHER ? nx - SIDE - i : TOGETHER : 1;
        if (inside)
            suspects_fill(z + j * nx + i, nx, n, (1 - ROUNDING) * most * by->both, suspect);
        for (size_t k = 0; k < n; k++)
            distance[i + k] = suspect[k] > 0 ? distance_of(grid, z, i + k, j, most, by) : 0;
        i += n;
    }
}

int despike(const struct grid *grid, double *z, double most, struct despike_result *out,
            struct error *err) {
    const size_t points = grid_points(grid);
    *out = (struct despike_result){0};
    double *distance = array_create(points, sizeof *distance);
    if (distance == NULL)
        return error_memory(err, points * sizeof *distance, "distances from neighbours");
    const struct deviations by = {deviation_measure(grid, z, false, distance),
                                  deviation_measure(grid, z, true, distance)};
    out->deviation = by.both;
    for (size_t j = 0; j < grid->ny; j++)
        row_measure(grid, z, j, most, &by, distance + j * grid->nx);
    for (size_t point = 0; point < points; point++)
        if (distance[point] > most) {
            z[point] = (double)NAN;
            out->spikes++;
            out->largest = fmax(out->largest, distance[point]);
        }
    free(distance);
    return 0;
}
