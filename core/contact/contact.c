#include "core/contact/contact.h"
#include "core/contact/solver/conjugate_gradient.h"
#include "core/statistics/heights/roughness.h"
#include "core/sum.h"
#include <fftw3.h>
#include <float.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct contact_options CONTACT_DEFAULTS = {
    .tolerance = 1e-8, .max_iterations = 5000, .stall_iterations = 400};

/* Sides up to this number of nodes take the max_iterations of the options. */
static const double SIDE_USUAL = 4096;

/* The first set is so many times what Persson's theory expects in contact. Of 1, 1.6 and 2 this
 * took the fewest steps. */
static const double FIRST_SET = 2;

/* Largest residual of a tangent over its approach: times the root of the tolerance, and at most.
 * The error of the stiffness is the square of that residual, times 0.1 on white noise and 0.001 on
 * surfaces that are resolved. Areas of elements see the tangent node by node. */
static const double TANGENT_PART = 3, TANGENT_PART_ELEMENTS = 1, TANGENT_MOST = 0.1;

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
    double flatten;  /* RMS of the pressures that flatten the surface, but for their mean; where
                        open about that, by the slope */
    double mean;     /* mean of the solver's p, the load that it solves; 0 before the first load */
    bool tangent;    /* the solver's q is the tangent at the last load, else the secant to it */
    double *last;    /* without tangent: the solver's p at the load before; NULL with it */
};

double contact_bytes(const struct grid *grid, const struct block *block) {
    const double weighted = compliance_has_weight(block) ? 2 * (double)grid_points(grid) : 0;
    return sizeof(double) * weighted + conjugate_gradient_bytes(grid, block);
}

int contact_create(struct contact **out, const struct compliance *compliance,
                   const struct contact_options *options, struct error *err) {
    if (!(options->tolerance > 0 && options->tolerance < 1))
        return error_set(err, ERROR_INPUT, "contact tolerance = %g; allowed: above 0, below 1",
                         options->tolerance);
    struct contact *c = array_create(1, sizeof *c);
    if (c == NULL)
        return error_memory(err, sizeof *c, "a contact");
    c->compliance = compliance;
    c->options = *options;
    c->tangent = !options->without_tangent || compliance->block.model == MODEL_LAYERED;
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
    c->full = INFINITY;
    if (c->compliance->open) {
        const struct measured_map map = {&c->compliance->grid, d->z, BOUNDARY_OPEN};
        struct roughness roughness;
        open_roughness_measure(&map, &roughness);
        c->flatten = roughness.rms_slope * d->largest / 2;
        return 0;
    }
    transform_filter(d->transform, d->inverse, 1, d->z, d->w);
    struct sum square = {0};
    c->full = 0;
    for (size_t i = 0; i < d->n; i++) {
        c->full = fmax(c->full, -d->w[i]);
        sum_add(&square, d->w[i] * d->w[i]);
    }
    c->flatten = sqrt(sum_value(&square) / (double)d->n);
    return 0;
}

double contact_full_pressure(const struct contact *c) {
    return c->compliance->open ? INFINITY : c->full * pressure_unit(c);
}

double contact_held_stiffness(struct contact *c, const double *p, double residual) {
    struct conjugate_gradient *d = &c->solver;
    size_t nodes = 0;
    c->mean = 0;
    memset(d->q, 0, d->padded * sizeof *d->q); /* the digits do not depend on the set before */
    for (size_t i = 0; i < d->n; i++) {
        d->p[i] = p[i] > 0 ? p[i] : 0;
        nodes += p[i] > 0;
    }
    if (nodes == 0)
        return 0;
    if (nodes == d->n && !c->compliance->open)
        return INFINITY;
    return 1 / (conjugate_gradient_tangent(d, residual) * d->largest);
}

/* The state without contact: the highest point touches the flat without force. */
static void fill_open(struct contact *c, struct contact_state *out) {
    const struct conjugate_gradient *d = &c->solver;
    for (size_t i = 0; i < d->n; i++) {
        c->pressure[i] = 0;
        c->gap[i] = (c->highest - c->z[i]) * c->unit;
        c->opening[i] = (c->highest - d->z[i]) * c->unit;
    }
    out->mean_gap = c->highest * c->unit;
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
    out->nodes = d->n;
    out->work = 2 * (double)d->n;
}

