#include "core/map/preparation/gaussian_filter.h"
#include "core/map/length_unit.h"
#include "core/statistics/measured_map.h"
#include "core/surface/transform.h"
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Gaussian means of a map's heights along rows and columns. */

static const double PI = 3.14159265358979323846;
/* sqrt(ln 2/pi): a Gaussian exp(-pi (x/(ALPHA L))^2) halves waves of length L (ISO 16610-21
 * 2011). */
static const double ALPHA = 0.46971863934982566;
/* Weights beyond REACH ALPHA cut-offs are below 1e-14 of the largest. */
static const double REACH = 3.2;
/* Half kernels of more points are applied by transforms. */
static const size_t DIRECT_MOST = 48;
enum { LINES = 8 }; /* columns gathered together, of a cache line each */

/* Smoothing of lines of one direction. */
struct axis {
    size_t n, radius;
    double *kernel;              /* owned, radius + 1; NULL: transforms alone */
    struct transform *transform; /* owned; NULL: the kernel, directly */
    double *symbol;              /* owned */
    double *line; /* owned, n + 2 radius: with zeros on both sides, for direct sums */
    double transmission;
};

struct smoother {
    struct grid grid;
    struct axis x, y; /* y of a profile has n 1 and does nothing */
    double *lines;    /* owned, LINES x ny */
};

static void axis_clear(struct axis *axis) {
    transform_destroy(&axis->transform);
    free(axis->kernel);
    free(axis->symbol);
    free(axis->line);
}

static void smoother_destroy(struct smoother **smoother) {
    if (*smoother == NULL)
        return;
    axis_clear(&(*smoother)->x);
    axis_clear(&(*smoother)->y);
    free((*smoother)->lines);
    free(*smoother);
    *smoother = NULL;
}

/* Returns a count of n or more whose transforms are fast: 2^k or 3 2^k. */
static size_t fast_count(size_t n) {
    size_t power = 4;
    while (power < n)
        power *= 2;
    return power / 4 * 3 >= n ? power / 4 * 3 : power;
}

static int transform_of(struct axis *axis, size_t n, struct error *err) {
    const struct grid line = {n, 1, 1, 1};
    axis->symbol = array_create(n / 2 + 1, sizeof *axis->symbol);
    if (axis->symbol == NULL)
        return error_memory(err, n * sizeof *axis->symbol, "a filter");
    return transform_create(&axis->transform, &line, n / 2, 0, err);
}

/* ratio: ALPHA cut-offs over the spacing. */
static int periodic_axis(struct axis *axis, double ratio, struct error *err) {
    int status = transform_of(axis, axis->n, err);
    for (size_t m = 0; status == 0 && m <= axis->n / 2; m++) {
        const double wave = ratio * (double)m / (double)axis->n;
        axis->symbol[m] = exp(-PI * wave * wave);
    }
    axis->transmission = 0.5;
    return status;
}

/* Fills the kernel, whose sum over all points of an infinite line is 1, and computes its
 * transmission of waves as long as the cut-off. */
static void make_kernel(struct axis *axis, double ratio) {
    double sum = 0, wave = 0;
    for (size_t k = 0; (double)k <= REACH * ratio; k++) {
        const double u = (double)k / ratio, weight = (k > 0 ? 2 : 1) * exp(-PI * u * u);
        sum += weight;
        wave += weight * cos(2 * PI * ALPHA * u);
    }
    for (size_t k = 0; k <= axis->radius; k++) {
        const double u = (double)k / ratio;
        axis->kernel[k] = exp(-PI * u * u) / sum;
    }
    axis->transmission = wave / sum;
}

static int kernel_transform(struct axis *axis, struct error *err) {
    const size_t n = fast_count(axis->n + axis->radius);
    double *kernel = array_create(n, sizeof *kernel);
    int status = kernel != NULL ? transform_of(axis, n, err)
                                : error_memory(err, n * sizeof *kernel, "a filter");
    if (status == 0) {
        for (size_t k = 0; k <= axis->radius; k++)
            kernel[k] = kernel[(n - k) % n] = axis->kernel[k];
        transform_forward(axis->transform, kernel);
        for (size_t m = 0; m <= n / 2; m++)
            axis->symbol[m] = (double)n * creal(transform_spectrum(axis->transform)[m]);
    }
    free(kernel);
    return status;
}

