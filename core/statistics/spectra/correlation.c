#include "core/statistics/spectra/correlation.h"
#include "core/statistics/heights/roughness.h"
#include "core/surface/transform.h"
#include <stdlib.h>

enum { DIRECTIONS = 360 }; /* of a half turn */

struct correlation {
    struct grid grid;   /* of the map */
    struct grid padded; /* of the values, which are periodic on it */
    long reach_x, reach_y;
    size_t rows; /* of lags y >= 0 that are needed; a lag and its negative have the same value */
    /* Owned, rows x padded.nx; lag (x, y) at its index modulo the padded grid. */
    double *values;
};

/* Lags up to the reach do not meet their own other end in the padded grid. */
static void shape_fill(struct correlation *c, const struct measured_map *map) {
    c->grid = c->padded = *map->grid;
    c->reach_x = (long)(c->grid.nx / 2);
    c->reach_y = grid_is_profile(&c->grid) ? 0 : (long)(c->grid.ny / 2);
    if (map->boundary == BOUNDARY_OPEN) {
        c->padded.nx = transform_fast_count(c->grid.nx + (size_t)c->reach_x + 2);
        if (c->reach_y > 0)
            c->padded.ny = transform_fast_count(c->grid.ny + (size_t)c->reach_y + 2);
    }
    size_t half = c->padded.ny / 2, most = (size_t)c->reach_y + 2;
    c->rows = (half < most ? half : most) + 1;
}

/* What is multiplied: heights about the mean, or 1 where there is one; 0 in holes and beside. */
struct field {
    const struct measured_map *map;
    double mean;
    bool ones;
};

/* Fills rows j .. j + count - 1 of the padded grid. */
static void rows_fill(const struct correlation *c, const struct field *field, size_t j,
                      size_t count, double *rows) {
    for (size_t point = 0; point < count * c->padded.nx; point++)
        rows[point] = 0;
    for (size_t row = 0; row < count && j + row < c->grid.ny; row++)
        for (size_t i = 0; i < c->grid.nx; i++) {
            double z = field->map->z[(j + row) * c->grid.nx + i];
            if (!isnan(z))
                rows[row * c->padded.nx + i] = field->ones ? 1 : z - field->mean;
        }
}

static int field_transform(const struct correlation *c, const struct field *field,
                           struct transform *transform, struct error *err) {
    size_t count = TRANSFORM_ROWS * c->padded.nx;
    double *rows = array_create(count, sizeof *rows);
    if (rows == NULL)
        return error_memory(err, count * sizeof *rows, "rows of an autocorrelation");
    for (size_t j = 0; j < c->padded.ny; j += TRANSFORM_ROWS) {
        size_t some = c->padded.ny - j < TRANSFORM_ROWS ? c->padded.ny - j : TRANSFORM_ROWS;
        rows_fill(c, field, j, some, rows);
        transform_forward_rows(transform, j, some, rows);
    }
    transform_forward_columns(transform);
    free(rows);
    return 0;
}

/* Fills out, rows x padded.nx, with the sum over pairs at each lag of field times field. */
static int sums_of_pairs(const struct correlation *c, const struct field *field, double *out,
                         struct error *err) {
    const struct grid *padded = &c->padded;
    struct transform *transform = NULL;
    size_t modes = (padded->nx / 2 + 1) * padded->ny;
    int status = transform_create(&transform, padded, padded->nx / 2, padded->ny / 2, err);
    if (status == 0)
        status = field_transform(c, field, transform, err);
    if (status == 0) {
        double complex *mode = transform_spectrum(transform);
        double points = (double)grid_points(padded);
        for (size_t k = 0; k < modes; k++)
            mode[k] = points * (creal(mode[k]) * creal(mode[k]) + cimag(mode[k]) * cimag(mode[k]));
        transform_inverse_columns(transform);
        transform_inverse_rows(transform, 0, c->rows, out);
    }
    transform_destroy(&transform);
    return status;
}

