#include "core/contact/conjugate_step.h"
#include "core/vectors.h"
#include <math.h>
#include <string.h>

enum { LANES = CONJUGATE_GRADIENT_LANES };

/* A padded transform takes about as long as three of the grid. */
static const double WIDE_TRANSFORMS = 3;

double conjugate_lanes_sum(const double *lanes) {
    double total = 0;
    for (size_t a = 0; a < LANES; a++)
        total += lanes[a];
    return total;
}

double conjugate_lanes_most(const double *lanes) {
    double most = 0;
    for (size_t a = 0; a < LANES; a++)
        most = fmax(most, lanes[a]);
    return most;
}

/* --- products with the compliance and its inverse --- */

void conjugate_step_soften(struct conjugate_gradient *solver, const double *in, double *out) {
    if (solver->wide == NULL) {
        transform_filter(solver->transform, solver->soft, 1, in, out);
        solver->transforms += 2;
        return;
    }
    transform_filter_part(solver->wide, solver->soft, 1, solver->grid.nx, solver->grid.ny, in, out);
    solver->transforms += 2 * WIDE_TRANSFORMS;
}

/* Nodes in contact of a profile that follow each other, with `apart` - 1 others between them,
 * across the ends of the cell too. */
struct bridge {
    size_t from, to, apart;
};

/* Returns the first node of the set r != 0; n where there is none. */
static size_t first_of(size_t n, const double *r) {
    size_t i = 0;
    while (i < n && r[i] == 0)
        i++;
    return i;
}

/* Goes to the next bridge of a walk once around, which begins with from = to = first_of; false
 * when it is back there. */
static bool next_bridge(size_t n, const double *r, size_t first, struct bridge *bridge) {
    size_t i = bridge->to;
    if (bridge->apart > 0 && i == first)
        return false;
    bridge->from = i;
    bridge->apart = 0;
    do {
        i = i + 1 < n ? i + 1 : 0;
        bridge->apart++;
    } while (r[i] == 0);
    bridge->to = i;
    return true;
}

/* out: r in the set r != 0, between its nodes the straight line from one to the next. */
static void continue_by_lines(size_t n, const double *r, double *out) {
    size_t first = first_of(n, r);
    struct bridge one = {first, first, 0};
    memcpy(out, r, n * sizeof *out);
    while (first < n && next_bridge(n, r, first, &one)) {
        double slope = (r[one.to] - r[one.from]) / (double)one.apart;
        for (size_t a = 1, i = one.from; a < one.apart; a++) {
            i = i + 1 < n ? i + 1 : 0;
            out[i] = r[one.from] + slope * (double)a;
        }
    }
}

/* The transpose of that, in place: what w has between two nodes goes to these. */
static void bring_back(size_t n, const double *r, double *w) {
    size_t first = first_of(n, r);
    struct bridge one = {first, first, 0};
    while (first < n && next_bridge(n, r, first, &one)) {
        double sum = 0, moment = 0;
        for (size_t a = 1, i = one.from; a < one.apart; a++) {
            i = i + 1 < n ? i + 1 : 0;
            sum += w[i];
            moment += w[i] * (double)a;
        }
        moment /= (double)one.apart;
        w[one.to] += moment;
        w[one.from] += sum - moment;
    }
}

/* out = the inverse compliance of r in the set r != 0, some numbers elsewhere. */
static void stiffen(struct conjugate_gradient *solver, enum continuation continuation,
                    const double *r, double *out) {
    bool lines = continuation == CONTINUED_BY_LINES;
    if (lines)
        continue_by_lines(solver->n, r, out);
    transform_filter(solver->transform, solver->stiff, 1, lines ? out : r, out);
    if (lines)
        bring_back(solver->n, r, out);
    solver->transforms += 2;
}

/* --- directions --- */

/* These sums are over the set r != 0. */
struct products {
    double members, w, r, old, t, w_r, w_old;
};

WIDE_VECTORS static struct products multiply(size_t n, const double *r, const double *w,
                                             const double *old, const double *t) {
    double m[LANES] = {0}, sw[LANES] = {0}, sr[LANES] = {0}, so[LANES] = {0}, st[LANES] = {0};
    double wr[LANES] = {0}, wo[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double in = r[i + a] != 0 ? 1 : 0, v = in * w[i + a];
            m[a] += in;
            sw[a] += v;
            sr[a] += r[i + a];
            so[a] += in * old[i + a];
            st[a] += in * t[i + a];
            wr[a] += v * r[i + a];
            wo[a] += v * old[i + a];
        }
    return (struct products){.members = conjugate_lanes_sum(m),
                             .w = conjugate_lanes_sum(sw),
                             .r = conjugate_lanes_sum(sr),
                             .old = conjugate_lanes_sum(so),
                             .t = conjugate_lanes_sum(st),
                             .w_r = conjugate_lanes_sum(wr),
                             .w_old = conjugate_lanes_sum(wo)};
}

/* Sets t to w - w_mean + beta (t - t_mean) in the set, to 0 outside. */
WIDE_VECTORS static void redirect(size_t n, const double *r, const double *w, double w_mean,
                                  double beta, double t_mean, double *t) {
    for (size_t i = 0; i < n; i++) {
        double direction = w[i] - w_mean + beta * (t[i] - t_mean);
        t[i] = r[i] != 0 ? direction : 0;
    }
}

void conjugate_step_direct(struct conjugate_gradient *solver, struct step_memory *memory) {
    stiffen(solver, memory->continuation, solver->r, solver->w);
    struct products s = multiply(solver->padded, solver->r, solver->w, solver->old, solver->t);
    double mean = s.w / s.members;
    double energy = s.w_r - mean * s.r, change = energy - (s.w_old - mean * s.old);
    double beta = memory->energy > 0 ? fmax(0, change / memory->energy) : 0;
    redirect(solver->padded, solver->r, solver->w, mean, beta, s.t / s.members, solver->t);
    memory->energy = energy;
    double *last = solver->old;
    solver->old = solver->r;
    solver->r = last;
    conjugate_step_soften(solver, solver->t, solver->w);
}

WIDE_VECTORS static double least_along(size_t n, const double *r, const double *t,
                                       const double *w) {
    double above[LANES] = {0}, below[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            above[a] += r[i + a] * t[i + a];
            below[a] += t[i + a] * w[i + a];
        }
    double curvature = conjugate_lanes_sum(below);
    return curvature > 0 ? conjugate_lanes_sum(above) / curvature : 0;
}

double conjugate_step_length(const struct conjugate_gradient *solver) {
    return least_along(solver->padded, solver->old, solver->t, solver->w);
}

/* --- the rest --- */

void conjugate_step_scale(size_t n, double mean, double sum, double *x) {
    double factor = mean * (double)n / sum;
    for (size_t i = 0; i < n; i++)
        x[i] *= factor;
}

double conjugate_step_highest(const struct conjugate_gradient *solver) {
    double highest = 0;
    for (size_t i = 0; i < solver->n; i++)
        highest = fmax(highest, fabs(solver->z[i]));
    return highest;
}
