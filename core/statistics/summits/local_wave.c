#include "core/statistics/summits/local_wave.h"
#include "core/vectors.h"
#include <stdlib.h>

/* 1/(a - b) at a - b + LOCAL_POINTS - 1; 0 of a = b. */
static const double INVERSE[2 * LOCAL_POINTS - 1] = {
    -1. / 15, -1. / 14, -1. / 13, -1. / 12, -1. / 11, -1. / 10, -1. / 9, -1. / 8,
    -1. / 7,  -1. / 6,  -1. / 5,  -1. / 4,  -1. / 3,  -1. / 2,  -1,      0,
    1,        1. / 2,   1. / 3,   1. / 4,   1. / 5,   1. / 6,   1. / 7,  1. / 8,
    1. / 9,   1. / 10,  1. / 11,  1. / 12,  1. / 13,  1. / 14,  1. / 15};

/* Multiplies the polynomials of all points by the factors that are 0 at point b, all but that of
 * point b itself. A plain loop, so that the compiler makes vectors of it. */
WIDE_VECTORS static void factors_multiply(double t, size_t b, struct local_basis *restrict basis) {
    const double *scales = INVERSE + LOCAL_POINTS - 1 - b;
    for (size_t a = 0; a < LOCAL_POINTS; a++) {
        double value = basis->value[a], slope = basis->slope[a], bend = basis->bend[a];
        double scale = scales[a], factor = scale * t;
        basis->bend[a] = a == b ? bend : bend * factor + 2 * scale * slope;
        basis->slope[a] = a == b ? slope : slope * factor + scale * value;
        basis->value[a] = a == b ? value : value * factor;
    }
}

void local_basis_at(double t, struct local_basis *basis) {
    for (size_t a = 0; a < LOCAL_POINTS; a++) {
        basis->value[a] = 1;
        basis->slope[a] = basis->bend[a] = 0;
    }
    for (size_t b = 0; b < LOCAL_POINTS; b++)
        factors_multiply(t - (double)((int)b + 1 - LOCAL_HALF), b, basis);
}

/* Weights of z[i + m] - z[i - m] in the first derivative, and of z[i + m] - 2 z[i] + z[i - m] in
 * the second, m = 1 .. LOCAL_HALF; [0] is unused. */
struct central {
    double slope[LOCAL_HALF + 1], bend[LOCAL_HALF + 1];
};

/* (n!)^2/((n - m)! (n + m)!) with alternating sign, over m and over m^2/2, n = LOCAL_HALF. */
static void central_fill(struct central *central) {
    double term = -1;
    for (int m = 1; m <= LOCAL_HALF; m++) {
        term *= -(double)(LOCAL_HALF - m + 1) / (LOCAL_HALF + m);
        central->slope[m] = term / m;
        central->bend[m] = 2 * term / ((double)m * m);
    }
}

/* The derivatives of one row. */
struct derivatives {
    double *x, *y, *xx, *xy, *yy; /* nx each, one allocation, held by x */
};

enum { TOGETHER = 64 };

/* Derives n points of a row, at most TOGETHER, each with LOCAL_HALF others to both sides. */
WIDE_VECTORS static void points_derive(const double *row, size_t n, const struct central *central,
                                       double dx, double *restrict slope, double *restrict bend) {
    for (size_t i = 0; i < n; i++)
        slope[i] = bend[i] = 0;
    for (size_t m = 1; m <= LOCAL_HALF; m++) {
        const double *left = row - m, *right = row + m;
        double first = central->slope[m], second = central->bend[m];
        for (size_t i = 0; i < n; i++) {
            slope[i] += first * (right[i] - left[i]);
            bend[i] += second * (right[i] - 2 * row[i] + left[i]);
        }
    }
    for (size_t i = 0; i < n; i++) {
        slope[i] /= dx;
        bend[i] /= dx * dx;
    }
}

static void derive_row(const double *row, size_t nx, const struct central *central, double dx,
                       double *slope, double *bend) {
    for (size_t i = 0; i < nx; i++)
        slope[i] = bend[i] = (double)NAN;
    for (size_t i = LOCAL_HALF; i + LOCAL_HALF < nx; i += TOGETHER) {
        size_t n = nx - LOCAL_HALF - i < TOGETHER ? nx - LOCAL_HALF - i : TOGETHER;
        points_derive(row + i, n, central, dx, slope + i, bend + i);
    }
}

