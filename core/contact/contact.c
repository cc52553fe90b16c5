#include "core/contact/contact.h"
#include "core/contact/flattening.h"
#include "core/contact/solver/conjugate_gradient.h"
#include "core/statistics/heights/roughness.h"
#include "core/sum.h"
#include "core/theory/contact.h"
#include <fftw3.h>
#include <float.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct contact_options CONTACT_DEFAULTS = {
    .tolerance = 1e-8, .max_iterations = 5000, .stall_iterations = 400, .hardness = INFINITY};

/* Sides up to this number of nodes take the max_iterations of the options. */
static const double SIDE_USUAL = 4096;

/* The first set is so many times what Persson's theory expects in contact. Of 1, 1.6 and 2 this
 * took the fewest steps. */
static const double FIRST_SET = 2;

/* Below this hardness, in E* h', each rising load starts from the highest nodes: those that
 * Persson's theory expects in contact, a part of those that it expects open, and the one that bears
 * what is left. With half as many again in all, loads at 0.05 and 0.1 E* h' took half as many
 * transforms again. Paths that started from the load before took more, too. */
static const double LOW_HARDNESS = 0.7, LIMITED_PART = 0.05, LIMITED_NODES = 1.5;

/* Largest residual of a tangent over its approach: times the root of the tolerance, and at most.
 * The error of the stiffness is the square of that residual, times 0.1 on white noise and 0.001 on
 * surfaces that are resolved. Areas of elements see the tangent node by node. */
static const double TANGENT_PART = 3, TANGENT_PART_ELEMENTS = 1, TANGENT_MOST = 0.1;
/* The residual of unloading over that: of its tangent the stiffness alone is used. */
static const double TANGENT_UNLOADING = 10;

/* Pressures of a lowered face may exceed the hardness by this part, which is far above what the
 * solver leaves. */
static const double LOWERED_MOST = 1e-3;

/* In this file heights are in units of the surface's RMS height and pressures in RMS height over
 * the largest compliance, so that all numbers are near 1 whatever the user's units. */
struct contact {
    const struct compliance *compliance; /* borrowed */
    struct contact_options options;
    struct conjugate_gradient solver; /* its heights are the weighted ones */
    double *z;                        /* heights, mean 0; without weighting the solver's */
    double *pressure, *gap;           /* results, in the user's units: scratch of the solver */
    double *opening; /* the weighted gap; without weighting the same array as gap */
    double unit;     /* RMS height, the grid's length; for a flat surface 0, where open lx */
    double highest;  /* of the solver's heights */
    double full;     /* smallest mean pressure of full contact */
    double peak;     /* by which the largest pressure of full contact exceeds the mean */
    double flatten;  /* RMS of the pressures that flatten the surface, but for their mean; where
                        open about that, by the slope */
    double mean;     /* mean of the solver's p, the load that it solves; 0 before the first load */
    bool tangent;    /* the solver's q is the tangent at the last load, else the secant to it */
    struct flattening flattening; /* without arrays where the hardness is INFINITY */
    double *last; /* without tangent: the solver's p at the load before; NULL with it */
};

static bool has_tangent(const struct contact_options *options, const struct block *block) {
    return !options->without_tangent || block->model == MODEL_LAYERED;
}

double contact_bytes(const struct grid *grid, const struct block *block,
                     const struct contact_options *options) {
    double arrays = (compliance_has_weight(block) ? 2 : 0) + (has_tangent(options, block) ? 0 : 1);
    return sizeof(double) * arrays * (double)grid_points(grid) +
           conjugate_gradient_bytes(grid, block) +
           (isfinite(options->hardness) ? flattening_bytes(grid) : 0);
}

static int options_check(const struct contact_options *options, struct error *err) {
    if (!(options->tolerance > 0 && options->tolerance < 1))
        return error_set(err, ERROR_INPUT, "contact tolerance = %g; allowed: above 0, below 1",
                         options->tolerance);
    if (!(options->hardness > 0))
        return error_set(err, ERROR_INPUT, "hardness = %g E*; allowed: above 0, or infinite",
                         options->hardness);
    return 0;
}

