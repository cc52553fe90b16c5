#include "core/map/line_resampler.h"
#include <gsl/gsl_sf_bessel.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
/* The kernel of wider steps is a sine cardinal under a window of Kaiser (1974) that leaves 1e-4 of
 * what is beyond its edge, and reaches so many steps to either side. */
static const double BETA = 7.857, REACH = 20;
/* Half of the amplitude is left at this share of the highest wave number of the new points, so that
 * the window's edge, which is as wide as a quarter of it, ends there. */
static const double CUT_OFF = 0.875;

struct line_resampler {
    size_t from, to;
    double step, origin; /* in points of the old line */
    size_t reach, taps;  /* of the kernel, in points; taps 0: a spline */
    double *weight;      /* owned, to x taps */
    double *line;        /* owned: from + 2 reach, or of a spline the bends */
    double *factor;      /* owned, from: of a spline's elimination */
};

static double place_of(const struct line_resampler *r, size_t q) {
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
        const double at = place_of(r, q), below = floor(at);
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

int line_resampler_create(struct line_resampler **out, size_t from, size_t to, double step,
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

void line_resampler_destroy(struct line_resampler **resampler) {
    if (*resampler == NULL)
        return;
    free((*resampler)->weight);
    free((*resampler)->line);
    free((*resampler)->factor);
    free(*resampler);
    *resampler = NULL;
}

/* Beyond its ends the line goes on as its own image turned around them, so that slopes go on. */
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
        const double *first = middle + (size_t)floor(place_of(r, q)) - (r->reach - 1);
        double sum = 0;
        for (size_t t = 0; t < r->taps; t++)
            sum += weight[t] * first[t];
        to[q] = sum;
    }
}

static double second_difference(const double *z, size_t i) {
    return z[i - 1] - 2 * z[i] + z[i + 1];
}

/* Second derivatives of the cubic spline through n points 1 apart whose third derivative does not
 * jump at the second and the last but one (de Boor 1978). */
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
        const double at = place_of(r, q);
        size_t i = (size_t)at;
        i = i < r->from - 1 ? i : r->from - 2;
        const double v = at - (double)i, u = 1 - v;
        to[q] = u * from[i] + v * from[i + 1] +
                (u * (u * u - 1) * r->line[i] + v * (v * v - 1) * r->line[i + 1]) / 6;
    }
}

void line_resampler_run(struct line_resampler *r, const double *from, double *to) {
    if (r->taps > 0)
        run_kernel(r, from, to);
    else
        run_spline(r, from, to);
}
