#include "core/statistics/uncertainty/stationarity.h"
#include "core/statistics/uncertainty/isotropy.h"
#include "core/statistics/uncertainty/low_modes.h"
#include <gsl/gsl_cdf.h>
#include <math.h>

/* Parts of sub-areas: 8 x 8 of surfaces, 64 of profiles. */
enum { PARTS = 64 };
/* What a direction in the space of parts is of: what is left out (the mean and the trend), what
 * differs between sub-areas of the first division, of the second, and within these. */
enum { LEFT_OUT, BETWEEN, BETWEEN_FINER, WITHIN, CONTRASTS };

struct parts {
    size_t nx, ny;                          /* parts */
    size_t divisions[STATIONARY_DIVISIONS]; /* sub-areas along an axis */
    bool periodic;
    double width_x, width_y; /* of a part */
};

static struct parts parts_make(const struct measured_map *map) {
    const struct grid *grid = map->grid;
    bool profile = grid_is_profile(grid), periodic = map->boundary == BOUNDARY_PERIODIC;
    if (profile)
        return (struct parts){PARTS, 1, {4, 16}, periodic, grid->lx / PARTS, 1};
    return (struct parts){8, 8, {2, 4}, periodic, grid->lx / 8, grid->ly / 8};
}

/* An orthonormal basis, in the order of contrasts. */
struct basis {
    size_t count;
    double vector[PARTS][PARTS];
    int contrast[PARTS];
};

/* Adds what of a vector is at right angles to the basis, unless it is in its span. */
static void basis_add(struct basis *basis, const double *vector, int contrast) {
    double rest[PARTS], before = 0, size = 0;
    for (size_t p = 0; p < PARTS; p++) {
        rest[p] = vector[p];
        before += vector[p] * vector[p];
    }
    for (int pass = 0; pass < 2; pass++)
        for (size_t b = 0; b < basis->count; b++) {
            double along = 0;
            for (size_t p = 0; p < PARTS; p++)
                along += rest[p] * basis->vector[b][p];
            for (size_t p = 0; p < PARTS; p++)
                rest[p] -= along * basis->vector[b][p];
        }
    for (size_t p = 0; p < PARTS; p++)
        size += rest[p] * rest[p];
    if (!(size > 1e-9 * before))
        return;
    for (size_t p = 0; p < PARTS; p++)
        basis->vector[basis->count][p] = rest[p] / sqrt(size);
    basis->contrast[basis->count++] = contrast;
}

/* trend: whether tilts are left out. */
static void basis_fill(const struct parts *parts, bool trend, struct basis *out) {
    double ones[PARTS], x[PARTS], y[PARTS];
    out->count = 0;
    for (size_t p = 0; p < PARTS; p++) {
        ones[p] = 1;
        size_t row = p / parts->nx;
        x[p] = (double)(p % parts->nx) - (double)(parts->nx - 1) / 2;
        y[p] = (double)row - (double)(parts->ny - 1) / 2;
    }
    basis_add(out, ones, LEFT_OUT);
    if (trend)
        basis_add(out, x, LEFT_OUT);
    if (trend && parts->ny > 1)
        basis_add(out, y, LEFT_OUT);
    for (int d = 0; d < STATIONARY_DIVISIONS; d++) {
        size_t n = parts->divisions[d], rows = parts->ny > 1 ? n : 1;
        for (size_t area = 0; area < n * rows; area++) {
            double inside[PARTS];
            for (size_t p = 0; p < PARTS; p++)
                inside[p] = p % parts->nx * n / parts->nx == area % n &&
                                    p / parts->nx * rows / parts->ny == area / n
                                ? 1
                                : 0;
            basis_add(out, inside, BETWEEN + d);
        }
    }
    for (size_t p = 0; p < PARTS; p++) {
        double one[PARTS] = {0};
        one[p] = 1;
        basis_add(out, one, WITHIN);
    }
}

/* Mean squares of a field of parts, given by products of basis vectors: number, sum. */
struct squares {
    double count[CONTRASTS], sum[CONTRASTS];
};