static int open_axis(struct axis *axis, double ratio, struct error *err) {
    const double radius = ceil(REACH * ratio);
    axis->radius = radius < (double)axis->n ? (size_t)radius : axis->n - 1;
    axis->kernel = array_create(axis->radius + 1, sizeof *axis->kernel);
    axis->line = array_create(axis->n + 2 * axis->radius, sizeof *axis->line);
    if (axis->kernel == NULL || axis->line == NULL)
        return error_memory(err, axis->n * 4 * sizeof *axis->kernel, "a filter");
    make_kernel(axis, ratio);
    return axis->radius > DIRECT_MOST ? kernel_transform(axis, err) : 0;
}

enum { LENGTH_TEXT = 40 };

/* Returns a length as messages print it. */
static const char *length_text(const struct gaussian_filter *filter, double length,
                               char text[LENGTH_TEXT]) {
    double one = 1;
    const char *unit = filter->metres ? length_unit_readable(length, &one) : "";
    snprintf(text, LENGTH_TEXT, "%g%s%s", length / one, *unit != '\0' ? " " : "", unit);
    return text;
}

static int axis_create(struct axis *axis, size_t n, double spacing,
                       const struct gaussian_filter *filter, enum boundary boundary,
                       struct error *err) {
    const double ratio = ALPHA * filter->cut_off / spacing;
    char apart[LENGTH_TEXT], cut_off[LENGTH_TEXT];
    *axis = (struct axis){.n = n, .transmission = 0.5};
    if (n == 1)
        return 0;
    int status = boundary == BOUNDARY_PERIODIC ? periodic_axis(axis, ratio, err)
                                               : open_axis(axis, ratio, err);
    if (status == 0 && !(fabs(axis->transmission - 0.5) <= 0.01))
        return error_set(err, ERROR_INPUT,
                         "points %s apart leave %.3g of waves as long as the cut-off, %s, in place "
                         "of 0.5; allowed: a cut-off of about 4 spacings or more",
                         length_text(filter, spacing, apart), axis->transmission,
                         length_text(filter, filter->cut_off, cut_off));
    return status;
}

/* A Gaussian that halves the amplitude of waves as long as the cut-off. For an open map it is a
 * kernel of weights, with sum 1 and cut off where they are below 1e-14 of the largest; for a
 * periodic one a factor of its waves. ERROR_INPUT where points are too far apart for that. */
static int smoother_create(struct smoother **out, const struct grid *grid,
                           const struct gaussian_filter *filter, enum boundary boundary,
                           struct error *err) {
    *out = NULL;
    struct smoother *s = array_create(1, sizeof *s);
    if (s == NULL)
        return error_memory(err, sizeof *s, "a filter");
    s->grid = *grid;
    s->lines = array_create(LINES * grid->ny, sizeof *s->lines);
    int status = s->lines != NULL
                     ? axis_create(&s->x, grid->nx, grid_dx(grid), filter, boundary, err)
                     : error_memory(err, LINES * grid->ny * sizeof *s->lines, "a filter");
    if (status == 0)
        status = axis_create(&s->y, grid->ny, grid_dy(grid), filter, boundary, err);
    if (status != 0)
        smoother_destroy(&s);
    *out = s;
    return status;
}

/* line[i] = sum over k of kernel[|k|] padded[i + k], where padded has zeros on both sides. */
static void convolve(const struct axis *axis, double *line) {
    const double *middle = axis->line + axis->radius;
    memcpy(axis->line + axis->radius, line, axis->n * sizeof *line);
    for (size_t i = 0; i < axis->n; i++)
        line[i] = axis->kernel[0] * middle[i];
    for (size_t k = 1; k <= axis->radius; k++) {
        const double weight = axis->kernel[k];
        const double *left = middle - k, *right = middle + k;
        for (size_t i = 0; i < axis->n; i++)
            line[i] += weight * (left[i] + right[i]);
    }
}