int contact_create(struct contact **out, const struct compliance *compliance,
                   const struct contact_options *options, struct error *err) {
    if (options_check(options, err) != 0)
        return ERROR_INPUT;
    struct contact *c = array_create(1, sizeof *c);
    if (c == NULL)
        return error_memory(err, sizeof *c, "a contact");
    c->compliance = compliance;
    c->options = *options;
    c->tangent = has_tangent(options, &compliance->block);
    c->flattening.hardness = INFINITY;
    int status = conjugate_gradient_create(&c->solver, compliance, err);
    size_t n = c->solver.n;
    c->z = c->solver.z;
    c->pressure = c->solver.t;
    c->gap = c->opening = c->solver.u;
    if (status == 0 && compliance->weight != NULL) {
        c->z = array_create(n, sizeof(double));
        c->opening = array_create(n, sizeof(double));
        if (c->z == NULL || c->opening == NULL)
            status = error_memory(err, 2 * n * sizeof(double), "a contact");
    }
    if (status == 0 && !c->tangent) {
        c->last = array_create(n, sizeof(double));
        if (c->last == NULL)
            status = error_memory(err, n * sizeof(double), "a contact");
    }
    if (status == 0 && isfinite(options->hardness))
        status = flattening_create(&c->flattening, &c->solver, err);
    if (status != 0)
        contact_destroy(&c);
    *out = c;
    return status;
}

void contact_destroy(struct contact **contact) {
    struct contact *c = *contact;
    if (c == NULL)
        return;
    if (c->compliance->weight != NULL) {
        free(c->z);
        free(c->opening);
    }
    conjugate_gradient_clear(&c->solver);
    flattening_clear(&c->flattening);
    free(c->last);
    free(c);
    *contact = NULL;
}

void contact_set_stop(struct contact *c, int (*stop)(void *context), void *context) {
    c->solver.stop = stop;
    c->solver.stop_context = context;
}

int contact_set_team(struct contact *c, struct team *team, struct error *err) {
    return conjugate_gradient_set_team(&c->solver, team, err);
}

/* Returns the unit of the solver's pressures, in E*. */
static double pressure_unit(const struct contact *c) {
    return c->unit / c->solver.largest;
}

/* Fills z, mean 0 and RMS 1 (0 for a flat surface), and unit. */
static int take_heights(struct contact *c, const double *z, struct error *err) {
    size_t n = c->solver.n;
    double most = 0;
    struct sum sum = {0}, square = {0};
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(z[i]))
            return error_set(err, ERROR_INPUT, "height %zu of the surface = %g is not finite", i,
                             z[i]);
        most = fmax(most, fabs(z[i]));
    }
    /* Heights are divided by the largest first, because squares of huge or tiny heights would
     * overflow or underflow. */
    for (size_t i = 0; i < n; i++)
        sum_add(&sum, most > 0 ? z[i] / most : 0);
    double mean = sum_value(&sum) / (double)n;
    for (size_t i = 0; i < n; i++) {
        c->z[i] = most > 0 ? z[i] / most - mean : 0;
        sum_add(&square, c->z[i] * c->z[i]);
    }
    double rms = sqrt(sum_value(&square) / (double)n);
    bool is_flat = !(rms > 1e-14);
    double flat = c->compliance->open ? c->compliance->grid.lx : 0;
    c->unit = is_flat ? flat : rms * most;
    for (size_t i = 0; i < n; i++)
        c->z[i] = is_flat ? 0 : c->z[i] / rms;
    return 0;
}

/* Measures the pressures that flatten the face. */
static void measure_flat(struct contact *c) {
    struct conjugate_gradient *d = &c->solver;
    struct sum square = {0};
    c->full = INFINITY;
    if (c->compliance->open) {
        const struct measured_map map = {&c->compliance->grid, d->z, BOUNDARY_OPEN};
        struct roughness roughness;
        open_roughness_measure(&map, &roughness);
        c->flatten = roughness.rms_slope * d->largest / 2;
        return;
    }
    transform_filter(d->transform, d->inverse, 1, d->z, d->w);
    c->full = c->peak = 0;
    for (size_t i = 0; i < d->n; i++) {
        c->full = fmax(c->full, -d->w[i]);
        c->peak = fmax(c->peak, d->w[i]);
        sum_add(&square, d->w[i] * d->w[i]);
    }
    c->flatten = sqrt(sum_value(&square) / (double)d->n);
}