static double mean_of(const struct measured_map *map, size_t *holes) {
    struct average mean = {0};
    for (size_t point = 0; point < grid_points(map->grid); point++)
        average_add(&mean, map->z[point]);
    *holes = grid_points(map->grid) - mean.count;
    return average_value(&mean);
}

/* Returns how many pairs of points of a side are a lag apart. */
static double pairs_of(size_t n, size_t lag, size_t padded) {
    size_t apart = lag <= padded / 2 ? lag : padded - lag;
    return padded == n ? (double)n : apart < n ? (double)(n - apart) : 0;
}

/* Divides the sums of products by the number of pairs: `counts` where there are holes, else NULL.
 */
static void sums_divide(struct correlation *c, const double *counts) {
    double origin = 0;
    for (size_t j = 0; j < c->rows; j++)
        for (size_t i = 0; i < c->padded.nx; i++) {
            size_t at = j * c->padded.nx + i;
            double pairs = counts != NULL ? rint(counts[at])
                                          : pairs_of(c->grid.nx, i, c->padded.nx) *
                                                pairs_of(c->grid.ny, j, c->padded.ny);
            double product = pairs > 0 ? c->values[at] / pairs : (double)NAN;
            origin = at == 0 ? product : origin;
            c->values[at] = product / origin;
        }
}

static int values_fill(struct correlation *c, const struct measured_map *map, struct error *err) {
    size_t points = c->rows * c->padded.nx, holes;
    double mean = mean_of(map, &holes), *counts = NULL;
    c->values = array_create(points, sizeof *c->values);
    if (holes > 0)
        counts = array_create(points, sizeof *counts);
    if (c->values == NULL || (holes > 0 && counts == NULL)) {
        free(counts);
        return error_memory(err, points * sizeof *counts, "an autocorrelation");
    }
    int status = sums_of_pairs(c, &(struct field){map, mean, false}, c->values, err);
    if (status == 0 && holes > 0)
        status = sums_of_pairs(c, &(struct field){map, mean, true}, counts, err);
    if (status == 0)
        sums_divide(c, counts);
    free(counts);
    return status;
}

int correlation_create(struct correlation **out, const struct measured_map *map,
                       struct error *err) {
    struct correlation *c = array_create(1, sizeof *c);
    if (c == NULL)
        return error_memory(err, sizeof *c, "an autocorrelation");
    shape_fill(c, map);
    int status = values_fill(c, map, err);
    if (status != 0) {
        correlation_destroy(&c);
        return status;
    }
    *out = c;
    return 0;
}

void correlation_destroy(struct correlation **correlation) {
    if (*correlation == NULL)
        return;
    free((*correlation)->values);
    free(*correlation);
    *correlation = NULL;
}

/* Returns the index of a lag, at most a few points outside, on the padded grid of n points. */
static size_t inside(long lag, long n) {
    while (lag < 0)
        lag += n;
    while (lag >= n)
        lag -= n;
    return (size_t)lag;
}

/* Returns the row of the lag y, or that of -y, in which x has the other sign. */
static const double *row_of(const struct correlation *c, long y, bool *mirrored) {
    const size_t ny = c->padded.ny, at = inside(y, (long)ny);
    *mirrored = 2 * at > ny;
    return c->values + (*mirrored ? ny - at : at) * c->padded.nx;
}

static double value_at(const struct correlation *c, long x, long y) {
    bool mirrored;
    const double *row = row_of(c, y, &mirrored);
    return row[inside(mirrored ? -x : x, (long)c->padded.nx)];
}

/* Weights of the points -1, 0, 1, 2 at t in [0, 1], for a cubic with the slopes of its neighbours.
 */
static void cubic_fill(double t, double *weight) {
    weight[0] = t * (t * (2 - t) - 1) / 2;
    weight[1] = (t * t * (3 * t - 5) + 2) / 2;
    weight[2] = t * (t * (4 - 3 * t) + 1) / 2;
    weight[3] = t * t * (t - 1) / 2;
}

