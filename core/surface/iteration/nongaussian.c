#include "core/surface/iteration/nongaussian.h"
#include "core/surface/iteration/height_error.h"
#include "core/surface/iteration/rank.h"
#include "core/surface/iteration/rank_table.h"
#include "core/surface/iteration/target_heights.h"
#include "core/surface/spectrum.h"
#include "core/surface/transform.h"
#include "core/vectors.h"
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The surface of a given spectrum that is nearest to another one: phases stay, amplitudes are given
 * (FORMULAS.md, F5.1). */

/* Returns a mode with the given amplitude and the phase of `mode`, or the phase 0 where that is 0.
 */
static double complex with_amplitude(double complex mode, double amplitude) {
    double size = sqrt(creal(mode) * creal(mode) + cimag(mode) * cimag(mode));
    return size > 0 ? amplitude / size * mode : amplitude;
}

/* A column that is its own mirror image (mx = 0, and Nyquist of an even nx): rows my > 0 determine
 * the others, so that the symmetry is exact; modes that are their own conjugates keep their
 * sign. */
static void mirror_column_impose(double complex *column, const double *amplitude, size_t ny,
                                 size_t mode_y) {
    for (size_t my = 0; my <= mode_y; my++) {
        if (my == 0 || 2 * my == ny) {
            column[my] = creal(column[my]) < 0 ? -amplitude[mode_y + my] : amplitude[mode_y + my];
            continue;
        }
        column[my] = with_amplitude(column[my], amplitude[mode_y + my]);
        column[ny - my] = conj(column[my]);
    }
}

/* Amplitudes of a band, laid out as modes->power. */
struct band {
    const struct modes *modes;
    const double *amplitude;
};

/* Sets the amplitudes of a column of a half spectrum (as transforms on the grid and band of modes
 * have it); its other modes become zero. */
static void column_impose(const void *context, size_t mx, double complex *column) {
    const struct band *band = context;
    const struct grid *grid = &band->modes->grid;
    size_t mode_y = band->modes->mode_y, ny = grid->ny;
    const double *wanted = band->amplitude + mx * (2 * mode_y + 1);
    if (2 * mode_y + 1 < ny)
        memset(column + mode_y + 1, 0, (ny - 2 * mode_y - 1) * sizeof *column);
    if (mx == 0 || 2 * mx == grid->nx) {
        mirror_column_impose(column, wanted, ny, mode_y);
        return;
    }
    for (size_t my = 0; my <= mode_y; my++)
        column[my] = with_amplitude(column[my], wanted[mode_y + my]);
    for (size_t my = 1; my <= mode_y && 2 * my != ny; my++)
        column[ny - my] = with_amplitude(column[ny - my], wanted[mode_y - my]);
}

static void amplitudes_impose(const struct band *band, double complex *spectrum) {
    for (size_t mx = 0; mx <= band->modes->mode_x; mx++)
        column_impose(band, mx, spectrum + mx * band->modes->grid.ny);
}

/* A step of the alternation between spectrum and heights that ranks by a table (rank_table.h) and
 * processes rows while they are in cache. Heights are in standard deviations. */

/* With s the surface of exact spectrum nearest to the iterate and h the heights in the order of y:
 *     momentum     y = s,        next iterate h + factor (h - h of the step before);
 *     reflection   y = 2 s - x,  next iterate x <- factor (x + h) + (1 - 2 factor) s
 * (FORMULAS.md, F5.4 and F5.6). */
enum fast_kind { FAST_MOMENTUM, FAST_REFLECTION };

struct fast_move {
    enum fast_kind kind;
    double factor;
    bool first; /* the first step of its kind: x is s, and h of the step before is h */
};

/* Points handled together fit into the first-level cache, two rows of up to PREFETCHED into the
 * second. */
enum { POINTS = 1024, PREFETCHED = 8192 };
/* The range of keys of a step is that of the step before, widened by this part on both sides. */
static const double WIDER = 1.0 / 16;

struct fast_step {
    const struct modes *modes;
    struct rank_table *table;
    double low, high; /* range of the last keys */
};

static void fast_step_destroy(struct fast_step **step) {
    if (*step == NULL)
        return;
    rank_table_destroy(&(*step)->table);
    free(*step);
    *step = NULL;
}

/* Borrows all arguments, as the steps do. ERROR_MEMORY. */
static int fast_step_create(struct fast_step **out, const struct modes *modes, struct error *err) {
    struct fast_step *step = array_create(1, sizeof *step);
    if (step == NULL)
        return error_memory(err, sizeof *step, "a step of generation");
    step->modes = modes;
    int status = rank_table_create(&step->table, grid_points(&modes->grid), err);
    if (status != 0)
        fast_step_destroy(&step);
    *out = step;
    return status;
}

