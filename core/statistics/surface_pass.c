#include "core/statistics/surface_pass.h"
#include "core/sum.h"
#include "core/vectors.h"
#include <string.h>

/* Points of a strip: 256 KiB, which a second level of cache holds. */
enum { STRIP_POINTS = 32768, LANES = 64 };

/* Sums of one row in interleaved parts, and the extremes so far. */
struct row_lanes {
    double third[LANES], fourth[LANES], lowest[LANES], highest[LANES];
};

static inline double lesser(double a, double b) {
    return a < b ? a : b;
}
static inline double greater(double a, double b) {
    return a > b ? a : b;
}

/* Adds n heights to the first n lanes. */
WIDE_VECTORS static void lanes_add(struct row_lanes *restrict lanes, const double *restrict h,
                                   size_t n) {
    for (size_t l = 0; l < n; l++) {
        double square = h[l] * h[l];
        lanes->third[l] += square * h[l];
        lanes->fourth[l] += square * square;
        lanes->lowest[l] = lesser(h[l], lanes->lowest[l]);
        lanes->highest[l] = greater(h[l], lanes->highest[l]);
    }
}

static void row_add(const double *row, size_t nx, struct row_lanes *lanes) {
    for (size_t i = 0; i < nx; i += LANES)
        lanes_add(lanes, row + i, nx - i < LANES ? nx - i : LANES);
}

/* Sums by halves, which loses less than one after the other. */
static double lanes_total(const double *lanes) {
    double half[LANES];
    memcpy(half, lanes, sizeof half);
    for (size_t n = LANES / 2; n > 0; n /= 2)
        for (size_t l = 0; l < n; l++)
            half[l] += half[l + n];
    return half[0];
}

struct totals {
    struct sum third, fourth;
    struct row_lanes lanes;
};

static void rows_add(struct totals *totals, size_t nx, size_t rows, const double *z) {
    struct row_lanes *lanes = &totals->lanes;
    for (size_t j = 0; j < rows; j++) {
        for (size_t l = 0; l < LANES; l++)
            lanes->third[l] = lanes->fourth[l] = 0;
        row_add(z + j * nx, nx, lanes);
        sum_add(&totals->third, lanes_total(lanes->third));
        sum_add(&totals->fourth, lanes_total(lanes->fourth));
    }
}

static void sums_fill(const struct totals *totals, size_t points, struct height_sums *out) {
    *out = (struct height_sums){.third = sum_value(&totals->third) / (double)points,
                                .fourth = sum_value(&totals->fourth) / (double)points,
                                .lowest = totals->lanes.lowest[0],
                                .highest = totals->lanes.highest[0]};
    for (size_t l = 1; l < LANES; l++) {
        out->lowest = fmin(out->lowest, totals->lanes.lowest[l]);
        out->highest = fmax(out->highest, totals->lanes.highest[l]);
    }
}

int surface_pass_run(const struct surface_pass *pass, const struct grid *grid, const double *z,
                     struct error *err) {
    size_t nx = grid->nx, most = STRIP_POINTS / nx > 0 ? STRIP_POINTS / nx : 1;
    struct totals totals = {0};
    int status = 0;
    for (size_t l = 0; l < LANES; l++)
        totals.lanes.lowest[l] = totals.lanes.highest[l] = z[0];
    pass->summits->count = pass->pits->count = 0;
    for (size_t first = 0; first < grid->ny && status == 0; first += most) {
        size_t rows = grid->ny - first < most ? grid->ny - first : most;
        const double *strip = z + first * nx;
        if (pass->bins != NULL)
            histogram_add(pass->bins, rows * nx, strip, pass->scale, pass->counts);
        if (pass->sums != NULL)
            rows_add(&totals, nx, rows, strip);
        status = extremes_find(pass->finder, z, first, rows, pass->summits, pass->pits, err);
    }
    if (pass->sums != NULL)
        sums_fill(&totals, grid_points(grid), pass->sums);
    return status;
}
