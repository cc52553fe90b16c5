#include "core/map/preparation/map_resample.h"
#include "core/error.h"
#include "core/surface/surface.h"
#include <gsl/gsl_sf_bessel.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* Interpolates a line of heights at other positions. */

static const double PI = 3.14159265358979323846;
/* The kernel for wider steps is a sine cardinal with a window of Kaiser (1974). The window leaves
 * 1e-4 of the amplitude beyond the edge, and extends REACH steps to either side. */
static const double BETA = 7.857, REACH = 20;
/* At this share of the highest wave number of the new points half of the amplitude is left. The
 * transition of the window, which is as wide as a quarter of that number, ends there. */
static const double CUT_OFF = 0.875;

struct line_resampler {
    size_t from, to;
    double step, origin; /* in points of the old line */
    size_t reach, taps;  /* of the kernel, in points; taps 0: a spline */
    double *weight;      /* owned, to x taps */
    double *line;        /* owned: from + 2 reach, or of a spline the bends */
    double *factor;      /* owned, from: of a spline's elimination */
};

static double position_of(const struct line_resampler *r, size_t q) {
    return r->origin + (double)q * r->step;
}

static double kernel(const struct line_resampler *r, double distance) {
    const double share = distance / (REACH * r->step);
    const double angle = PI * CUT_OFF * distance / r->step;
    if (fabs(share) >= 1)
        return 0;
    return (angle == 0 ? 1 : sin(angle) / angle) * gsl_sf_bessel_I0(BETA * sqrt(1 - share * share));
}

static int kernel_create(struct line_resampler *r, struct error *err) {
    const double reach = ceil(REACH * r->step) + 1;
    if (!(reach < (double)r->from))
        return error_set(
            err, ERROR_INPUT,
            "from %zu points to %zu: with so few, waves that these cannot show are not "
            "kept apart; allowed: about %g or more",
            r->from, r->to, REACH + 2);
    r->reach = (size_t)reach;
    r->taps = 2 * r->reach;
    r->weight = array_create(r->to, r->taps * sizeof *r->weight);
    r->line = array_create(r->from + 2 * r->reach, sizeof *r->line);
    if (r->weight == NULL || r->line == NULL)
        return error_memory(err, (r->to * r->taps + r->from) * sizeof(double), "new points");
    for (size_t q = 0; q < r->to; q++) {
        const double at = position_of(r, q), below = floor(at);
        double *weight = r->weight + q * r->taps, sum = 0;
        for (size_t t = 0; t < r->taps; t++) {
            weight[t] = kernel(r, below + (double)t - (double)(r->reach - 1) - at);
            sum += weight[t];
        }
        for (size_t t = 0; t < r->taps; t++)
            weight[t] /= sum;
    }
    return 0;
}

static void line_resampler_destroy(struct line_resampler **resampler) {
    if (*resampler == NULL)
        return;
    free((*resampler)->weight);
    free((*resampler)->line);
    free((*resampler)->factor);
    free(*resampler);
    *resampler = NULL;
}

/* From `from` points at 0, 1, ... to `to` points `step` apart in the middle of them; the new points
 * lie between the first and the last old one. ERROR_INPUT for steps above 1 where there are too few
 * points for the kernel. */
static int line_resampler_create(struct line_resampler **out, size_t from, size_t to, double step,
                                 struct error *err) {
    *out = NULL;
    struct line_resampler *r = array_create(1, sizeof *r);
    if (r == NULL)
        return error_memory(err, sizeof *r, "new points");
    *r = (struct line_resampler){.from = from, .to = to, .step = step};
    const double spare = ((double)(from - 1) - (double)(to - 1) * step) / 2;
    r->origin = spare > 1e-9 ? spare : 0;
    int status = 0;
    if (step > 1 + 1e-9)
        status = kernel_create(r, err);
    else {
        r->line = array_create(from, sizeof *r->line);
        r->factor = array_create(from, sizeof *r->factor);
        if (r->line == NULL || r->factor == NULL)
            status = error_memory(err, from * 2 * sizeof(double), "new points");
    }
    if (status != 0)
        line_resampler_destroy(&r);
    *out = r;
    return status;
}

/* Beyond its ends the line is extended by its own image turned around them, so that slopes are
 * continuous. */
static void run_kernel(struct line_resampler *r, const double *from, double *to) {
    double *middle = r->line + r->reach;
    const size_t last = r->from - 1;
    memcpy(middle, from, r->from * sizeof *from);
    for (size_t k = 1; k <= r->reach; k++) {
        r->line[r->reach - k] = 2 * from[0] - from[k];
        middle[last + k] = 2 * from[last] - from[last - k];
    }
    for (size_t q = 0; q < r->to; q++) {
        const double *weight = r->weight + q * r->taps;
        const double *first = middle + (size_t)floor(position_of(r, q)) - (r->reach - 1);
        double sum = 0;
        for (size_t t = 0; t < r->taps; t++)
            sum += weight[t] * first[t];
        to[q] = sum;
    }
}

static double second_difference(const double *z, size_t i) {
    return z[i - 1] - 2 * z[i] + z[i + 1];
}

/* Computes the second derivatives of the cubic spline through n points 1 apart whose third
 * derivative does not jump at the second and the last but one (de Boor 1978). */