static double fast_step_bytes(const struct grid *grid) {
    return sizeof(struct fast_step) + rank_table_bytes(grid_points(grid));
}

/* Begins a run with this surface. */
static void fast_step_start(struct fast_step *step, const double *z) {
    step->low = step->high = z[0];
    for (size_t i = 0; i < grid_points(&step->modes->grid); i++) {
        step->low = z[i] < step->low ? z[i] : step->low;
        step->high = z[i] > step->high ? z[i] : step->high;
    }
}

/* y from s; at the first step x is s. */
WIDE_VECTORS static void reflect(size_t n, const double *restrict s, double *restrict x, bool first,
                                 double *restrict y) {
    for (size_t i = 0; i < n && first; i++)
        x[i] = s[i];
    for (size_t i = 0; i < n; i++)
        y[i] = 2 * s[i] - x[i];
}

/* One pass of a step over the rows. z, x: one value a point. */
struct sweep {
    struct fast_step *step;
    struct fast_move move;
    double *z, *x;
    struct height_error *errors; /* NULL: none are counted */
};

/* Has row j of an array brought near while the row before it is transformed: two arrays of 1024 x
 * 1024 points are no longer in cache when their turn comes. */
static void row_prefetch(const struct sweep *sweep, const double *array, size_t j) {
    enum { LINE = 8 };
    const struct grid *grid = &sweep->step->modes->grid;
    if (j >= grid->ny || grid->nx > PREFETCHED)
        return;
    for (size_t i = 0; i < grid->nx; i += LINE)
        __builtin_prefetch(array + j * grid->nx + i);
}

/* Computes and counts the keys y of a row s; where errors are given, s itself, too. */
static void row_count(void *context, size_t j, double *s) {
    const struct sweep *sweep = context;
    const size_t nx = sweep->step->modes->grid.nx;
    const bool reflected = sweep->move.kind == FAST_REFLECTION;
    for (size_t i = 0; i < nx; i += POINTS) {
        size_t n = nx - i < POINTS ? nx - i : POINTS;
        double *y = sweep->z + j * nx + i;
        if (sweep->errors != NULL)
            height_error_heights_add(sweep->errors, n, s + i);
        if (reflected)
            reflect(n, s + i, sweep->x + j * nx + i, sweep->move.first, y);
        else
            memcpy(y, s + i, n * sizeof *y);
        rank_table_count(sweep->step->table, n, y);
    }
    if (reflected)
        row_prefetch(sweep, sweep->x, j + 1);
}

/* Replaces n heights h by the next iterate, and updates x. s is the mean of x and y. */
WIDE_VECTORS static void move_points(struct fast_move move, size_t n, const double *restrict y,
                                     double *restrict h, double *restrict x) {
    double b = move.factor;
    if (move.kind == FAST_REFLECTION)
        for (size_t i = 0; i < n; i++)
            h[i] = x[i] = b * (x[i] + h[i]) + (0.5 - b) * (x[i] + y[i]);
    else
        for (size_t i = 0; i < n; i++) {
            double here = h[i];
            h[i] += move.first ? 0 : b * (here - x[i]);
            x[i] = here;
        }
}

/* Fills a row with the next iterate. */
static void row_move(void *context, size_t j, double *h) {
    const struct sweep *sweep = context;
    const size_t nx = sweep->step->modes->grid.nx;
    for (size_t i = 0; i < nx; i += POINTS) {
        size_t n = nx - i < POINTS ? nx - i : POINTS;
        const double *y = sweep->z + j * nx + i;
        rank_table_order(sweep->step->table, n, y, h + i);
        move_points(sweep->move, n, y, h + i, sweep->x + j * nx + i);
    }
    row_prefetch(sweep, sweep->z, j + 1);
    row_prefetch(sweep, sweep->x, j + 1);
}

/* From the rows of an iterate, transformed forward without their columns, to those of the next.
 * amplitude: of s, laid out as modes->power. sorted: the heights, rising. z, x: one value a point;
 * z is overwritten by y, and x is kept between steps of a kind. Returns eps_h of s where errors are
 * given, NaN where NULL. */
static double fast_step_run(struct fast_step *step, struct transform *transform,
                            const double *amplitude, const double *sorted, struct fast_move move,
                            double *z, double *x, struct height_error *errors) {
    const struct band band = {step->modes, amplitude};
    transform_change_columns(transform, column_impose, &band);
    struct sweep sweep = {step, move, z, x, errors};
    double wider = WIDER * (step->high - step->low);
    if (errors != NULL)
        height_error_heights_start(errors);
    rank_table_start(step->table, step->low - wider, step->high + wider);
    transform_inverse_each(transform, row_count, &sweep);
    rank_table_finish(step->table, sorted, &step->low, &step->high);
    transform_forward_each(transform, row_move, &sweep);
    return errors != NULL ? height_error_heights(errors) : (double)NAN;
}

