#include "core/map/gaussian_filter.h"
#include "core/map/smoother.h"
#include <math.h>
#include <stdlib.h>

/* Weights of a robust filter are those of Beaton & Tukey (1974), 0 from so many times the median of
 * the distances on: three standard deviations of Gaussian heights. */
static const double MEDIANS = 4.4478;
static const double SCALE_CHANGE = 1e-3; /* of that distance in the last step, over itself */
enum { STEPS_MOST = 100 };

struct work {
    const struct grid *grid;
    const double *z;           /* borrowed */
    struct smoother *smoother; /* owned */
    size_t points;
    double base;      /* mean height, which is taken from all against rounding */
    double *mean;     /* owned, points: the mean surface about the base */
    double *weight;   /* owned, points: sums of weights, or NULL where they are products: */
    double *x, *y;    /* owned, nx and ny */
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
    return smoother_create(&work->smoother, grid, filter->cut_off, boundary, err);
}

/* The mean surface of all heights that are there. */
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

/* Puts value number n of rising order, from 0, in its place (Hoare 1961). */
static double select_value(double *values, size_t count, size_t n) {
    size_t low = 0, high = count - 1;
    while (low < high) {
        const double pivot = values[low + (high - low) / 2];
        size_t i = low, j = high;
        for (;;) {
            while (values[i] < pivot)
                i++;
            while (values[j] > pivot)
                j--;
            if (i >= j)
                break;
            const double swapped = values[i];
            values[i++] = values[j];
            values[j--] = swapped;
        }
        if (n <= j)
            high = j;
        else
            low = j + 1;
    }
    return values[n];
}

/* Returns the distance from the mean surface at which weights end. */
static double distance_most(struct work *work) {
    size_t count = 0;
    for (size_t i = 0; i < work->points; i++)
        if (!isnan(work->z[i]))
            work->distance[count++] = fabs(work->z[i] - work->base - work->mean[i]);
    return MEDIANS * select_value(work->distance, count, count / 2);
}

/* One step: the mean surface with weights by the distance from the last one. A place without a
 * height of weight nearby keeps the mean that it has. Returns the share of heights without one. */
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
    const double longest = grid_is_profile(grid) ? grid->lx : fmax(grid->lx, grid->ly);
    *out = (struct gaussian_filter_result){0};
    if (!(filter->cut_off > 0 && filter->cut_off <= longest))
        return error_set(err, ERROR_INPUT,
                         "a cut-off of %g; allowed: above 0, up to the length of the map, %g",
                         filter->cut_off, longest);
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
