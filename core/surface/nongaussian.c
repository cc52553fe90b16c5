#include "core/surface/nongaussian.h"
#include "core/surface/fast_step.h"
#include "core/surface/height_error.h"
#include "core/surface/impose.h"
#include "core/surface/rank.h"
#include "core/surface/target_heights.h"
#include <fftw3.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Schedule of ITERATION_RELAXED: so much of it is momentum, the rest reflections, and a few plain
 * iterations settle on the constraints, as they do behind every iteration but ITERATION_PLAIN. */
enum { ACCELERATED_PARTS = 3, RELAXED_PARTS = 8, POLISHING = 3 };
static const double MOMENTUM_MOST = 0.9;

/* Heights are in standard deviations throughout, whatever the unit of the spectrum. */
struct nongaussian {
    const struct modes *modes;
    struct surface_options options;
    struct height_moments moments;
    size_t points;
    double deviation;  /* sqrt(m00) of modes */
    double *amplitude; /* sqrt(power)/deviation, laid out as modes->power */
    struct ranker *ranker;
    double *sorted; /* points: target heights, rising */
    double *h;      /* points: z_h, the target heights in the order of z_s */
    double *x;      /* points: iterate of reflections, last one of momentum; NULL for the plain
                       iteration */
    struct fast_step *fast; /* NULL for iterations that rank exactly throughout */
    struct height_error *height_error;
};

static bool is_fast(const struct surface_options *options) {
    return options->iteration == ITERATION_REFLECTIONS || options->iteration == ITERATION_MOMENTUM;
}

static int options_check(const struct surface_options *o, struct error *err) {
    if (!(o->tolerance >= 0 && isfinite(o->tolerance)))
        return error_set(err, ERROR_INPUT, "tolerance = %g; allowed: 0 or more", o->tolerance);
    if (!(o->stall_gain >= 0 && o->stall_gain < 1))
        return error_set(err, ERROR_INPUT, "stall gain = %g; allowed: 0 to below 1", o->stall_gain);
    if (o->stall_iterations < 1 || o->max_iterations < 1)
        return error_set(err, ERROR_INPUT,
                         "stall iterations = %zu, most iterations = %zu; "
                         "allowed: 1 or more",
                         o->stall_iterations, o->max_iterations);
    if (!(o->relaxation > 0 && o->relaxation <= 1))
        return error_set(err, ERROR_INPUT, "relaxation = %g; allowed: above 0, up to 1",
                         o->relaxation);
    return 0;
}

static size_t band_size(const struct modes *modes) {
    return (modes->mode_x + 1) * (2 * modes->mode_y + 1);
}

static void amplitude_fill(struct nongaussian *g) {
    struct moments moments;
    modes_moments(g->modes, &moments);
    g->deviation = moments.rms_height;
    for (size_t k = 0; k < band_size(g->modes); k++)
        g->amplitude[k] = sqrt(g->modes->power[k]) / g->deviation;
}

static int amplitude_create(struct nongaussian *g, struct error *err) {
    size_t count = band_size(g->modes);
    g->amplitude = array_create(count, sizeof *g->amplitude);
    if (g->amplitude == NULL)
        return error_memory(err, count * sizeof *g->amplitude, "amplitudes");
    amplitude_fill(g);
    return 0;
}

static int arrays_create(struct nongaussian *g, struct error *err) {
    bool plain = g->options.iteration == ITERATION_PLAIN;
    int status = ranker_create(&g->ranker, g->points, err);
    if (status != 0)
        return status;
    g->sorted = fftw_alloc_real(g->points);
    g->h = fftw_alloc_real(g->points);
    g->x = plain ? NULL : fftw_alloc_real(g->points);
    if (g->sorted == NULL || g->h == NULL || (!plain && g->x == NULL))
        return error_memory(err, g->points * sizeof(double), "heights of one iteration");
    return is_fast(&g->options) ? fast_step_create(&g->fast, g->modes, err) : 0;
}

