#include "core/map/preparation/detrend.h"
#include "core/sum.h"
#include "core/vectors.h"
#include <math.h>
#include <string.h>

#define NAME(type, name, value) name,
const char *const DETREND_NAMES[] = {"none", RUGO_TRENDS(NAME)};
#undef NAME

enum { TERMS = 6, PASSES = 2, DEGREE_MOST = 2, ORDERS = 2 * DEGREE_MOST + 1 };

/* The terms are u^px v^py; u and v run from -1 to 1 over the points of the map. */
static const size_t POWER_X[TERMS] = {0, 1, 0, 2, 1, 0}, POWER_Y[TERMS] = {0, 0, 1, 0, 1, 2};

/* The terms that are fitted: all of the kind's degree, of a profile those without v. */
struct terms {
    size_t count, degree, list[TERMS];
};

static struct terms terms_of(const struct grid *grid, enum detrend kind) {
    struct terms terms = {0};
    if (kind == DETREND_NONE)
        return terms;
    size_t degree = kind == DETREND_MEAN ? 0 : kind == DETREND_PLANE ? 1 : DEGREE_MOST;
    terms.degree = degree;
    for (size_t t = 0; t < TERMS; t++)
        if (POWER_X[t] + POWER_Y[t] <= degree && (POWER_Y[t] == 0 || !grid_is_profile(grid)))
            terms.list[terms.count++] = t;
    return terms;
}

/* Returns the position of point i of n, between -1 and 1. */
static inline double position(size_t i, size_t n) {
    return n > 1 ? (2 * (double)i - (double)(n - 1)) / (double)(n - 1) : 0;
}

static double power(double u, size_t exponent) {
    return exponent == 0   ? 1
           : exponent == 1 ? u
           : exponent == 2 ? u * u
                           : u * u * power(u, exponent - 2);
}

/* Least squares as linear equations: matrix a = vector. */
struct equations {
    double matrix[TERMS][TERMS], vector[TERMS];
};

enum { TOGETHER = 128 }; /* points whose positions are computed at once */

WIDE_VECTORS static void positions_fill(size_t first, size_t count, size_t n, double *restrict u) {
    for (size_t l = 0; l < count; l++)
        u[l] = position(first + l, n);
}

/* Adds u^a up to twice the degree, and z u^a up to the degree, of points where there is a height.
 */
INLINE void powers_add(const double *z, const double *u, size_t count, size_t degree,
                       double *restrict powers, double *restrict heights) {
    for (size_t l = 0; l < count; l++) {
        double term = 1;
        if (isnan(z[l]))
            continue;
        for (size_t a = 0; a <= 2 * degree; a++, term *= u[l]) {
            powers[a] += term;
            if (a <= degree)
                heights[a] += z[l] * term;
        }
    }
}

/* The same of one row, from 0 on. */
static void row_powers(const double *row, size_t nx, size_t degree, double *powers,
                       double *heights) {
    double u[TOGETHER], sums[ORDERS] = {0}, products[DEGREE_MOST + 1] = {0};
    for (size_t i = 0; i < nx; i += TOGETHER) {
        const size_t count = nx - i < TOGETHER ? nx - i : TOGETHER;
        positions_fill(i, count, nx, u);
        if (degree == 0)
            powers_add(row + i, u, count, 0, sums, products);
        else if (degree == 1)
            powers_add(row + i, u, count, 1, sums, products);
        else
            powers_add(row + i, u, count, DEGREE_MOST, sums, products);
    }
    memcpy(powers, sums, sizeof sums);
    memcpy(heights, products, sizeof products);
}

static void equations_make(const struct grid *grid, const double *z, const struct terms *terms,
                           struct equations *out) {
    struct sum matrix[TERMS][TERMS] = {0}, vector[TERMS] = {0};
    double powers[ORDERS], heights[DEGREE_MOST + 1];
    for (size_t j = 0; j < grid->ny; j++) {
        double v = position(j, grid->ny);
        row_powers(z + j * grid->nx, grid->nx, terms->degree, powers, heights);
        for (size_t a = 0; a < terms->count; a++) {
            size_t s = terms->list[a];
            sum_add(&vector[a], heights[POWER_X[s]] * power(v, POWER_Y[s]));
            for (size_t b = 0; b < terms->count; b++) {
                size_t t = terms->list[b];
                sum_add(&matrix[a][b],
                        powers[POWER_X[s] + POWER_X[t]] * power(v, POWER_Y[s] + POWER_Y[t]));
            }
        }
    }
    for (size_t a = 0; a < terms->count; a++) {
        out->vector[a] = sum_value(&vector[a]);
        for (size_t b = 0; b < terms->count; b++)
            out->matrix[a][b] = sum_value(&matrix[a][b]);
    }
}

/* Eliminates in the matrix, without pivots as it is positive definite, and leaves the
 * solution in the vector. Returns false where the points do not determine the terms. */
static bool equations_solve(struct equations *e, size_t n) {
    double whole[TERMS]; /* the diagonal before */
    for (size_t a = 0; a < n; a++)
        whole[a] = e->matrix[a][a];
    for (size_t a = 0; a < n; a++) {
        if (!(e->matrix[a][a] > 1e-9 * whole[a]))
            return false;
        for (size_t b = a + 1; b < n; b++) {
            double factor = e->matrix[b][a] / e->matrix[a][a];
            for (size_t c = a; c < n; c++)
                e->matrix[b][c] -= factor * e->matrix[a][c];
            e->vector[b] -= factor * e->vector[a];
        }
    }
    for (size_t a = n; a-- > 0;) {
        for (size_t b = a + 1; b < n; b++)
            e->vector[a] -= e->matrix[a][b] * e->vector[b];
        e->vector[a] /= e->matrix[a][a];
    }
    return true;
}

WIDE_VECTORS static void row_subtract(size_t nx, double v, const double *restrict c,
                                      double *restrict row) {
    for (size_t i = 0; i < nx; i++) {
        double u = position(i, nx);
        row[i] -= c[0] + c[1] * u + c[2] * v + c[3] * u * u + c[4] * u * v + c[5] * v * v;
    }
}

int detrend(const struct grid *grid, double *z, enum detrend kind, struct trend *out,
            struct error *err) {
    const struct terms terms = terms_of(grid, kind);
    double total[TERMS] = {0};
    /* The second pass removes the rounding errors of a steep trend. */
    for (int pass = 0; pass < PASSES && terms.count > 0; pass++) {
        struct equations equations;
        double coefficient[TERMS] = {0};
        equations_make(grid, z, &terms, &equations);
        if (!equations_solve(&equations, terms.count))
            return error_set(err, ERROR_INPUT,
                             "the heights are too few, or too much in line, to fit %zu terms of a "
                             "trend",
                             terms.count);
        for (size_t a = 0; a < terms.count; a++)
            total[terms.list[a]] += coefficient[terms.list[a]] = equations.vector[a];
        for (size_t j = 0; j < grid->ny; j++)
            row_subtract(grid->nx, position(j, grid->ny), coefficient, z + j * grid->nx);
    }
    double half_x = grid->nx > 1 ? grid_dx(grid) * (double)(grid->nx - 1) / 2 : 1;
    double half_y = grid->ny > 1 ? grid_dy(grid) * (double)(grid->ny - 1) / 2 : 1;
    *out = (struct trend){.height = total[0],
                          .slope_x = total[1] / half_x,
                          .slope_y = total[2] / half_y,
                          .bend_xx = 2 * total[3] / (half_x * half_x),
                          .bend_xy = total[4] / (half_x * half_y),
                          .bend_yy = 2 * total[5] / (half_y * half_y)};
    return 0;
}
