#include "core/statistics/fit.h"
#include "core/sum.h"
#include <float.h>
#include <gsl/gsl_fit.h>
#include <math.h>
#include <stdlib.h>

struct points {
    size_t n;
    double *load, *fraction; /* one allocation, held by load */
};

/* Copies the points with load > 0 and 0 < fraction <= highest. */
static int points_create(size_t n, const double *load, const double *fraction, double highest,
                         struct points *out, struct error *err) {
    double *copy = array_create(n > 0 ? n : 1, 2 * sizeof *copy);
    if (copy == NULL)
        return error_memory(err, n * 2 * sizeof *copy, "the points of a fit");
    struct points points = {0, copy, copy + n};
    for (size_t i = 0; i < n; i++) {
        if (!(load[i] > 0 && isfinite(load[i]) && fraction[i] > 0 && fraction[i] <= highest))
            continue;
        points.load[points.n] = load[i];
        points.fraction[points.n] = fraction[i];
        points.n++;
    }
    *out = points;
    return 0;
}

static struct fit nothing(size_t points) {
    return (struct fit){.a = NAN, .b = NAN, .error_a = NAN, .error_b = NAN, .points = points};
}

int fit_light_load(size_t n, const double *load, const double *fraction, struct fit *out,
                   struct error *err) {
    struct points points;
    int status = points_create(n, load, fraction, 0.1, &points, err);
    if (status != 0)
        return status;
    struct fit fit = nothing(points.n);
    if (points.n >= 1) {
        double variance, squares;
        gsl_fit_mul(points.load, 1, points.fraction, 1, points.n, &fit.a, &variance, &squares);
        fit.error_a = points.n >= 2 ? sqrt(variance) : NAN;
    }
    *out = fit;
    free(points.load);
    return 0;
}

int fit_power_law(size_t n, const double *load, const double *fraction, struct fit *out,
                  struct error *err) {
    struct points points;
    int status = points_create(n, load, fraction, 0.5, &points, err);
    if (status != 0)
        return status;
    struct fit fit = nothing(points.n);
    for (size_t i = 0; i < points.n; i++) {
        points.load[i] = log(points.load[i]);
        points.fraction[i] = log(points.fraction[i]);
    }
    if (points.n >= 2) {
        double level, covariance[3], squares; /* covariance: 00, 01, 11 */
        gsl_fit_linear(points.load, 1, points.fraction, 1, points.n, &level, &fit.b, &covariance[0],
                       &covariance[1], &covariance[2], &squares);
        fit.a = exp(level);
        fit.error_a = points.n >= 3 ? fit.a * sqrt(covariance[0]) : NAN;
        fit.error_b = points.n >= 3 ? sqrt(covariance[2]) : NAN;
    }
    *out = fit;
    free(points.load);
    return 0;
}

/* Sums over the points at the slope a: r = fraction - erf(sqrt(pi)/2 a load), J = d erf/da. */
struct residuals {
    double rr, rj, jj;
};

static struct residuals residuals_at(double a, size_t n, const double *load,
                                     const double *fraction) {
    struct sum rr = {0}, rj = {0}, jj = {0};
    for (size_t i = 0; i < n; i++) {
        double x = sqrt(M_PI) / 2 * a * load[i];
        double r = fraction[i] - erf(x), j = load[i] * exp(-x * x);
        sum_add(&rr, r * r);
        sum_add(&rj, r * j);
        sum_add(&jj, j * j);
    }
    return (struct residuals){sum_value(&rr), sum_value(&rj), sum_value(&jj)};
}

static struct residuals residuals_of(double a, const struct points *points) {
    return residuals_at(a, points->n, points->load, points->fraction);
}

double fit_erf_near(size_t n, const double *load, const double *fraction, double near) {
    enum { STEPS_MOST = 50 };
    double a = near;
    for (int step = 0; step < STEPS_MOST && a > 0; step++) {
        struct residuals at = residuals_at(a, n, load, fraction);
        double next = a + at.rj / at.jj;
        if (fabs(next - a) <= 1e-14 * a)
            return next;
        a = next;
    }
    return NAN;
}

/* The slope where the gradient -2 sum(rJ) changes from falling to rising: Gauss-Newton steps kept
 * inside a shrinking bracket, so it always ends, in a minimum. */
static double least_squares_slope(const struct points *points) {
    double low = INFINITY;
    for (size_t i = 0; i < points->n; i++)
        low = fmin(low, points->fraction[i] / points->load[i]);
    /* erf(sqrt(pi)/2 a load) <= a load: at `low` the curve lies under all points. */
    low = fmax(low, DBL_MIN);
    double high = 2 * low;
    while (residuals_of(high, points).rj > 0)
        high *= 2;
    double a = low;
    for (int step = 0; step < 200 && high - low > 4e-16 * high; step++) {
        struct residuals at = residuals_of(a, points);
        if (at.rj > 0)
            low = a;
        else
            high = a;
        double next = a + at.rj / at.jj;
        if (!(next > low && next < high))
            next = low + (high - low) / 2;
        if (next == a)
            break;
        a = next;
    }
    return a;
}

int fit_erf(size_t n, const double *load, const double *fraction, struct fit *out,
            struct error *err) {
    struct points points;
    int status = points_create(n, load, fraction, nextafter(1, 0), &points, err);
    if (status != 0)
        return status;
    struct fit fit = nothing(points.n);
    if (points.n >= 1) {
        fit.a = least_squares_slope(&points);
        struct residuals at = residuals_of(fit.a, &points);
        if (points.n >= 2)
            fit.error_a = sqrt(at.rr / (double)(points.n - 1) / at.jj);
    }
    *out = fit;
    free(points.load);
    return 0;
}
