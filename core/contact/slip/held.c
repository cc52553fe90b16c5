/* Conjugate gradients for the tractions t in the set of nodes, of a given mean, whose displacements
 * C t are the same at all of them: preconditioned as those of contact (solver/conjugate_step.h), by
 * the residual continued over the grid, multiplied, and brought back by the transpose. */
#include "core/contact/slip/held.h"
#include "core/contact/slip/transfer.h"
#include "core/contact/solver/lines.h"
#include "core/contact/solver/pyramid.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS_MOST = 1000, STEPS_ASK = 4 /* steps between calls of stop */, ARRAYS = 4 };

struct held {
    struct transfer transfer;
    struct pyramid pyramid; /* of surfaces */
    size_t n, count;        /* nodes, and those of the set */
    /* Fields of n values, owned: the tractions, their displacements less the mean of the set
     * (never 0 in it, 0 outside), the direction, and scratch. */
    double *t[FIELDS], *r[FIELDS], *d[FIELDS], *w[FIELDS];
    int (*stop)(void *context); /* held_set_stop; may be NULL */
    void *stop_context;
};

int held_create(struct held **out, const struct grid *grid, double poisson, struct error *err) {
    struct held *made = array_create(1, sizeof *made);
    if (made == NULL)
        return error_memory(err, sizeof *made, "a stiffness");
    int status = transfer_create(&made->transfer, grid, poisson, err);
    made->n = grid_points(grid);
    double **const arrays[ARRAYS] = {made->t, made->r, made->d, made->w};
    for (size_t f = 0; status == 0 && f < made->transfer.fields; f++)
        for (size_t a = 0; status == 0 && a < ARRAYS; a++) {
            arrays[a][f] = array_create(made->n, sizeof(double));
            if (arrays[a][f] == NULL)
                status = error_memory(err, made->n * sizeof(double), "a stiffness");
        }
    if (status == 0 && !grid_is_profile(grid))
        status = pyramid_create(&made->pyramid, grid, err);
    if (status != 0)
        held_destroy(&made);
    *out = made;
    return status;
}

void held_destroy(struct held **held) {
    struct held *gone = *held;
    if (gone == NULL)
        return;
    for (size_t f = 0; f < FIELDS; f++) {
        free(gone->t[f]);
        free(gone->r[f]);
        free(gone->d[f]);
        free(gone->w[f]);
    }
    pyramid_clear(&gone->pyramid);
    transfer_clear(&gone->transfer);
    free(gone);
    *held = NULL;
}

void held_set_stop(struct held *held, int (*stop)(void *context), void *context) {
    held->stop = stop;
    held->stop_context = context;
}

double held_bytes(const struct grid *grid) {
    double fields = grid_is_profile(grid) ? ALONG_Y : FIELDS;
    return transfer_bytes(grid) + ARRAYS * fields * sizeof(double) * (double)grid_points(grid) +
           (grid_is_profile(grid) ? 0 : pyramid_bytes(grid));
}

/* The fields of a solve, first .. end - 1, and the mean of its tractions in each. */
struct load {
    size_t first, end;
    double mean[FIELDS];
};

/* Takes the mean off x in the set p > 0, and drops what is outside. Returns that mean. */
static double centre(const struct held *held, const double *p, double *x) {
    double sum = 0;
    for (size_t i = 0; i < held->n; i++)
        sum += p[i] > 0 ? x[i] : 0;
    const double mean = sum / (double)held->count;
    for (size_t i = 0; i < held->n; i++)
        x[i] = p[i] > 0 ? x[i] - mean : 0;
    return mean;
}

/* Returns the largest |r|, and marks the set by values that are not 0. */
static double mark(size_t n, const double *p, double *r) {
    double most = 0;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, fabs(r[i]));
        r[i] = p[i] > 0 && r[i] == 0 ? DBL_MIN : r[i];
    }
    return most;
}

/* w = M r, of sum 0 in the set. Returns r.w. */
static double precondition(struct held *held, const double *p, const struct load *load) {
    double *fields[FIELDS] = {0}, energy = 0;
    const bool profile = grid_is_profile(&held->transfer.grid);
    for (size_t f = load->first; f < load->end; f++) {
        fields[f] = held->w[f];
        if (profile)
            lines_continue(held->n, held->r[f], held->w[f]);
        else
            pyramid_continue(&held->pyramid, held->r[f], held->w[f]);
    }
    transfer_precondition(&held->transfer, fields, fields);
    for (size_t f = load->first; f < load->end; f++) {
        if (profile)
            lines_transpose(held->n, held->r[f], held->w[f]);
        else
            pyramid_transpose(&held->pyramid, held->r[f], held->w[f]);
        centre(held, p, held->w[f]);
        energy += transfer_dot(held->n, held->w[f], held->r[f]);
    }
    return energy;
}

