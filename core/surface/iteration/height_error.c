#include "core/surface/iteration/height_error.h"
#include "core/surface/transform.h"
#include "core/vectors.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Factor of the width of bins (Scott 1979), rounded as there and as in the reference. */
static const double SCOTT = 3.49;

struct height_error {
    const struct modes *modes;
    struct transform *whole; /* the whole half spectrum; NULL when the band fills it */
    double power;            /* sum of the powers of all modes, in the caller's unit */
    double mean_amplitude;   /* mean over the non-null modes of sqrt(power/sum) */
    size_t bins_most;
    /* number of bins; the first and the last one count everything outside */
    size_t bins;
    double first_edge, width; /* lower edge of bin 1 */
    uint32_t *target;         /* counts of z_h */
    uint32_t *count;          /* counts of z_s */
    double weights[3];        /* of eps_h, eps_s and eps_s0 */
};

/* Returns an upper bound of the number of bins: n values of standard deviation 1 lie within sqrt(n)
 * of their mean, and an edge may be one width away. */
static size_t bins_for(size_t points) {
    double n = (double)points;
    return (size_t)(2 * sqrt(n) * cbrt(n) / SCOTT) + 8;
}

static double mode_weight(const struct grid *grid, size_t mx) {
    return mx == 0 || 2 * mx == grid->nx ? 1 : 2;
}

/* Returns the power of the stored mode (mx, row) of a half spectrum, 0 outside the band. */
static double row_power(const struct modes *modes, size_t mx, size_t row) {
    size_t ny = modes->grid.ny;
    if (mx > modes->mode_x)
        return 0;
    if (row <= modes->mode_y)
        return modes_power(modes, mx, (long)row);
    return ny - row <= modes->mode_y ? modes_power(modes, mx, -(long)(ny - row)) : 0;
}

static void amplitudes_sum(struct height_error *e) {
    const struct modes *modes = e->modes;
    struct moments moments;
    modes_moments(modes, &moments);
    e->power = moments.m00;
    double amplitudes = 0;
    for (size_t mx = 0; mx <= modes->mode_x; mx++)
        for (size_t row = 0; row < modes->grid.ny; row++)
            amplitudes +=
                mode_weight(&modes->grid, mx) * sqrt(row_power(modes, mx, row) / e->power);
    e->mean_amplitude = amplitudes / (double)modes->count;
}

int height_error_create(struct height_error **out, const struct modes *modes, struct error *err) {
    const struct grid *grid = &modes->grid;
    struct height_error *e = array_create(1, sizeof *e);
    if (e == NULL)
        return error_memory(err, sizeof *e, "errors of heights");
    e->modes = modes;
    e->bins_most = bins_for(grid_points(grid));
    e->weights[0] = e->weights[1] = e->weights[2] = 1;
    e->target = array_create(e->bins_most, sizeof *e->target);
    e->count = array_create(e->bins_most, sizeof *e->count);
    int status = 0;
    if (e->target == NULL || e->count == NULL)
        status = error_memory(err, 2 * e->bins_most * sizeof *e->count, "height histograms");
    if (status == 0 && (modes->mode_x < grid->nx / 2 || modes->mode_y < grid->ny / 2))
        status = transform_create(&e->whole, grid, grid->nx / 2, grid->ny / 2, err);
    if (status != 0) {
        height_error_destroy(&e);
        return status;
    }
    *out = e;
    return 0;
}

void height_error_destroy(struct height_error **height_error) {
    struct height_error *e = *height_error;
    if (e == NULL)
        return;
    transform_destroy(&e->whole);
    free(e->target);
    free(e->count);
    free(e);
    *height_error = NULL;
}

double height_error_bytes(const struct grid *grid) {
    return transform_bytes(grid, grid->nx / 2) +
           2.0 * sizeof(uint32_t) * (double)bins_for(grid_points(grid));
}

enum { TOGETHER = 64 };

/* Bins of n heights, of which the first has number 0. */
WIDE_VECTORS static void bins_fill(size_t n, const double *restrict z, double origin, double scale,
                                   double last, int32_t *restrict bins) {
    for (size_t a = 0; a < n; a++) {
        double bin = (z[a] - origin) * scale;
        bin = bin > 0 ? bin : 0;
        bins[a] = (int32_t)(bin < last ? bin : last);
    }
}

static void histogram_add(const struct height_error *e, size_t n, const double *z,
                          uint32_t *count) {
    double origin = e->first_edge - e->width;
    for (size_t i = 0; i < n; i += TOGETHER) {
        size_t some = n - i < TOGETHER ? n - i : TOGETHER;
        int32_t bins[TOGETHER];
        bins_fill(some, z + i, origin, 1 / e->width, (double)(e->bins - 1), bins);
        for (size_t a = 0; a < some; a++)
            count[bins[a]]++;
    }
}