static void axis_run(const struct axis *axis, double *line) {
    if (axis->transform != NULL)
        transform_filter_part(axis->transform, axis->symbol, 1, axis->n, 1, line, line);
    else if (axis->n > 1)
        convolve(axis, line);
}

/* Replaces a field on the grid by its Gaussian sums; beyond the sides of an open map it is 0. */
static void smoother_run(struct smoother *s, double *field) {
    const size_t nx = s->grid.nx, ny = s->grid.ny;
    for (size_t j = 0; j < ny; j++)
        axis_run(&s->x, field + j * nx);
    for (size_t i = 0; i < nx && ny > 1; i += LINES) {
        const size_t lines = nx - i < LINES ? nx - i : LINES;
        for (size_t j = 0; j < ny; j++)
            for (size_t l = 0; l < lines; l++)
                s->lines[l * ny + j] = field[j * nx + i + l];
        for (size_t l = 0; l < lines; l++)
            axis_run(&s->y, s->lines + l * ny);
        for (size_t j = 0; j < ny; j++)
            for (size_t l = 0; l < lines; l++)
                field[j * nx + i + l] = s->lines[l * ny + j];
    }
}

/* Fills x[nx] and y[ny] with the sums of a field that is 1 on the map: that of a point is a product
 * of both. */
static void smoother_reach(struct smoother *s, double *x, double *y) {
    for (size_t i = 0; i < s->grid.nx; i++)
        x[i] = 1;
    for (size_t j = 0; j < s->grid.ny; j++)
        y[j] = 1;
    axis_run(&s->x, x);
    axis_run(&s->y, y);
}

/* Returns the remaining part of waves as long as the cut-off, along the axis with fewer points a
 * wave. */
static double smoother_transmission(const struct smoother *s) {
    return fabs(s->x.transmission - 0.5) > fabs(s->y.transmission - 0.5) ? s->x.transmission
                                                                         : s->y.transmission;
}

/* Weights of a robust filter are those of Beaton & Tukey (1974). They are 0 beyond MEDIANS times
 * the median of the distances, which is three standard deviations of Gaussian heights. */
static const double MEDIANS = 4.4478;
static const double SCALE_CHANGE = 1e-3; /* relative change of that distance in the last step */
enum { STEPS_MOST = 100 };

struct work {
    const struct grid *grid;
    const double *z;           /* borrowed */
    struct smoother *smoother; /* owned */
    size_t points;
    double base;    /* mean height, which is subtracted from all against rounding */
    double *mean;   /* owned, points: the mean surface about the base */
    double *weight; /* owned, points: sums of weights, or NULL where they are products of x and y */
    double *x, *y;  /* owned, nx and ny */
    double *distance; /* owned, points: scratch of a robust filter, else NULL */
};

static void work_clear(struct work *work) {
    smoother_destroy(&work->smoother);
    free(work->mean);
    free(work->weight);
    free(work->x);
    free(work->y);
    free(work->distance);
}

static int work_create(struct work *work, const struct grid *grid, const double *z,
                       enum boundary boundary, const struct gaussian_filter *filter,
                       struct error *err) {
    const size_t points = grid_points(grid);
    struct average mean = {0};
    *work = (struct work){.grid = grid, .z = z, .points = points};
    for (size_t i = 0; i < points; i++)
        average_add(&mean, z[i]);
    if (mean.count == 0)
        return error_set(err, ERROR_INPUT, "the map has no heights, only holes");
    work->base = average_value(&mean);
    work->mean = array_create(points, sizeof *work->mean);
    work->x = array_create(grid->nx, sizeof *work->x);
    work->y = array_create(grid->ny, sizeof *work->y);
    bool complete = work->mean != NULL && work->x != NULL && work->y != NULL;
    if (complete && (filter->robust || mean.count < points)) {
        work->weight = array_create(points, sizeof *work->weight);
        complete = work->weight != NULL;
    }
    if (complete && filter->robust) {
        work->distance = array_create(points, sizeof *work->distance);
        complete = work->distance != NULL;
    }
    if (!complete)
        return error_memory(err, points * 3 * sizeof(double), "a filter");
    return smoother_create(&work->smoother, grid, filter, boundary, err);
}

