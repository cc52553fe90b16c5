#include "core/map/preparation/scan_lines.h"
#include "core/map/preparation/detrend.h"
#include "core/statistics/measured_map.h"
#include <gsl/gsl_statistics.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A line of n heights, and as much room. */
struct line {
    size_t n;
    double *z, *room; /* owned by z */
};

static void subtract_median(struct line *line) {
    size_t count = 0;
    for (size_t i = 0; i < line->n; i++)
        if (!isnan(line->z[i]))
            line->room[count++] = line->z[i];
    if (count == 0)
        return;
    const double median = gsl_stats_median(line->room, 1, count);
    for (size_t i = 0; i < line->n; i++)
        line->z[i] -= median;
}

/* The polynomial of the highest degree that the heights determine. */
static void subtract_polynomial(const struct line *line, enum detrend kind) {
    const struct grid grid = {line->n, 1, (double)line->n, 1};
    struct error unused;
    struct trend trend;
    while (kind != DETREND_NONE && detrend(&grid, line->z, kind, &trend, &unused) != 0)
        kind--;
}

static void line_level(struct line *line, enum scan_lines kind) {
    static const enum detrend DEGREES[] = {DETREND_NONE, DETREND_MEAN, DETREND_NONE, DETREND_PLANE,
                                           DETREND_QUADRATIC};
    if (kind == SCAN_LINES_MEDIAN)
        subtract_median(line);
    else
        subtract_polynomial(line, DEGREES[kind]);
}

/* Sums of heights before, and of what is subtracted. */
struct changes {
    struct average height, square, change, change_square;
};

static void changes_add(struct changes *changes, double before, double after) {
    average_add(&changes->height, before);
    average_add(&changes->square, before * before);
    average_add(&changes->change, before - after);
    average_add(&changes->change_square, (before - after) * (before - after));
}

static double variance(const struct average *value, const struct average *square) {
    const double mean = average_value(value);
    return fmax(average_value(square) - mean * mean, 0);
}

int scan_lines_level(const struct grid *grid, double *z, enum scan_lines kind, enum scan_axis along,
                     struct scan_lines_result *out, struct error *err) {
    const bool rows = along == SCAN_ALONG_X;
    const size_t lines = rows ? grid->ny : grid->nx, step = rows ? 1 : grid->nx;
    struct line line = {.n = rows ? grid->nx : grid->ny};
    struct changes changes = {0};
    double base = 0; /* a height, which keeps the sums of squares free of a large mean */
    *out = (struct scan_lines_result){0};
    line.z = array_create(2 * line.n, sizeof *line.z);
    if (line.z == NULL)
        return error_memory(err, 2 * line.n * sizeof *line.z, "a scan line");
    line.room = line.z + line.n;
    for (size_t point = 0; point < grid_points(grid); point++)
        if (!isnan(z[point])) {
            base = z[point];
            break;
        }
    for (size_t l = 0; l < lines; l++) {
        double *first = z + (rows ? l * grid->nx : l);
        size_t heights = 0;
        for (size_t i = 0; i < line.n; i++)
            line.z[i] = first[i * step] - base;
        line_level(&line, kind);
        for (size_t i = 0; i < line.n; i++) {
            changes_add(&changes, first[i * step] - base, line.z[i]);
            heights += isnan(line.z[i]) ? 0 : 1;
            first[i * step] = line.z[i];
        }
        out->lines += heights > 0 ? 1 : 0;
    }
    const double all = variance(&changes.height, &changes.square);
    const double taken = variance(&changes.change, &changes.change_square);
    out->rms = sqrt(taken);
    out->share = all > 0 ? taken / all : (double)NAN;
    free(line.z);
    return 0;
}
