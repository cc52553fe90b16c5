#include "core/contact/solver/conjugate_gradient.h"
#include "core/vectors.h"
#include <float.h>
#include <math.h>

enum { LANES = CONJUGATE_GRADIENT_LANES, STEPS_MOST = 300 };

enum { TANGENT };                   /* sum of q */
enum { RESIDUAL, MEMBERS, ENERGY }; /* sums of r in the set, of nodes, and of q r */

/* Drops q outside of the set where p > 0. */
WIDE_VECTORS static double restrict_to(size_t n, const double *p, double *q) {
    double sum[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            q[i + a] = p[i + a] > 0 ? q[i + a] : 0;
            sum[a] += q[i + a];
        }
    return conjugate_lanes_sum(sum);
}

static void restrict_block(const struct pass *pass, size_t first, size_t n,
                           struct pass_result *out) {
    const struct conjugate_gradient *s = pass->solver;
    out->sum[TANGENT] = restrict_to(n, pass->set + first, s->q + first);
}

WIDE_VECTORS static void measure(size_t n, const double *p, const double *q, const double *r,
                                 struct pass_result *out) {
    double residual[LANES] = {0}, members[LANES] = {0}, energy[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double in = p[i + a] > 0 ? 1 : 0;
            residual[a] += in * r[i + a];
            members[a] += in;
            energy[a] += q[i + a] * r[i + a];
        }
    out->sum[RESIDUAL] = conjugate_lanes_sum(residual);
    out->sum[MEMBERS] = conjugate_lanes_sum(members);
    out->sum[ENERGY] = conjugate_lanes_sum(energy);
}

static void measure_block(const struct pass *pass, size_t first, size_t n,
                          struct pass_result *out) {
    const struct conjugate_gradient *s = pass->solver;
    measure(n, pass->set + first, s->q + first, s->r + first, out);
}

/* Takes the mean off r in the set p > 0, where it is never 0. Returns the largest |r|. */
WIDE_VECTORS static double centre(size_t n, const double *p, double mean, double *r) {
    double most[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double slope = r[i + a] - mean;
            slope = p[i + a] > 0 ? (slope == 0 ? DBL_MIN : slope) : 0;
            most[a] = fabs(slope) > most[a] ? fabs(slope) : most[a];
            r[i + a] = slope;
        }
    return conjugate_lanes_most(most);
}

static void centre_block(const struct pass *pass, size_t first, size_t n, struct pass_result *out) {
    const struct conjugate_gradient *s = pass->solver;
    out->most[0] = centre(n, pass->set + first, pass->mean, s->r + first);
}

WIDE_VECTORS static void advance(size_t n, double step, const double *t, const double *w,
                                 const double *old, double *q, double *r) {
    for (size_t i = 0; i < n; i++) {
        q[i] -= step * t[i];
        r[i] = old[i] - step * w[i];
    }
}

static void advance_block(const struct pass *pass, size_t first, size_t n,
                          struct pass_result *out) {
    (void)out;
    const struct conjugate_gradient *s = pass->solver;
    advance(n, pass->step, s->t + first, s->w + first, s->old + first, s->q + first, s->r + first);
}

/* Fills r with the displacements under q. */
static void begin(struct conjugate_gradient *solver, const double *set) {
    const struct pass pass = {.solver = solver, .set = set};
    double sum = pass_run(&solver->board, &pass, restrict_block).sum[TANGENT];
    conjugate_step_take_set(solver, set);
    if (!(sum > 0)) {
        sum = 0;
        for (size_t i = 0; i < solver->padded; i++)
            sum += solver->q[i] = set[i];
    }
    conjugate_step_scale(solver, 1, sum, solver->q);
    conjugate_step_apply_compliance(solver, solver->q, solver->r);
}

double conjugate_gradient_tangent(struct conjugate_gradient *solver, const double *set,
                                  double enough) {
    struct step_memory memory = {.continued = true};
    struct pass pass = {.solver = solver, .set = set};
    double mean = 0; /* of the displacements in the set: minus the approach */
    begin(solver, set);
    for (size_t iteration = 0;; iteration++) {
        struct pass_result sums = pass_run(&solver->board, &pass, measure_block);
        /* Of q the mean is 1, so that the energy of the mean displacement is this mean. */
        double energy = sums.sum[ENERGY] / (double)solver->n + mean;
        pass.mean = sums.sum[RESIDUAL] / sums.sum[MEMBERS];
        mean += pass.mean;
        double most = pass_run(&solver->board, &pass, centre_block).most[0];
        if (iteration % CONJUGATE_ASK == 0 && solver->stop != NULL && !solver->stopped)
            solver->stopped = solver->stop(solver->stop_context) != 0;
        if (most <= enough * fabs(mean) || iteration == STEPS_MOST || solver->stopped)
            return energy;
        conjugate_step_direct(solver, &memory);
        pass.step = conjugate_step_length(solver);
        pass_run(&solver->board, &pass, advance_block);
    }
}