int contact_begin(struct contact *c, const double *z, struct error *err) {
    struct conjugate_gradient *d = &c->solver;
    c->mean = 0;
    int status = take_heights(c, z, err);
    if (status != 0)
        return status;
    /* The results of a surface must not depend on the surface before. */
    memset(d->q, 0, d->padded * sizeof *d->q);
    if (c->compliance->weight != NULL)
        transform_filter(d->transform, c->compliance->weight, 1, c->z, d->z);
    c->highest = 0;
    for (size_t i = 0; i < d->n; i++)
        c->highest = fmax(c->highest, d->z[i]);
    measure_flat(c);
    if (isfinite(c->options.hardness))
        flattening_begin(&c->flattening, d, c->options.hardness / pressure_unit(c));
    return 0;
}

double contact_full_pressure(const struct contact *c) {
    return c->compliance->open ? INFINITY : c->full * pressure_unit(c);
}

static double stiffness_of(struct contact *c, const double *set, double residual) {
    struct conjugate_gradient *d = &c->solver;
    return 1 / (conjugate_gradient_tangent(d, set, residual) * d->largest);
}

double contact_held_stiffness(struct contact *c, const double *p, double residual) {
    struct conjugate_gradient *d = &c->solver;
    size_t nodes = 0;
    c->mean = 0;
    d->stopped = false;
    memset(d->q, 0, d->padded * sizeof *d->q); /* the digits do not depend on the set before */
    for (size_t i = 0; i < d->n; i++) {
        d->p[i] = p[i] > 0 ? p[i] : 0;
        nodes += p[i] > 0;
    }
    if (nodes == 0)
        return 0;
    if (nodes == d->n && !c->compliance->open)
        return INFINITY;
    return stiffness_of(c, d->p, residual);
}

/* Lowers the face in gaps that were computed from heights as they were: the solver's (weighted)
 * ones are, unless it has the lowered face, and without weighting c->z is the same array. */
static void lower_gaps(struct contact *c) {
    const struct flattening *f = &c->flattening;
    const bool weighted = c->compliance->weight != NULL;
    for (size_t i = 0; f->volume > 0 && i < c->solver.n; i++) {
        if (weighted || !f->lowered)
            c->gap[i] += f->depth[i];
        if (weighted && !f->lowered)
            c->opening[i] += f->depth[i];
    }
}

/* The state without contact: the highest point touches the flat without force. */
static void fill_open(struct contact *c, struct contact_state *out) {
    struct conjugate_gradient *d = &c->solver;
    double highest = c->highest;
    if (c->flattening.volume > 0) {
        flattening_turn(&c->flattening, d, 0, c->unit);
        highest = -INFINITY;
        for (size_t i = 0; i < d->n; i++)
            highest = fmax(highest, d->z[i]);
    }
    for (size_t i = 0; i < d->n; i++) {
        c->pressure[i] = 0;
        c->gap[i] = (highest - c->z[i]) * c->unit;
        c->opening[i] = (highest - d->z[i]) * c->unit;
    }
    out->approach = (c->highest - highest) * c->unit;
    out->mean_gap = highest * c->unit + c->flattening.volume;
    out->unload_stiffness = isfinite(c->options.hardness) ? 0 : (double)NAN;
    lower_gaps(c);
}

/* The state of full contact: the pressures are those that flatten the surface (F9.3). */
static void fill_full(struct contact *c, double pressure, struct contact_state *out) {
    struct conjugate_gradient *d = &c->solver;
    transform_filter(d->transform, d->inverse, pressure_unit(c), d->z, c->pressure);
    for (size_t i = 0; i < d->n; i++) {
        c->pressure[i] = fmax(DBL_MIN, c->pressure[i] + pressure); /* a node in contact has p > 0 */
        c->gap[i] = c->opening[i] = 0;
    }
    out->approach = c->highest * c->unit;
    out->stiffness = INFINITY;
    out->unload_stiffness = isfinite(c->options.hardness) ? INFINITY : (double)NAN;
    out->nodes = d->n;
    out->work = 2 * (double)d->n;
}