static void histogram_count(const struct height_error *e, const double *z, uint32_t *count) {
    memset(count, 0, e->bins * sizeof *count);
    histogram_add(e, grid_points(&e->modes->grid), z, count);
}

void height_error_start(struct height_error *e, const struct height_moments *moments,
                        const double *sorted) {
    size_t n = grid_points(&e->modes->grid);
    amplitudes_sum(e);
    e->width = SCOTT / cbrt((double)n);
    double edge = isfinite(moments->highest)  ? moments->highest
                  : isfinite(moments->lowest) ? moments->lowest
                                              : 0;
    double below = ceil((edge - sorted[0]) / e->width);
    double above = ceil((sorted[n - 1] - edge) / e->width);
    e->first_edge = edge - below * e->width;
    double bins = fmin(fmax(below + above, 1) + 2, (double)e->bins_most);
    e->bins = (size_t)bins;
    histogram_count(e, sorted, e->target);
}

void height_error_heights_start(struct height_error *e) {
    memset(e->count, 0, e->bins * sizeof *e->count);
}

void height_error_heights_add(struct height_error *e, size_t n, const double *z_s) {
    histogram_add(e, n, z_s, e->count);
}

double height_error_heights(const struct height_error *e) {
    uint64_t difference = 0;
    for (size_t b = 0; b < e->bins; b++)
        difference +=
            e->count[b] > e->target[b] ? e->count[b] - e->target[b] : e->target[b] - e->count[b];
    return (double)difference / (double)grid_points(&e->modes->grid);
}

static double squared_modulus(double complex z) {
    return creal(z) * creal(z) + cimag(z) * cimag(z);
}

/* Computes eps_s of F5.2 over the non-null modes. Returns the power of z_h in them. */
static double band_errors(const struct height_error *e, const double complex *spectrum,
                          struct surface_report *report) {
    const struct modes *modes = e->modes;
    size_t ny = modes->grid.ny;
    double power = 0, by_power = 0, by_amplitude = 0;
    for (size_t mx = 0; mx <= modes->mode_x; mx++) {
        double weight = mode_weight(&modes->grid, mx);
        for (size_t row = 0; row < ny; row++) {
            double wanted = row_power(modes, mx, row) / e->power;
            if (!(wanted > 0))
                continue;
            double had = squared_modulus(spectrum[mx * ny + row]);
            double ratio = had / wanted;
            power += weight * had;
            by_power += weight * (ratio - 1) * (ratio - 1);
            by_amplitude += weight * (sqrt(ratio) - 1) * (sqrt(ratio) - 1);
        }
    }
    report->eps_s = sqrt(by_power / (double)modes->count);
    report->eps_s_amplitude = sqrt(by_amplitude / (double)modes->count);
    return power;
}

/* Returns the sum over the null modes of the squared powers of z_h. */
static double null_squares(const struct height_error *e, const double *z_h,
                           const double complex *spectrum) {
    const struct modes *modes = e->modes;
    const struct grid *grid = &modes->grid;
    if (e->whole != NULL) {
        transform_forward(e->whole, z_h);
        spectrum = transform_spectrum(e->whole);
    }
    double sum = 0;
    for (size_t mx = 0; mx <= grid->nx / 2; mx++) {
        double column = 0;
        for (size_t row = 0; row < grid->ny; row++) {
            double had = squared_modulus(spectrum[mx * grid->ny + row]);
            column += row_power(modes, mx, row) > 0 ? 0 : had * had;
        }
        sum += mode_weight(grid, mx) * column;
    }
    return sum;
}

double height_error_measure(struct height_error *e, const double *z_s, const double *z_h,
                            const double complex *spectrum, bool complete,
                            struct surface_report *report) {
    double count = (double)e->modes->count;
    double null_count = (double)(grid_points(&e->modes->grid) - e->modes->count);
    histogram_count(e, z_s, e->count);
    report->eps_h = height_error_heights(e);
    double null_power = fmax(1 - band_errors(e, spectrum, report), 0);
    double worst = fmax(e->weights[0] * report->eps_h, e->weights[1] * report->eps_s);
    report->eps_s0 = report->eps_s0_amplitude = 0;
    if (null_count > 0) {
        report->eps_s0_amplitude = sqrt(null_power / null_count) / e->mean_amplitude;
        report->eps_s0 = null_power / sqrt(null_count) * count;
        if (complete || e->weights[2] * report->eps_s0 > worst)
            report->eps_s0 = sqrt(null_squares(e, z_h, spectrum) / null_count) * count;
    }
    return fmax(worst, e->weights[2] * report->eps_s0);
}

void height_error_weigh(struct height_error *e, const double weights[3]) {
    for (size_t a = 0; a < 3; a++)
        e->weights[a] = weights[a];
}