static double tangent_residual(const struct contact *c) {
    bool elements = c->compliance->block.model == MODEL_LAYERED;
    double part = elements ? TANGENT_PART_ELEMENTS : TANGENT_PART;
    return fmin(TANGENT_MOST, part * sqrt(c->options.tolerance));
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
    out->approach = (c->highest - end->approach) * c->unit;
    out->iterations = end->iterations;
    out->violation = fmax(end->inside, end->penetration);
    out->penetration = end->penetration;
    /* All nodes can be in contact when the load is a rounding error below that of full contact. */
    bool full = out->nodes == d->n && !c->compliance->open;
    if (out->nodes == d->n && c->compliance->open)
        out->mean_gap = 0; /* without rounding errors */
    out->stiffness = full ? INFINITY : (double)NAN;
    if (c->tangent && !full) {
        out->stiffness = 1 / (conjugate_gradient_tangent(d, tangent_residual(c)) * d->largest);
        out->tangent = d->q;
    }
    for (size_t i = 0; i < d->n; i++)
        c->pressure[i] = d->p[i] * pressure_unit(c);
}

/* Without a tangent the next load is predicted by the secant from the last one. */
static void take_secant(struct contact *c, double change) {
    struct conjugate_gradient *d = &c->solver;
    for (size_t i = 0; i < d->n; i++)
        d->q[i] = (d->p[i] - c->last[i]) / change;
}

/* Guesses pressures for a first load, in proportion to how far the highest nodes stand out; their
 * number is that of FIRST_SET. Returns their sum. */
static double guess(struct contact *c, double mean) {
    struct conjugate_gradient *d = &c->solver;
    double part = FIRST_SET * erf(mean / (M_SQRT2 * c->flatten)), sum = 0;
    size_t highest = (size_t)fmin(fmax(1, (double)d->n * part), (double)d->n - 1);
    memcpy(d->w, d->z, d->n * sizeof *d->w);
    double above = gsl_stats_select(d->w, 1, d->n, d->n - 1 - highest);
    for (size_t i = 0; i < d->n; i++)
        sum += d->p[i] = fmax(0, d->z[i] - above);
    return sum;
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
        sum = guess(c, mean);
    /* When the load falls by many orders, it may be below the rounding of the last pressures. */
    double factor = mean * (double)d->n / sum;
    for (size_t i = 0; i < d->n; i++)
        d->p[i] = isfinite(factor) ? d->p[i] * factor : mean;
}

/* Returns the limit of iterations, which grows with the square root of the longer side, as their
 * number does. */
static size_t iterations_most(const struct contact *c) {
    const struct grid *grid = &c->compliance->grid;
    double side = fmax((double)grid->nx, (double)grid->ny);
    return (size_t)((double)c->options.max_iterations * fmax(1, sqrt(side / SIDE_USUAL)));
}

static int press_partial(struct contact *c, double pressure, struct contact_state *out,
                         struct error *err) {
    struct conjugate_gradient *d = &c->solver;
    struct conjugate_gradient_end end;
    double mean = pressure / pressure_unit(c);
    d->transforms = 0;
    predict(c, mean);
    conjugate_gradient_run(d, mean, c->options.tolerance, c->options.stall_iterations,
                           iterations_most(c), &end);
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
    if (!c->tangent && mean != c->mean)
        take_secant(c, mean - c->mean);
    c->mean = mean;
    fill_partial(c, &end, out);
    out->work = d->transforms * (double)d->n;
    return 0;
}

int contact_press(struct contact *c, double pressure, struct contact_state *out,
                  struct error *err) {
    if (!(pressure >= 0 && isfinite(pressure)))
        return error_set(err, ERROR_INPUT, "mean pressure = %g; allowed: 0 or more, finite",
                         pressure);
    struct contact_state state = {.pressure = pressure,
                                  .p = c->pressure,
                                  .gap = c->gap,
                                  .opening = c->opening,
                                  .scratch = c->solver.w};
    if (pressure == 0)
        fill_open(c, &state);
    else if (pressure >= contact_full_pressure(c))
        fill_full(c, pressure, &state);
    else {
        int status = press_partial(c, pressure, &state, err);
        if (status != 0)
            return status;
    }
    *out = state;
    return 0;
}