static double squares_mean(const struct squares *s, int first, int last) {
    double count = 0, sum = 0;
    for (int c = first; c <= last; c++) {
        count += s->count[c];
        sum += s->sum[c];
    }
    return sum / count;
}

/* Returns the share of a lag, in widths, among pairs of points in two parts that are so many parts
 * apart. */
static double overlap(double lag, double apart) {
    return fmax(0, 1 - fabs(lag - apart));
}

/* Covariance of two parts. */
static double parts_covariance(const struct parts *parts, const struct correlation_field *field,
                               double apart_x, double apart_y) {
    double sum = 0;
    for (long b = 0; b < FIELD_SIDE; b++) {
        double y = (double)(b - FIELD_LAGS) * field->step / parts->width_y;
        double weight = parts->ny > 1 ? overlap(y, apart_y) : b == FIELD_LAGS ? 1 : 0;
        for (long a = 0; a < FIELD_SIDE && weight > 0; a++) {
            double x = (double)(a - FIELD_LAGS) * field->step / parts->width_x;
            sum += weight * overlap(x, apart_x) * field->value[b][a];
        }
    }
    return sum;
}

/* Returns the distance of two parts, in a map that repeats the lesser of the two around it. */
static size_t apart(size_t a, size_t b, size_t n, bool periodic) {
    size_t distance = a > b ? a - b : b - a;
    return periodic && 2 * distance > n ? n - distance : distance;
}

/* Mean squares, of any scale, that a field of this correlation has. */
static void squares_expected(const struct parts *parts, const struct basis *basis,
                             const struct correlation_field *field, struct squares *out) {
    double by_distance[PARTS], covariance[PARTS][PARTS];
    *out = (struct squares){0};
    for (size_t p = 0; p < PARTS; p++) {
        size_t row = p / parts->nx;
        by_distance[p] = parts_covariance(parts, field, (double)(p % parts->nx), (double)row);
    }
    for (size_t a = 0; a < PARTS; a++)
        for (size_t b = 0; b < PARTS; b++) {
            size_t x = apart(a % parts->nx, b % parts->nx, parts->nx, parts->periodic);
            size_t y = apart(a / parts->nx, b / parts->nx, parts->ny, parts->periodic);
            covariance[a][b] = by_distance[y * parts->nx + x];
        }
    for (size_t v = 0; v < basis->count; v++) {
        const double *vector = basis->vector[v];
        out->count[basis->contrast[v]]++;
        for (size_t a = 0; a < PARTS; a++)
            for (size_t b = 0; b < PARTS; b++)
                out->sum[basis->contrast[v]] += vector[a] * vector[b] * covariance[a][b];
    }
}

static void squares_found(const struct basis *basis, const double *values, struct squares *out) {
    *out = (struct squares){0};
    for (size_t v = 0; v < basis->count; v++) {
        double along = 0;
        for (size_t p = 0; p < PARTS; p++)
            along += basis->vector[v][p] * values[p];
        out->count[basis->contrast[v]]++;
        out->sum[basis->contrast[v]] += along * along;
    }
}

/* Of a division by number. */
static void spread_measure(const struct parts *parts, const struct squares *found,
                           const struct squares *expected, size_t division, struct spread *out) {
    int last = BETWEEN + (int)division;
    double areas = pow((double)parts->divisions[division], parts->ny > 1 ? 2 : 1), count = 0;
    double between = squares_mean(found, BETWEEN, last);
    double within = squares_mean(found, WITHIN, WITHIN);
    for (int c = BETWEEN; c <= last; c++)
        count += found->count[c];
    double ratio = squares_mean(expected, BETWEEN, last) / squares_mean(expected, WITHIN, WITHIN);
    within *= fmax(ratio, 1);
    out->found = sqrt(between * areas / PARTS);
    out->expected = sqrt(within * areas / PARTS);
    out->p_value = gsl_cdf_fdist_Q(between / within, count, found->count[WITHIN]);
}