static double tangent_residual(const struct contact *c) {
    bool elements = c->compliance->block.model == MODEL_LAYERED;
    double part = elements ? TANGENT_PART_ELEMENTS : TANGENT_PART;
    return fmin(TANGENT_MOST, part * sqrt(c->options.tolerance));
}

/* Fills the stiffness of unloading, under which all nodes resist, and returns the nodes that do
 * under a rising load. */
static const double *fill_unloading(struct contact *c, bool full, struct contact_state *out) {
    struct conjugate_gradient *d = &c->solver;
    struct flattening *f = &c->flattening;
    out->unload_stiffness = full ? INFINITY : (double)NAN;
    if (c->tangent && !full) {
        flattening_swap(f, d);
        out->unload_stiffness =
            stiffness_of(c, d->p, fmin(TANGENT_MOST, TANGENT_UNLOADING * tangent_residual(c)));
        flattening_swap(f, d);
    }
    for (size_t i = 0; i < d->padded; i++)
        f->kept[i] = d->p[i] < f->hardness ? d->p[i] : 0;
    return f->kept;
}

/* Fills stiffnesses, and the tangent by the load. */
static void fill_tangent(struct contact *c, struct contact_state *out) {
    struct conjugate_gradient *d = &c->solver;
    const double *set = d->p;
    bool full = out->nodes == d->n && !c->compliance->open;
    if (out->yielded > 0) {
        set = fill_unloading(c, full, out);
        full = false;
    }
    out->stiffness = full ? INFINITY : c->tangent && out->yielded == out->nodes ? 0 : (double)NAN;
    if (c->tangent && !full && out->yielded < out->nodes) {
        out->stiffness = stiffness_of(c, set, tangent_residual(c));
        out->tangent = d->q;
    }
    if (isfinite(c->options.hardness) && out->yielded == 0)
        out->unload_stiffness = out->stiffness;
}

/* Fills what the hardness does to a solution on the face as it was. */
static void fill_yielded(struct contact *c, double approach, double mean,
                         struct contact_state *out) {
    struct flattening *f = &c->flattening;
    if (isfinite(c->solver.hardness))
        out->yielded = flattening_take(f, &c->solver, approach, mean, c->unit);
    out->plastic_load =
        out->yielded > 0 ? (double)out->yielded * f->hardness / (mean * (double)c->solver.n) : 0;
    out->plastic_volume = f->volume;
    out->permanent_approach = f->approach;
}

static void fill_partial(struct contact *c, const struct conjugate_gradient_end *end,
                         struct contact_state *out) {
    struct conjugate_gradient *d = &c->solver;
    struct sum gap = {0};
    if (c->compliance->weight != NULL) {
        for (size_t i = 0; i < d->n; i++)
            c->opening[i] = (d->u[i] - d->z[i] + end->approach) * c->unit;
        transform_filter(d->transform, c->compliance->length, 1 / d->largest, d->p, d->u);
    }
    for (size_t i = 0; i < d->n; i++) {
        double g = d->u[i] - c->z[i] + end->approach;
        sum_add(&gap, g);
        c->gap[i] = g * c->unit; /* in place of u */
        out->nodes += d->p[i] * pressure_unit(c) > 0;
    }
    out->mean_gap = sum_value(&gap) / (double)d->n * c->unit;
    lower_gaps(c);
    if (c->compliance->weight != NULL || !c->flattening.lowered)
        out->mean_gap += c->flattening.volume;
    out->approach = (c->highest - end->approach) * c->unit;
    out->iterations = end->iterations;
    out->violation = fmax(end->inside, fmax(end->penetration, end->lifted));
    out->penetration = end->penetration;
    if (out->nodes == d->n && c->compliance->open)
        out->mean_gap = 0; /* all of the rectangle touches: without rounding errors */
    fill_tangent(c, out);
    for (size_t i = 0; i < d->n; i++)
        c->pressure[i] = d->p[i] < d->hardness ? d->p[i] * pressure_unit(c) : c->options.hardness;
}

/* Without a tangent the next load is predicted by the secant from the last one. */
static void take_secant(struct contact *c, double change) {
    struct conjugate_gradient *d = &c->solver;
    for (size_t i = 0; i < d->n; i++)
        d->q[i] = (d->p[i] - c->last[i]) / change;
}