int nongaussian_create(struct nongaussian **out, const struct modes *modes,
                       const struct surface_options *options, struct error *err) {
    int status = options_check(options, err);
    if (status != 0)
        return status;
    struct nongaussian *g = array_create(1, sizeof *g);
    if (g == NULL)
        return error_memory(err, sizeof *g, "non-Gaussian generation");
    g->modes = modes;
    g->options = *options;
    g->points = grid_points(&modes->grid);
    status = heights_moments(&options->heights, &g->moments, err);
    if (status == 0)
        status = amplitude_create(g, err);
    if (status == 0)
        status = arrays_create(g, err);
    if (status == 0)
        status = height_error_create(&g->height_error, modes, err);
    if (status != 0) {
        nongaussian_destroy(&g);
        return status;
    }
    *out = g;
    return 0;
}

void nongaussian_destroy(struct nongaussian **nongaussian) {
    struct nongaussian *g = *nongaussian;
    if (g == NULL)
        return;
    ranker_destroy(&g->ranker);
    fftw_free(g->sorted);
    fftw_free(g->h);
    fftw_free(g->x);
    fast_step_destroy(&g->fast);
    height_error_destroy(&g->height_error);
    free(g->amplitude);
    free(g);
    *nongaussian = NULL;
}

/* The steps below start from the transform's spectrum of an iterate and leave that of the next. */

/* Makes z_s of z: the surface of exact spectrum nearest to the iterate. */
static void spectral_surface(const struct nongaussian *g, struct transform *transform, double *z) {
    amplitudes_impose(g->modes, g->amplitude, transform_spectrum(transform));
    transform_inverse(transform, z);
}

/* Alternation with the momentum of Nesterov (1983): the next iterate is z_h, carried on along its
 * last step. */
static int accelerated_phase(struct nongaussian *g, struct transform *transform, double *z,
                             size_t iterations, struct error *err) {
    double *last = g->x;
    for (size_t iteration = 0; iteration < iterations; iteration++) {
        spectral_surface(g, transform, z);
        int status = rank_place(g->ranker, z, g->sorted, g->h, err);
        if (status != 0)
            return status;
        double t = (double)iteration;
        double momentum = iteration < 2 ? 0 : fmin(MOMENTUM_MOST, (t - 1) / (t + 2));
        for (size_t i = 0; i < g->points; i++) {
            double h = g->h[i];
            if (momentum > 0)
                g->h[i] += momentum * (h - last[i]);
            last[i] = h;
        }
        transform_forward(transform, g->h);
    }
    return 0;
}

/* Relaxed averaged alternating reflections (Luke 2005). With s the nearest surface of the exact
 * spectrum, y = 2 s - x its reflection and h the exact heights in the order of y:
 *     x <- b (x + h) + (1 - 2 b) s.
 * b rises from the relaxation towards 1, by three quarters of the way. z serves as y. */
static int relaxed_phase(struct nongaussian *g, struct transform *transform, double *z,
                         size_t iterations, struct error *err) {
    double *x = g->x;
    double first = g->options.relaxation;
    double rise = 0.75 * (1 - first);
    for (size_t iteration = 0; iteration < iterations; iteration++) {
        spectral_surface(g, transform, z);
        if (iteration == 0)
            memcpy(x, z, g->points * sizeof *x);
        for (size_t i = 0; i < g->points; i++)
            z[i] = 2 * z[i] - x[i];
        int status = rank_place(g->ranker, z, g->sorted, g->h, err);
        if (status != 0)
            return status;
        double way = iterations > 1 ? (double)iteration / (double)(iterations - 1) : 0;
        double b = first + rise * way;
        for (size_t i = 0; i < g->points; i++)
            x[i] = b * (x[i] + g->h[i]) + (0.5 - b) * (x[i] + z[i]);
        transform_forward(transform, x);
    }
    return 0;
}