double correlation_at(const struct correlation *c, double x, double y) {
    bool profile = c->reach_y == 0;
    if (!(fabs(x) <= (double)c->reach_x && fabs(y) <= (double)c->reach_y))
        return (double)NAN;
    long i = (long)floor(x), j = (long)floor(y);
    double weight_x[4], weight_y[4] = {0, 1, 0, 0}, value = 0;
    size_t column[4], opposite[4];
    for (long a = 0; a < 4; a++) {
        column[a] = inside(i + a - 1, (long)c->padded.nx);
        opposite[a] = inside(1 - i - a, (long)c->padded.nx);
    }
    cubic_fill(x - (double)i, weight_x);
    if (!profile)
        cubic_fill(y - (double)j, weight_y);
    for (long b = profile ? 1 : 0; b < (profile ? 2 : 4); b++) {
        bool mirrored;
        const double *row = row_of(c, j + b - 1, &mirrored);
        for (long a = 0; a < 4; a++) {
            const double weight = weight_y[b] * weight_x[a];
            if (weight != 0) /* a whole lag is known where its neighbours have no pair */
                value += weight * row[mirrored ? opposite[a] : column[a]];
        }
    }
    return value;
}

size_t correlation_rings(const struct correlation *c) {
    return (size_t)c->reach_x + 1;
}

void correlation_radial(const struct correlation *c, double *lag, double *mean) {
    size_t rings = correlation_rings(c);
    double dx = grid_dx(&c->grid), ratio = c->reach_y > 0 ? grid_dy(&c->grid) / dx : 0;
    for (size_t r = 0; r < rings; r++)
        lag[r] = mean[r] = 0; /* lag: first the number of values */
    for (long y = -c->reach_y; y <= c->reach_y; y++)
        for (long x = 0; x <= c->reach_x; x++) {
            size_t r = ring_of((double)x, (double)y * ratio);
            double value = value_at(c, x, y), weight = x > 0 ? 2 : 1;
            if (r >= rings || isnan(value))
                continue;
            lag[r] += weight;
            mean[r] += weight * value;
        }
    for (size_t r = 0; r < rings; r++) {
        mean[r] = lag[r] > 0 ? mean[r] / lag[r] : (double)NAN;
        lag[r] = (double)r * dx;
    }
}

/* Returns the length of steps in a direction: half the smaller spacing, but where the spacings are
 * far apart no more than eight steps for each point within reach, since most directions run along
 * the wider one. */
static double step_along(const struct correlation *c, double along_x, double along_y) {
    double dx = grid_dx(&c->grid), dy = c->reach_y > 0 ? grid_dy(&c->grid) : dx;
    double farthest = (double)c->reach_x / fabs(along_x);
    if (c->reach_y > 0)
        farthest = fmin(farthest, (double)c->reach_y / fabs(along_y));
    return fmax(fmin(dx, dy) / 2, farthest / (8 * (double)(c->reach_x + c->reach_y)));
}

/* Returns the first lag in a direction where the correlation is at the level; NaN where there is
 * none up to half a side. */
static double first_crossing(const struct correlation *c, double angle, double level) {
    double along_x = cos(angle) / grid_dx(&c->grid);
    double along_y = c->reach_y > 0 ? sin(angle) / grid_dy(&c->grid) : 0;
    double before = 1, step = step_along(c, along_x, along_y);
    for (size_t n = 1;; n++) {
        double length = (double)n * step;
        double value = correlation_at(c, length * along_x, length * along_y);
        if (isnan(value))
            return (double)NAN;
        if (value <= level)
            return length - step * (level - value) / (before - value);
        before = value;
    }
}

void correlation_lengths(const struct correlation *c, double level, double *shortest,
                         double *longest) {
    size_t directions = c->reach_y > 0 ? DIRECTIONS : 1;
    *shortest = (double)NAN;
    *longest = 0;
    for (size_t n = 0; n < directions; n++) {
        double length = first_crossing(c, M_PI * (double)n / DIRECTIONS, level);
        if (!isnan(length) && !(length >= *shortest))
            *shortest = length;
        *longest = length > *longest || isnan(length) ? length : *longest;
    }
}