/* Schedule of ITERATION_RELAXED: this many of RELAXED_PARTS are momentum, the rest reflections.
 * POLISHING plain iterations follow, as behind every iteration but ITERATION_PLAIN, and make the
 * surface satisfy the constraints. */
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
    double *x;      /* points: iterate of reflections, or last one of momentum; NULL for the plain
                       iteration */
    struct fast_step *fast; /* NULL for iterations that always rank exactly */
    struct height_error *height_error;
    double limit;         /* of the largest error with its weight */
    double heights_limit; /* of eps_h */
};

static bool is_fast(const struct surface_options *options) {
    return options->iteration == ITERATION_REFLECTIONS || options->iteration == ITERATION_MOMENTUM;
}

/* Returns whether an error has a tolerance of its own. */
static bool has_own(const struct surface_options *o) {
    return o->tolerance_h != 0 || o->tolerance_s != 0 || o->tolerance_s0 != 0;
}

static int options_check(const struct surface_options *o, struct error *err) {
    if (!(o->tolerance >= 0 && isfinite(o->tolerance)))
        return error_set(err, ERROR_INPUT, "tolerance = %g; allowed: 0 or more", o->tolerance);
    if (!(o->tolerance_h >= 0 && o->tolerance_s >= 0 && o->tolerance_s0 >= 0) ||
        (has_own(o) && !(o->tolerance > 0)))
        return error_set(err, ERROR_INPUT,
                         "tolerances = %g, %g, %g; allowed: 0 or more, beside a tolerance above 0",
                         o->tolerance_h, o->tolerance_s, o->tolerance_s0);
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

/* Sets the weights of errors, by which the largest is at most `limit` where all are within their
 * tolerances. */
static void tolerances_set(struct nongaussian *g) {
    const struct surface_options *o = &g->options;
    const double own[3] = {o->tolerance_h, o->tolerance_s, o->tolerance_s0};
    double weights[3] = {1, 1, 1};
    g->limit = has_own(o) ? 1 : o->tolerance;
    g->heights_limit = o->tolerance_h > 0 ? o->tolerance_h : o->tolerance;
    for (size_t a = 0; a < 3 && has_own(o); a++)
        weights[a] = 1 / (own[a] > 0 ? own[a] : o->tolerance);
    height_error_weigh(g->height_error, weights);
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
    g->sorted = array_create(g->points, sizeof *g->sorted);
    g->h = array_create(g->points, sizeof *g->h);
    g->x = plain ? NULL : array_create(g->points, sizeof *g->x);
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
    tolerances_set(g);
    *out = g;
    return 0;
}

void nongaussian_destroy(struct nongaussian **nongaussian) {
    struct nongaussian *g = *nongaussian;
    if (g == NULL)
        return;
    ranker_destroy(&g->ranker);
    free(g->sorted);
    free(g->h);
    free(g->x);
    fast_step_destroy(&g->fast);
    height_error_destroy(&g->height_error);
    free(g->amplitude);
    free(g);
    *nongaussian = NULL;
}

static bool is_stopped(const struct nongaussian *g) {
    return g->options.stop != NULL && g->options.stop(g->options.stop_context) != 0;
}

/* The steps below begin with the transform's spectrum of an iterate and end with that of the
 * next. */

/* Begins an iteration: computes z_s in z, the surface of exact spectrum nearest to the iterate. */
static int spectral_surface(const struct nongaussian *g, struct transform *transform, double *z,
                            struct error *err) {
    if (is_stopped(g))
        return error_set(err, ERROR_STOPPED, "stopped while a surface was made");
    amplitudes_impose(&(struct band){g->modes, g->amplitude}, transform_spectrum(transform));
    transform_inverse(transform, z);
    return 0;
}

/* Alternation with the momentum of Nesterov (1983): the next iterate is z_h, extrapolated along its
 * last step. */
static int accelerated_phase(struct nongaussian *g, struct transform *transform, double *z,
                             size_t iterations, struct error *err) {
    double *last = g->x;
    for (size_t iteration = 0; iteration < iterations; iteration++) {
        int status = spectral_surface(g, transform, z, err);
        if (status == 0)
            status = rank_order(g->ranker, z, g->sorted, g->h, err);
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
 *
 *     x <- b (x + h) + (1 - 2 b) s.
 *
 * b rises evenly from the relaxation by three quarters of its distance from 1. z stores y. */
static int relaxed_phase(struct nongaussian *g, struct transform *transform, double *z,
                         size_t iterations, struct error *err) {
    double *x = g->x;
    double first = g->options.relaxation;
    double rise = 0.75 * (1 - first);
    for (size_t iteration = 0; iteration < iterations; iteration++) {
        int status = spectral_surface(g, transform, z, err);
        if (status != 0)
            return status;
        if (iteration == 0)
            memcpy(x, z, g->points * sizeof *x);
        for (size_t i = 0; i < g->points; i++)
            z[i] = 2 * z[i] - x[i];
        status = rank_order(g->ranker, z, g->sorted, g->h, err);
        if (status != 0)
            return status;
        double progress = iterations > 1 ? (double)iteration / (double)(iterations - 1) : 0;
        double b = first + rise * progress;
        for (size_t i = 0; i < g->points; i++)
            x[i] = b * (x[i] + g->h[i]) + (0.5 - b) * (x[i] + z[i]);
        transform_forward(transform, x);
    }
    return 0;
}

static int plain_iterate(struct nongaussian *g, struct transform *transform, double *z,
                         struct error *err) {
    int status = spectral_surface(g, transform, z, err);
    if (status == 0)
        status = rank_order(g->ranker, z, g->sorted, g->h, err);
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
        if (worst <= g->limit)
            report->end = END_CONVERGED;
        else if (stuck >= options->stall_iterations)
            report->end = END_STALLED;
    }
    height_error_measure(g->height_error, z, g->h, spectrum, true, report);
    return 0;
}

/* ITERATION_REFLECTIONS. Plain alternation takes thousands of iterations to converge, and stalls
 * long before. Reflections reach its error after 1500 iterations in 50 to 90; no variant that was
 * tried is as fast without changing the statistics of surfaces.
 *
 * After this opening the C = 1 maximum and minimum (H = 0.8, ratio 4, 256 x 256, 16 surfaces) have
 * summits that differ from those of 6000 plain iterations by 1.1 +- 0.6 and 1.2 +- 0.9 % in number,
 * -0.5 and -0.4 % in mean height, -0.7 and 0.0 % in mean curvature. Plain iterations of 1500 and
 * 6000 differ by as much, or half of it (bench_nongaussian drift). Momentum alone gives curvatures
 * of the maximum that are 1 to 2 % off. Steps beyond the heights are faster early, but end with
 * other numbers of summits. On a grid of 4 points a shortest wave, where the heights between the
 * points are free, the number of summits stays low in all cases. */
enum { OPENING = 15, CHECKED_EACH = 5 };
static const double REFLECTION = 0.9;

static struct fast_move fast_move(enum surface_iteration iteration, size_t number) {
    if (iteration == ITERATION_REFLECTIONS && number >= OPENING)
        return (struct fast_move){FAST_REFLECTION, REFLECTION, number == OPENING};
    double t = (double)number;
    double momentum = number < 2 ? 0 : fmin(MOMENTUM_MOST, (t - 1) / (t + 2));
    return (struct fast_move){FAST_MOMENTUM, momentum, number == 0};
}

/* From rows transformed forward to rows transformed forward, as a step. Iterates until eps_h is
 * within the tolerance, or has not fallen by the share `stall_gain` in `stall_iterations`
 * (END_LIMIT: neither, or not yet known). The opening does not stall. */
static void fast_phase(struct nongaussian *g, struct transform *transform, double *z, size_t limit,
                       struct surface_report *report) {
    const struct surface_options *options = &g->options;
    bool opens = options->iteration == ITERATION_REFLECTIONS;
    double best = INFINITY;
    size_t best_at = 0;
    fast_step_start(g->fast, z);
    report->end = END_LIMIT;
    /* The plain iterations behind it find that it was stopped. */
    for (size_t number = 0; number < limit && report->end == END_LIMIT && !is_stopped(g);
         number++) {
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
        if (eps <= g->heights_limit)
            report->end = END_CONVERGED;
        else if (number - best_at >= options->stall_iterations)
            report->end = END_STALLED;
    }
}

/* Makes fast iterations and then plain ones: POLISHING of them, or where the fast ones reached the
 * tolerance, up to max_iterations. */
static int iterate_fast(struct nongaussian *g, struct transform *transform, double *z,
                        struct surface_report *report, struct error *err) {
    size_t most = g->options.max_iterations;
    size_t polishing = most < POLISHING ? most : POLISHING;
    transform_forward_rows(transform, 0, g->modes->grid.ny, z);
    fast_phase(g, transform, z, most - polishing, report);
    transform_forward_columns(transform);
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
    g->options.tolerance_h = g->options.tolerance_s = g->options.tolerance_s0 = 0;
    tolerances_set(g);
    g->options.stall_iterations = aim->stall_iterations;
    g->options.max_iterations = aim->max_iterations;
}

void nongaussian_set_stop(struct nongaussian *g, int (*stop)(void *context), void *context) {
    g->options.stop = stop;
    g->options.stop_context = context;
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