static int plain_iterate(struct nongaussian *g, struct transform *transform, double *z,
                         struct error *err) {
    spectral_surface(g, transform, z);
    int status = rank_place(g->ranker, z, g->sorted, g->h, err);
    if (status == 0)
        transform_forward(transform, g->h);
    return status;
}

/* The plain phase, which ends by the tolerance, the limit of iterations, or the stall rule (F5.3):
 * the largest error has not fallen by the share `stall_gain` in `stall_iterations`. The rule is
 * checked after every iteration. */
static int plain_phase(struct nongaussian *g, struct transform *transform, double *z, size_t limit,
                       struct surface_report *report, struct error *err) {
    const struct surface_options *options = &g->options;
    const double complex *spectrum = transform_spectrum(transform);
    double best = INFINITY;
    size_t stuck = 0;
    report->end = END_LIMIT;
    for (size_t iteration = 0; report->end == END_LIMIT && iteration < limit; iteration++) {
        int status = plain_iterate(g, transform, z, err);
        if (status != 0)
            return status;
        report->iterations++;
        double worst = height_error_measure(g->height_error, z, g->h, spectrum, false, report);
        bool gained = worst <= best * (1 - options->stall_gain);
        best = gained ? worst : best;
        stuck = gained ? 0 : stuck + 1;
        if (worst <= options->tolerance)
            report->end = END_CONVERGED;
        else if (stuck >= options->stall_iterations)
            report->end = END_STALLED;
    }
    height_error_measure(g->height_error, z, g->h, spectrum, true, report);
    return 0;
}

/* ITERATION_REFLECTIONS. Plain alternation takes thousands of iterations to come to rest, and
 * stalls long before. Reflections reach its error after 1500 in 50 to 90, and nothing that was
 * tried is as fast without finding surfaces of another kind: after this opening the C = 1 maximum
 * and minimum (H = 0.8, ratio 4, 256 x 256, 16 surfaces) have summits that differ from those of
 * 6000 plain iterations by 1.1 +- 0.6 and 1.2 +- 0.9 % in number, -0.5 and -0.4 % in mean height,
 * -0.7 and 0.0 % in mean curvature, which is what plain iterations of 1500 and 6000 differ, or
 * twice that (bench_nongaussian drift). Momentum alone ends with curvatures of the maximum 1 to 2 %
 * off. Steps beyond the heights are faster early, but end with other numbers of summits. On a grid
 * of 4 points a shortest wave, where the heights between the points are free, the number of summits
 * stays low whatever follows. */
enum { OPENING = 15, CHECKED_EACH = 5 };
static const double REFLECTION = 0.9;

static struct fast_move fast_move(enum surface_iteration iteration, size_t number) {
    if (iteration == ITERATION_REFLECTIONS && number >= OPENING)
        return (struct fast_move){FAST_REFLECTION, REFLECTION, number == OPENING};
    double t = (double)number;
    double momentum = number < 2 ? 0 : fmin(MOMENTUM_MOST, (t - 1) / (t + 2));
    return (struct fast_move){FAST_MOMENTUM, momentum, number == 0};
}

/* Iterates until eps_h is within the tolerance, or has not fallen by the share `stall_gain` in
 * `stall_iterations` (END_LIMIT: neither, or not yet known). The opening does not stall. */
static void fast_phase(struct nongaussian *g, struct transform *transform, double *z, size_t limit,
                       struct surface_report *report) {
    const struct surface_options *options = &g->options;
    bool opens = options->iteration == ITERATION_REFLECTIONS;
    double best = INFINITY;
    size_t best_at = 0;
    fast_step_start(g->fast, z);
    report->end = END_LIMIT;
    for (size_t number = 0; number < limit && report->end == END_LIMIT; number++) {
        bool checked = number % CHECKED_EACH == 0;
        double eps = fast_step_run(g->fast, transform, g->amplitude, g->sorted,
                                   fast_move(options->iteration, number), z, g->x,
                                   checked ? g->height_error : NULL);
        report->iterations++;
        if (!checked)
            continue;
        if (!(eps > best * (1 - options->stall_gain)) || (opens && number <= OPENING)) {
            best = eps;
            best_at = number;
        }
        if (eps <= options->tolerance)
            report->end = END_CONVERGED;
        else if (number - best_at >= options->stall_iterations)
            report->end = END_STALLED;
    }
}