/* Derives across rows; `row` is LOCAL_HALF rows or more from the first and the last. */
WIDE_VECTORS static void derive_across(const double *row, size_t nx, const struct central *central,
                                       double dy, double *restrict slope, double *restrict bend) {
    for (size_t i = 0; i < nx; i++)
        slope[i] = bend[i] = 0;
    for (size_t m = 1; m <= LOCAL_HALF; m++) {
        const double *up = row - m * nx, *down = row + m * nx;
        double first = central->slope[m], second = central->bend[m];
        for (size_t i = 0; i < nx; i++) {
            slope[i] += first * (down[i] - up[i]) / dy;
            bend[i] += second * (down[i] - 2 * row[i] + up[i]) / (dy * dy);
        }
    }
}

struct products {
    struct average m00, m20, m02, m11, m22, m40, m04, m31, m13, curvature;
};

static void row_add(const struct derivatives *d, size_t nx, struct products *sums) {
    for (size_t i = 0; i < nx; i++) {
        double x = d->x[i], y = d->y[i], xx = d->xx[i], xy = d->xy[i], yy = d->yy[i];
        if (isnan(x + y + xx + xy + yy))
            continue;
        average_add(&sums->m20, x * x);
        average_add(&sums->m02, y * y);
        average_add(&sums->m11, x * y);
        average_add(&sums->m40, xx * xx);
        average_add(&sums->m04, yy * yy);
        average_add(&sums->m22, xy * xy);
        average_add(&sums->m31, xx * xy);
        average_add(&sums->m13, yy * xy);
        average_add(&sums->curvature, (xx + yy) * (xx + yy));
    }
}

static void heights_add(const struct measured_map *map, struct products *sums) {
    struct average mean = {0};
    for (size_t point = 0; point < grid_points(map->grid); point++)
        average_add(&mean, map->z[point]);
    double middle = average_value(&mean);
    for (size_t point = 0; point < grid_points(map->grid); point++)
        average_add(&sums->m00, (map->z[point] - middle) * (map->z[point] - middle));
}

static void rows_add(const struct measured_map *map, struct derivatives *d, struct products *sums) {
    const struct grid *grid = map->grid;
    struct central central;
    size_t nx = grid->nx;
    central_fill(&central);
    if (grid_is_profile(grid)) {
        derive_row(map->z, nx, &central, grid_dx(grid), d->x, d->xx);
        row_add(d, nx, sums);
        return;
    }
    for (size_t j = LOCAL_HALF; j + LOCAL_HALF < grid->ny; j++) {
        const double *row = map->z + j * nx;
        derive_across(row, nx, &central, grid_dy(grid), d->y, d->yy);
        derive_row(d->y, nx, &central, grid_dx(grid), d->xy, d->x); /* x: not wanted yet */
        derive_row(row, nx, &central, grid_dx(grid), d->x, d->xx);
        row_add(d, nx, sums);
    }
}

static void moments_fill(const struct products *sums, bool profile, struct moments *out) {
    *out = (struct moments){.m00 = average_value(&sums->m00),
                            .m20 = average_value(&sums->m20),
                            .m40 = average_value(&sums->m40)};
    if (!profile) {
        out->m02 = average_value(&sums->m02);
        out->m11 = average_value(&sums->m11);
        out->m22 = average_value(&sums->m22);
        out->m04 = average_value(&sums->m04);
        out->m31 = average_value(&sums->m31);
        out->m13 = average_value(&sums->m13);
    }
    out->m0 = out->m00;
    out->m2 = profile ? out->m20 : (out->m20 + out->m02) / 2;
    out->m4 = profile ? out->m40 : (out->m40 + out->m04) / 2;
    out->nayak_alpha = out->m0 / out->m2 * (out->m4 / out->m2);
    out->rms_height = sqrt(out->m00);
    out->rms_slope = profile ? sqrt(out->m20) : sqrt(2 * out->m2);
    out->rms_curvature = sqrt(average_value(&sums->curvature)) / (profile ? 1 : 2);
}

int local_moments_measure(const struct measured_map *map, struct moments *out, struct error *err) {
    size_t nx = map->grid->nx;
    double *rows = array_create(nx, 5 * sizeof *rows);
    if (rows == NULL)
        return error_memory(err, nx * 5 * sizeof *rows, "derivatives of a row");
    struct derivatives d = {rows, rows + nx, rows + 2 * nx, rows + 3 * nx, rows + 4 * nx};
    struct products sums = {0};
    heights_add(map, &sums);
    rows_add(map, &d, &sums);
    moments_fill(&sums, grid_is_profile(map->grid), out);
    free(rows);
    return 0;
}