/* Puts sums over the cells of the lattice, of `count` values in all, together to means over parts.
 */
static void parts_fill(const struct parts *parts, const struct low_modes *lattice,
                       const double *sums, double count, double *out) {
    for (size_t p = 0; p < PARTS; p++)
        out[p] = 0;
    for (size_t cy = 0; cy < lattice->cells_y; cy++)
        for (size_t cx = 0; cx < lattice->cells_x; cx++) {
            size_t p =
                cy * parts->ny / lattice->cells_y * parts->nx + cx * parts->nx / lattice->cells_x;
            out[p] += sums[cy * lattice->cells_x + cx] * PARTS / count;
        }
}

/* What each cell changes in the parameters, over their values. */
static void changes_fill(const struct cell_heights *h, const struct cell_differences *d,
                         size_t cells, double change[STATIONARY_PARAMETERS][LOW_CELLS_MOST],
                         double *count) {
    double s = h->rms, third = 0, slope = 0;
    count[STATIONARY_SLOPE] = 0;
    for (size_t cell = 0; cell < cells; cell++) {
        third += h->power[3][cell] / (h->count * pow(s, 3));
        slope += d->slope[cell];
        count[STATIONARY_SLOPE] += d->count[cell];
    }
    slope /= count[STATIONARY_SLOPE];
    for (size_t cell = 0; cell < cells; cell++) {
        double p0 = h->power[0][cell], p1 = h->power[1][cell] / s;
        double p2 = h->power[2][cell] / (s * s), p3 = h->power[3][cell] / pow(s, 3);
        change[STATIONARY_MEAN][cell] = p1;
        change[STATIONARY_RMS][cell] = (p2 - p0) / 2;
        change[STATIONARY_SKEWNESS][cell] = p3 - third * p0 - 3 * p1 - 1.5 * third * (p2 - p0);
        change[STATIONARY_SLOPE][cell] = (d->slope[cell] - slope * d->count[cell]) / (2 * slope);
    }
    count[STATIONARY_MEAN] = count[STATIONARY_RMS] = count[STATIONARY_SKEWNESS] = h->count;
}

void stationarity_measure(const struct measured_map *map, const struct cell_heights *heights,
                          const struct cell_differences *differences,
                          const struct low_modes *lattice, const struct correlation *correlation,
                          struct stationarity *out) {
    const struct parts parts = parts_make(map);
    double change[STATIONARY_PARAMETERS][LOW_CELLS_MOST], count[STATIONARY_PARAMETERS];
    double length = correlation_length(correlation);
    changes_fill(heights, differences, heights->cells, change, count);
    struct basis plain, tilted;
    basis_fill(&parts, false, &plain);
    basis_fill(&parts, !parts.periodic, &tilted);
    for (int q = 0; q < STATIONARY_PARAMETERS; q++) {
        const struct basis *basis = q == STATIONARY_MEAN ? &tilted : &plain;
        struct correlation_field field;
        struct squares found, expected;
        double values[PARTS];
        if (q == STATIONARY_SLOPE)
            correlation_field_slopes(correlation, map->grid, length,
                                     fmax(grid_dx(map->grid), length / 8), &field);
        else
            correlation_field_power(correlation, map->grid, length, q + 1, &field);
        parts_fill(&parts, lattice, change[q], count[q], values);
        squares_found(basis, values, &found);
        squares_expected(&parts, basis, &field, &expected);
        for (size_t d = 0; d < STATIONARY_DIVISIONS; d++)
            spread_measure(&parts, &found, &expected, d, &out->spread[d][q]);
    }
    for (size_t d = 0; d < STATIONARY_DIVISIONS; d++) {
        double p[STATIONARY_PARAMETERS];
        for (int q = 0; q < STATIONARY_PARAMETERS; q++)
            p[q] = out->spread[d][q].p_value;
        out->p_value[d] = least_p_value(p, STATIONARY_PARAMETERS);
    }
}