/* Guesses pressures for a first load, in proportion to how far the highest nodes stand out, of
 * which part is in contact. Returns their sum. */
static double guess(struct contact *c, double part) {
    struct conjugate_gradient *d = &c->solver;
    double sum = 0;
    size_t highest = (size_t)fmin(fmax(1, (double)d->n * part), (double)d->n - 1);
    memcpy(d->w, d->z, d->n * sizeof *d->w);
    double above = gsl_stats_select(d->w, 1, d->n, d->n - 1 - highest);
    for (size_t i = 0; i < d->n; i++)
        sum += d->p[i] = fmax(0, d->z[i] - above);
    return sum;
}

/* Scales pressures of this sum to a mean. All nodes have it where there is no sum: the load may
 * have fallen below the rounding of the last pressures, and the highest nodes may be equally high.
 */
static void scale_to_mean(struct contact *c, double mean, double sum) {
    struct conjugate_gradient *d = &c->solver;
    double factor = mean * (double)d->n / sum;
    for (size_t i = 0; i < d->n; i++)
        d->p[i] = isfinite(factor) ? d->p[i] * factor : mean;
}

/* Predicts the pressures at a mean from those of the last load and their tangent or secant, and
 * guesses them before the first load. */
static void predict(struct contact *c, double mean) {
    struct conjugate_gradient *d = &c->solver;
    double sum = 0;
    for (size_t i = 0; !c->tangent && i < d->n; i++)
        c->last[i] = c->mean > 0 ? d->p[i] : 0;
    if (c->mean > 0)
        for (size_t i = 0; i < d->n; i++)
            sum += d->p[i] = fmax(0, d->p[i] + (mean - c->mean) * d->q[i]);
    else if (!grid_is_profile(&c->compliance->grid))
        sum = guess(c, FIRST_SET * erf(mean / (M_SQRT2 * c->flatten)));
    scale_to_mean(c, mean, sum);
}

/* Returns the limit of iterations, which grows with the square root of the longer side, as their
 * number does. */
static size_t iterations_most(const struct contact *c) {
    const struct grid *grid = &c->compliance->grid;
    double side = fmax((double)grid->nx, (double)grid->ny);
    return (size_t)((double)c->options.max_iterations * fmax(1, sqrt(side / SIDE_USUAL)));
}

static void solve(struct contact *c, double mean, struct conjugate_gradient_end *end) {
    conjugate_gradient_run(&c->solver, mean, c->options.tolerance, c->options.stall_iterations,
                           iterations_most(c), end);
}

/* Guesses pressures for a load that the hardness limits: those of the highest nodes, in
 * proportion to how far they stand out, and at the hardness where that is more. */
static void guess_limited(struct contact *c, double mean) {
    struct conjugate_gradient *d = &c->solver;
    const double unit = 2 * c->flatten, load = mean / unit, hardness = d->hardness / unit;
    double part = persson_plastic_area(load, hardness) + persson_elastic_area(load, hardness);
    double nodes = part * (1 + LIMITED_PART * (1 - part)) * (double)d->n + LIMITED_NODES;
    scale_to_mean(c, mean, guess(c, nodes / (double)d->n));
    flattening_limit(&c->flattening, d, mean);
}

/* Solves on the face as it was. Where no node ends at the hardness, the digits are those without
 * one. */
static void solve_limited(struct contact *c, double mean, struct conjugate_gradient_end *end) {
    struct conjugate_gradient *d = &c->solver;
    struct flattening *f = &c->flattening;
    memcpy(f->kept, d->p, d->n * sizeof *d->p);
    predict(c, mean);
    bool limited = flattening_limit(f, d, mean);
    if ((c->mean == 0 && limited) || d->hardness < LOW_HARDNESS * 2 * c->flatten) {
        guess_limited(c, mean);
        limited = true;
    }
    solve(c, mean, end);
    if (!(limited || end->bounded) || !end->converged)
        return;
    for (size_t i = 0; i < d->n; i++)
        if (d->p[i] >= d->hardness)
            return;
    memcpy(d->p, f->kept, d->n * sizeof *d->p);
    d->hardness = INFINITY;
    predict(c, mean);
    solve(c, mean, end);
    d->hardness = f->hardness;
}