/* Fast iterations, and a few plain ones that settle on the constraints: as many as it takes where
 * the tolerance is near. */
static int iterate_fast(struct nongaussian *g, struct transform *transform, double *z,
                        struct surface_report *report, struct error *err) {
    size_t most = g->options.max_iterations;
    size_t polishing = most < POLISHING ? most : POLISHING;
    transform_forward(transform, z);
    fast_phase(g, transform, z, most - polishing, report);
    enum surface_end end = report->end;
    if (end == END_CONVERGED)
        polishing = most - report->iterations;
    int status = plain_phase(g, transform, z, polishing, report, err);
    if (status == 0 && report->end == END_LIMIT && end == END_STALLED)
        report->end = END_STALLED;
    return status;
}

static int iterate(struct nongaussian *g, struct transform *transform, double *z,
                   struct surface_report *report, struct error *err) {
    const struct surface_options *options = &g->options;
    if (is_fast(options))
        return iterate_fast(g, transform, z, report, err);
    size_t plain = options->max_iterations;
    size_t relaxed = 0;
    if (options->iteration == ITERATION_RELAXED) {
        plain = plain < POLISHING ? plain : POLISHING;
        relaxed = options->max_iterations - plain;
        if (relaxed > options->relaxed_iterations)
            relaxed = options->relaxed_iterations;
    }
    size_t accelerated = relaxed * ACCELERATED_PARTS / RELAXED_PARTS;
    report->iterations = relaxed;
    transform_forward(transform, z);
    int status = accelerated_phase(g, transform, z, accelerated, err);
    if (status == 0)
        status = relaxed_phase(g, transform, z, relaxed - accelerated, err);
    return status != 0 ? status : plain_phase(g, transform, z, plain, report, err);
}

void nongaussian_aim(struct nongaussian *g, const struct surface_aim *aim) {
    g->options.iteration = aim->iteration;
    g->options.tolerance = aim->tolerance;
    g->options.stall_iterations = aim->stall_iterations;
    g->options.max_iterations = aim->max_iterations;
}

int nongaussian_run(struct nongaussian *g, struct transform *transform, struct random_key key,
                    double *z, struct surface_report *report, struct error *err) {
    const struct surface_options *options = &g->options;
    struct surface_report local = {0};
    int status = target_heights_draw(&options->heights, &g->moments, options->draw, key, g->points,
                                     g->ranker, g->sorted, err);
    if (status != 0)
        return status;
    if (options->amplitudes == AMPLITUDES_RANDOM)
        amplitude_fill(g);
    height_error_start(g->height_error, &g->moments, g->sorted);
    for (size_t i = 0; i < g->points; i++)
        z[i] /= g->deviation;
    status = iterate(g, transform, z, &local, err);
    if (status != 0)
        return status;
    const double *kept = options->keep == KEEP_HEIGHTS ? g->h : z;
    for (size_t i = 0; i < g->points; i++)
        z[i] = g->deviation * kept[i];
    if (report != NULL)
        *report = local;
    return 0;
}

double nongaussian_bytes(const struct grid *grid, size_t mode_x, size_t mode_y,
                         const struct surface_options *options) {
    double arrays = options->iteration == ITERATION_PLAIN ? 2 : 3;
    return sizeof(struct nongaussian) + (is_fast(options) ? fast_step_bytes(grid) : 0) +
           height_error_bytes(grid) +
           sizeof(double) * (double)(mode_x + 1) * (double)(2 * mode_y + 1) +
           sizeof(double) * arrays * (double)grid_points(grid) +
           (double)ranker_bytes(grid_points(grid));
}