static void spline_bends(const double *z, size_t n, double *bend, double *factor) {
    memset(bend, 0, n * sizeof *bend);
    if (n < 3)
        return;
    bend[1] = second_difference(z, 1);
    bend[n - 2] = second_difference(z, n - 2);
    /* bend[i - 1] + 4 bend[i] + bend[i + 1] = 6 second differences between these two */
    factor[1] = 0;
    for (size_t i = 2; i + 2 < n; i++) {
        const double before = i == 2 ? bend[1] : 0, behind = i + 3 == n ? bend[n - 2] : 0;
        const double right = 6 * second_difference(z, i) - before - behind;
        factor[i] = 1 / (4 - factor[i - 1]);
        bend[i] = (right - (i > 2 ? bend[i - 1] : 0)) * factor[i];
    }
    for (size_t i = n - 3; i-- > 2;)
        bend[i] -= factor[i] * bend[i + 1];
    bend[0] = n > 3 ? 2 * bend[1] - bend[2] : bend[1];
    bend[n - 1] = n > 3 ? 2 * bend[n - 2] - bend[n - 3] : bend[1];
}

static void run_spline(struct line_resampler *r, const double *from, double *to) {
    spline_bends(from, r->from, r->line, r->factor);
    for (size_t q = 0; q < r->to; q++) {
        const double at = position_of(r, q);
        size_t i = (size_t)at;
        i = i < r->from - 1 ? i : r->from - 2;
        const double v = at - (double)i, u = 1 - v;
        to[q] = u * from[i] + v * from[i + 1] +
                (u * (u * u - 1) * r->line[i] + v * (v * v - 1) * r->line[i + 1]) / 6;
    }
}

static void line_resampler_run(struct line_resampler *r, const double *from, double *to) {
    if (r->taps > 0)
        run_kernel(r, from, to);
    else
        run_spline(r, from, to);
}

enum { LINES = 8 }; /* columns gathered together, of a cache line each */

/* Returns the number of waves that both grids resolve: those of the coarser one but the shared mode
 * of two points a wave. */
static size_t common_waves(size_t from, size_t to) {
    return to >= from ? from / 2 : (to - 1) / 2;
}

static int resample_rows(const struct grid *from, const double *z, size_t nx, double step,
                         double *out, struct error *err) {
    struct line_resampler *resampler = NULL;
    int status = line_resampler_create(&resampler, from->nx, nx, step, err);
    for (size_t j = 0; j < from->ny && status == 0; j++)
        line_resampler_run(resampler, z + j * from->nx, out + j * nx);
    line_resampler_destroy(&resampler);
    return status == 0 ? 0 : error_context(err, "along x");
}

static int resample_columns(const double *z, size_t nx, size_t from, size_t to, double step,
                            double *out, struct error *err) {
    struct line_resampler *resampler = NULL;
    double *old = array_create(LINES * from, sizeof *old);
    double *new = array_create(LINES * to, sizeof *new);
    int status = old != NULL && new != NULL
                     ? line_resampler_create(&resampler, from, to, step, err)
                     : error_memory(err, LINES * (from + to) * sizeof *old, "new points");
    for (size_t i = 0; i < nx && status == 0; i += LINES) {
        const size_t lines = nx - i < LINES ? nx - i : LINES;
        for (size_t j = 0; j < from; j++)
            for (size_t l = 0; l < lines; l++)
                old[l * from + j] = z[j * nx + i + l];
        for (size_t l = 0; l < lines; l++)
            line_resampler_run(resampler, old + l * from, new + l *to);
        for (size_t j = 0; j < to; j++)
            for (size_t l = 0; l < lines; l++)
                out[j * nx + i + l] = new[l * to + j];
    }
    line_resampler_destroy(&resampler);
    free(old);
    free(new);
    return status == 0 ? 0 : error_context(err, "along y");
}

static int resample_open(const struct height_map *map, const struct grid *to, double *z,
                         struct error *err) {
    const struct grid *from = &map->grid;
    const double step_x = grid_dx(to) / grid_dx(from), step_y = grid_dy(to) / grid_dy(from);
    if (grid_is_profile(from))
        return resample_rows(from, map->z, to->nx, step_x, z, err);
    double *rows = array_create(to->nx * from->ny, sizeof *rows);
    if (rows == NULL)
        return error_memory(err, to->nx * from->ny * sizeof *rows, "new points");
    int status = resample_rows(from, map->z, to->nx, step_x, rows, err);
    if (status == 0)
        status = resample_columns(rows, to->nx, from->ny, to->ny, step_y, z, err);
    free(rows);
    return status;
}

int map_resample(struct height_map *map, enum boundary boundary, size_t nx, size_t ny, double dx,
                 double dy, struct error *err) {
    struct height_map new = {0};
    int status = height_map_shape(&new, ny, nx, 1, err);
    if (status != 0)
        return status;
    new.grid.lx = boundary == BOUNDARY_OPEN ? dx *(double)nx : map->grid.lx;
    new.grid.ly = boundary == BOUNDARY_OPEN ? dy *(double)ny : map->grid.ly;
    status = grid_check(&new.grid, err);
    if (status != 0)
        return status;
    new.z = array_create(grid_points(&new.grid), sizeof *new.z);
    if (new.z == NULL)
        return error_memory(err, grid_points(&new.grid) * sizeof *new.z, "new points");
    if (boundary == BOUNDARY_OPEN)
        status = resample_open(map, &new.grid, new.z, err);
    else
        status =
            surface_resample(&map->grid, map->z, &new.grid, new.z, common_waves(map->grid.nx, nx),
                             common_waves(map->grid.ny, ny), err);
    if (status == 0) {
        free(map->z);
        map->z = new.z;
        map->grid = new.grid;
    } else
        free(new.z);
    return status;
}