/* d = w + beta d, then w = C d. Returns d.w. */
static double direct(struct held *held, const struct load *load, double beta) {
    double *in[FIELDS] = {0}, *out[FIELDS] = {0}, curvature = 0;
    for (size_t f = load->first; f < load->end; f++) {
        in[f] = held->d[f];
        out[f] = held->w[f];
        for (size_t i = 0; i < held->n; i++)
            held->d[f][i] = held->w[f][i] + beta * held->d[f][i];
    }
    transfer_apply(&held->transfer, in, out);
    for (size_t f = load->first; f < load->end; f++)
        curvature += transfer_dot(held->n, held->d[f], held->w[f]);
    return curvature;
}

/* Begins with the same traction at all nodes of the set. Returns its displacement along the load,
 * of unit length: an energy. */
static double begin(struct held *held, const double *p, const struct load *load) {
    double *in[FIELDS] = {0}, *out[FIELDS] = {0}, displacement = 0;
    for (size_t f = load->first; f < load->end; f++) {
        in[f] = held->t[f];
        out[f] = held->r[f];
        memset(held->d[f], 0, held->n * sizeof *held->d[f]);
        for (size_t i = 0; i < held->n; i++)
            held->t[f][i] = p[i] > 0 ? load->mean[f] * (double)held->n / (double)held->count : 0;
    }
    transfer_apply(&held->transfer, in, out);
    for (size_t f = load->first; f < load->end; f++)
        displacement += load->mean[f] * centre(held, p, held->r[f]);
    return displacement;
}

/* Advances by the step against d. Returns by how much the displacement along the load falls. */
static double advance(struct held *held, const double *p, const struct load *load, double step) {
    double change = 0;
    for (size_t f = load->first; f < load->end; f++) {
        for (size_t i = 0; i < held->n; i++)
            held->t[f][i] -= step * held->d[f][i];
        change += step * load->mean[f] * centre(held, p, held->w[f]);
        for (size_t i = 0; i < held->n; i++)
            held->r[f][i] = p[i] > 0 ? held->r[f][i] - step * held->w[f][i] : 0;
    }
    return change;
}

/* Solves for a mean traction of length 1. *displacement: that along the load, as an energy, whose
 * error is the square of that of the tractions. */
static int solve(struct held *held, const double *p, const struct load *load, double residual,
                 double *displacement, size_t *iterations, struct error *err) {
    double along = begin(held, p, load), last = 0, most = 0;
    for (size_t step = 0; step < STEPS_MOST; step++, ++*iterations) {
        most = 0;
        *displacement = along;
        for (size_t f = load->first; f < load->end; f++) {
            most = fmax(most, mark(held->n, p, held->r[f]));
            *displacement += transfer_dot(held->n, held->t[f], held->r[f]) / (double)held->n;
        }
        if (most <= residual * fabs(along))
            return 0;
        if (held->stop != NULL && step % STEPS_ASK == STEPS_ASK - 1 &&
            held->stop(held->stop_context) != 0)
            return error_set(err, ERROR_STOPPED, "stopped after %zu iterations of a stiffness",
                             *iterations);
        double energy = precondition(held, p, load);
        double curvature = direct(held, load, last > 0 ? energy / last : 0);
        if (!(curvature > 0))
            break;
        along -= advance(held, p, load, energy / curvature);
        last = energy;
    }
    return error_set(err, ERROR_NUMERIC,
                     "the stiffness of %zu nodes that are held did not converge: residual %.2g of "
                     "the displacement in %zu steps, asked %.2g",
                     held->count, most / fabs(along), *iterations, residual);
}

static struct held_stiffness stiffness_of(double normal, double tangential, struct held *held) {
    return (struct held_stiffness){.normal = normal,
                                   .tangential = tangential,
                                   .ratio = tangential / normal,
                                   .work = held->transfer.transforms * (double)held->n};
}

int held_measure(struct held *held, const double *p, double angle, double residual,
                 struct held_stiffness *out, struct error *err) {
    const bool profile = held->transfer.fields == ALONG_Y;
    const struct load across = {NORMAL, NORMAL + 1, {1, 0, 0}};
    const struct load along = {ALONG_X, FIELDS, {0, cos(angle), sin(angle)}};
    double normal = 0, tangential = 0;
    size_t iterations = 0;
    if (!(residual > 0))
        return error_set(err, ERROR_INPUT, "residual of a stiffness = %g; allowed: above 0",
                         residual);
    held->transfer.transforms = 0;
    held->count = 0;
    for (size_t i = 0; i < held->n; i++)
        held->count += p[i] > 0 ? 1 : 0;
    if (held->count == 0 || held->count == held->n) {
        double both = held->count == 0 ? 0 : INFINITY;
        *out = stiffness_of(both, both, held);
        return 0;
    }
    if (!profile)
        pyramid_set(&held->pyramid, p);
    int status = solve(held, p, &across, residual, &normal, &iterations, err);
    tangential = normal;
    if (status == 0 && !profile)
        status = solve(held, p, &along, residual, &tangential, &iterations, err);
    if (status != 0)
        return status;
    *out = stiffness_of(1 / normal, 1 / tangential, held);
    out->iterations = iterations;
    return 0;
}