/* Computes the mean surface of all heights that are there. */
static void plain_mean(struct work *work) {
    for (size_t i = 0; i < work->points; i++) {
        const bool hole = isnan(work->z[i]);
        work->mean[i] = hole ? 0 : work->z[i] - work->base;
        if (work->weight != NULL)
            work->weight[i] = hole ? 0 : 1;
    }
    smoother_run(work->smoother, work->mean);
    if (work->weight != NULL)
        smoother_run(work->smoother, work->weight);
    else
        smoother_reach(work->smoother, work->x, work->y);
    for (size_t j = 0, i = 0; j < work->grid->ny; j++)
        for (size_t column = 0; column < work->grid->nx; column++, i++)
            work->mean[i] /= work->weight != NULL ? work->weight[i] : work->x[column] * work->y[j];
}

/* Returns the distance from the mean surface at which weights end. */
static double distance_most(struct work *work) {
    size_t count = 0;
    for (size_t i = 0; i < work->points; i++)
        if (!isnan(work->z[i]))
            work->distance[count++] = fabs(work->z[i] - work->base - work->mean[i]);
    return MEDIANS * gsl_stats_select(work->distance, 1, count, count / 2);
}

/* Makes one step: the mean surface with weights by the distance from the last one. A point without
 * a weighted height nearby keeps its mean. Returns the share of heights of weight 0. */
static double robust_mean(struct work *work, double most) {
    size_t rejected = 0, count = 0;
    for (size_t i = 0; i < work->points; i++) {
        const double height = work->z[i] - work->base;
        const double u = (height - work->mean[i]) / most;
        const bool hole = isnan(height);
        count += hole ? 0 : 1;
        rejected += !hole && !(fabs(u) < 1) ? 1 : 0;
        work->weight[i] = fabs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
        work->distance[i] = hole ? 0 : height * work->weight[i];
    }
    smoother_run(work->smoother, work->weight);
    smoother_run(work->smoother, work->distance);
    for (size_t i = 0; i < work->points; i++)
        if (work->weight[i] > 1e-9)
            work->mean[i] = work->distance[i] / work->weight[i];
    return (double)rejected / (double)count;
}

static int make_robust(struct work *work, struct gaussian_filter_result *out, struct error *err) {
    double most = distance_most(work), before = 0;
    while (most > 0 && fabs(most - before) > SCALE_CHANGE * most) {
        if (out->steps++ == STEPS_MOST)
            return error_set(err, ERROR_NUMERIC,
                             "the weights of the robust filter go on changing after %d steps",
                             (int)STEPS_MOST);
        out->rejected = robust_mean(work, most);
        before = most;
        most = distance_most(work);
    }
    return 0;
}

int gaussian_filter_run(const struct grid *grid, double *z, enum boundary boundary,
                        const struct gaussian_filter *filter, struct gaussian_filter_result *out,
                        struct error *err) {
    struct work work;
    const double longest = grid_longest_side(grid);
    char cut_off[LENGTH_TEXT], side[LENGTH_TEXT];
    *out = (struct gaussian_filter_result){0};
    if (!(filter->cut_off > 0 && filter->cut_off <= longest))
        return error_set(
            err, ERROR_INPUT, "a cut-off of %s; allowed: above 0, up to the length of the map, %s",
            length_text(filter, filter->cut_off, cut_off), length_text(filter, longest, side));
    int status = work_create(&work, grid, z, boundary, filter, err);
    if (status == 0) {
        out->transmission = smoother_transmission(work.smoother);
        plain_mean(&work);
        if (filter->robust)
            status = make_robust(&work, out, err);
    }
    for (size_t i = 0; status == 0 && i < work.points; i++)
        if (!isnan(z[i]))
            z[i] = filter->keeps_long_waves ? work.base + work.mean[i]
                                            : z[i] - work.base - work.mean[i];
    work_clear(&work);
    return status;
}