/* A lowered face is elastic as long as pressures fall with the load. Under a stiff coating, which
 * bends as a plate does, they may rise in places, beyond the hardness (F21.3). */
static int check_lowered(const struct contact *c, double pressure, struct error *err) {
    const struct flattening *f = &c->flattening;
    double highest = 0;
    if (!f->lowered || !block_is_coated(&c->compliance->block))
        return 0;
    for (size_t i = 0; i < c->solver.n; i++)
        highest = fmax(highest, c->solver.p[i]);
    if (highest <= (1 + LOWERED_MOST) * f->hardness)
        return 0;
    return error_set(err, ERROR_NUMERIC,
                     "contact under a mean pressure of %g E* after %g E*: places would bear %.3g "
                     "times the hardness, %g E*, again; under a coating of %g times the modulus "
                     "they yield as the load falls, which is not computed",
                     pressure, f->highest * pressure_unit(c), highest / f->hardness,
                     c->options.hardness, c->compliance->block.coating.modulus);
}

static int press_partial(struct contact *c, double pressure, struct contact_state *out,
                         struct error *err) {
    struct conjugate_gradient *d = &c->solver;
    struct conjugate_gradient_end end;
    double mean = pressure / pressure_unit(c);
    d->transforms = 0;
    d->stopped = false;
    flattening_turn(&c->flattening, d, mean, c->unit);
    if (isfinite(d->hardness))
        solve_limited(c, mean, &end);
    else {
        predict(c, mean);
        solve(c, mean, &end);
    }
    if (!end.converged)
        c->mean = 0;
    if (end.stopped)
        return error_set(err, ERROR_STOPPED, "stopped after %zu iterations of contact",
                         end.iterations);
    if (!end.converged)
        return error_set(err, ERROR_NUMERIC,
                         "contact under a mean pressure of %g E* did not converge: %zu iterations "
                         "left gaps of %.2g and penetrations of %.2g RMS heights",
                         pressure, end.iterations, end.inside, end.penetration);
    int status = check_lowered(c, pressure, err);
    if (status != 0) {
        c->mean = 0;
        return status;
    }
    if (!c->tangent && mean != c->mean)
        take_secant(c, mean - c->mean);
    c->mean = mean;
    fill_yielded(c, end.approach, mean, out);
    fill_partial(c, &end, out);
    out->work = d->transforms * (double)d->n;
    if (d->stopped) {
        c->mean = 0;
        return error_set(err, ERROR_STOPPED,
                         "stopped after %zu iterations of contact, in those of "
                         "its stiffness",
                         end.iterations);
    }
    return 0;
}

/* Returns whether all of the face touches without yielding, at a load of full contact. */
static bool is_full(const struct contact *c, double pressure) {
    return pressure >= contact_full_pressure(c) && !(c->flattening.volume > 0) &&
           !(pressure + c->peak * pressure_unit(c) > c->options.hardness);
}

int contact_press(struct contact *c, double pressure, struct contact_state *out,
                  struct error *err) {
    if (!(pressure >= 0 && isfinite(pressure)))
        return error_set(err, ERROR_INPUT, "mean pressure = %g; allowed: 0 or more, finite",
                         pressure);
    if (pressure >= c->options.hardness)
        return error_set(err, ERROR_INPUT,
                         "mean pressure = %g E* on a face of hardness %g E*; allowed: below the "
                         "hardness",
                         pressure, c->options.hardness);
    struct contact_state state = {.pressure = pressure,
                                  .unload_stiffness = NAN,
                                  .plastic_volume = c->flattening.volume,
                                  .permanent_approach = c->flattening.approach,
                                  .depth = c->flattening.depth,
                                  .p = c->pressure,
                                  .gap = c->gap,
                                  .opening = c->opening,
                                  .scratch = c->solver.w};
    if (pressure == 0)
        fill_open(c, &state);
    else if (is_full(c, pressure))
        fill_full(c, pressure, &state);
    else {
        int status = press_partial(c, pressure, &state, err);
        if (status != 0)
            return status;
    }
    *out = state;
    return 0;
}
