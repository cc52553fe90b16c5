/* Faces are solved by active sets (active_set.h), where these do not converge by sets that are
 * solved closely, and else by what follows.
 *
 * Conjugate gradients in the set of nodes in contact (Polonsky & Keer 1999), preconditioned by the
 * inverse compliance restricted to the set: the residual is transformed, multiplied and transformed
 * back, values outside the set are dropped, and the mean is subtracted so that the load stays. Two
 * things differ from the textbook. The search direction is kept when the set changes, with Polak
 * and Ribiere's factor; a restart at every node that opens or closes takes half as many iterations
 * again. On long cells, steps that cut pressures at 0 can make long waves overshoot repeatedly.
 * When progress is slow, such steps are shortened to the least energy, which takes no further
 * transform. When there is still no progress, careful steps follow (as in Dostal 1997). They are
 * conjugate gradients in the set that stop where a pressure becomes 0, and projected gradients
 * where that happened or where penetrations exceed the gaps inside. Each of them lowers the energy,
 * and a projected step by at least a fixed part of the square of the change. So they converge from
 * any start.
 *
 * Pressures up to a hardness are solved by sets (bounded_set.h) and careful steps, in turn. */
#include "core/contact/solver/conjugate_gradient.h"
#include "core/contact/solver/active_set.h"
#include "core/contact/solver/bounded_set.h"
#include "core/vectors.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum {
    LANES = CONJUGATE_GRADIENT_LANES,
    REFRESH = 50, /* iterations after which u is computed anew from p */
    SLOW = 30, /* iterations that have not halved the violation, after which steps are shortened */
    CAREFUL_FIRST =
        16, /* careful steps after the first sets under a hardness, then twice as many */
};
/* Length of a projected step over the inverse of the largest compliance, which is 1 here; below
 * 2. */
static const double STRIDE = 1.8;
/* The approach at which nodes under pressure, but for those at the hardness, touch on average:
 * minus the mean of u - z over them. */
WIDE_VECTORS static double mean_approach(size_t n, double hardness, const double *p,
                                         const double *u, const double *z) {
    double sum[LANES] = {0}, count[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double in = p[i + a] > 0 && p[i + a] < hardness ? 1 : 0;
            sum[a] += in * (u[i + a] - z[i + a]);
            count[a] += in;
        }
    return -conjugate_lanes_sum(sum) / conjugate_lanes_sum(count);
}

static double approach_of(const struct conjugate_gradient *solver) {
    double approach =
        mean_approach(solver->padded, solver->hardness, solver->p, solver->u, solver->z);
    return isnan(approach) ? bounded_approach(solver) : approach;
}

static inline double larger(double a, double b) {
    return a > b ? a : b;
}

/* r is the gap in the set {0 < p < hardness, or where released gap < 0 with no pressure or > 0 with
 * the hardness}, where it is never exactly 0, and 0 outside, so that r != 0 marks the set. Returns
 * the size of the set. end->approach is an input; all lengths of end are filled. */
WIDE_VECTORS static double residual(size_t n, double hardness, const double *p, const double *u,
                                    const double *z, double released, double *r,
                                    struct conjugate_gradient_end *end) {
    double inside[LANES] = {0}, outside[LANES] = {0}, deep[LANES] = {0}, members[LANES] = {0};
    double lifted[LANES] = {0};
    double approach = end->approach;
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double gap = u[i + a] - z[i + a] + approach;
            double held = p[i + a] >= hardness ? 1 : 0, in = p[i + a] > 0 ? 1 - held : 0;
            double within = in * fabs(gap), depth = fabs(u[i + a]);
            double through = gap < 0 ? (in + held - 1) * gap : 0, above = gap > 0 ? held * gap : 0;
            double member = in + (through + above) * released > 0 ? 1 : 0;
            lifted[a] = larger(above, lifted[a]);
            inside[a] = larger(within, inside[a]);
            outside[a] = larger(through, outside[a]);
            deep[a] = larger(depth, deep[a]);
            members[a] += member;
            r[i + a] = member * (gap == 0 ? DBL_MIN : gap);
        }
    end->inside = conjugate_lanes_most(inside);
    end->penetration = conjugate_lanes_most(outside);
    end->deepest = conjugate_lanes_most(deep);
    end->lifted = conjugate_lanes_most(lifted);
    return conjugate_lanes_sum(members);
}

/* p -= step t, cut at 0 and the hardness, and u -= step w. Returns the sum of p; *cut: whether any
 * was. */
WIDE_VECTORS static double advance(size_t n, double hardness, double step, const double *t,
                                   const double *w, double *p, double *u, bool *cut) {
    double sum[LANES] = {0}, below[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double next = p[i + a] - step * t[i + a];
            below[a] += next < 0 || next > hardness ? 1 : 0;
            next = next < 0 ? 0 : next;
            next = next > hardness ? hardness : next;
            p[i + a] = next;
            u[i + a] -= step * w[i + a];
            sum[a] += next;
        }
    *cut = conjugate_lanes_sum(below) > 0;
    return conjugate_lanes_sum(sum);
}

/* Replaces p by the pressures nearest to p - STRIDE gap among those >= 0 of this mean (Michelot
 * 1986: the level to subtract is raised until no more of them become negative). Where p is not the
 * solution, the energy falls by at least the square of the change times 1/STRIDE - 1/2. */
static void project(struct conjugate_gradient *solver, double mean) {
    double top = -INFINITY, level = -INFINITY, sum = 0;
    size_t count = solver->n + 1, last;
    for (size_t i = 0; i < solver->n; i++) {
        solver->t[i] = solver->p[i] - STRIDE * (solver->u[i] - solver->z[i]);
        top = fmax(top, solver->t[i]);
    }
    do {
        last = count;
        count = 0;
        sum = 0;
        for (size_t i = 0; i < solver->n; i++)
            if (solver->t[i] - top > level) {
                sum += solver->t[i] -
                       top; /* largest first, so that the smallest load is not lost in rounding */
                count++;
            }
        level = (sum - mean * (double)solver->n) / (double)count;
    } while (count != last);
    sum = 0;
    for (size_t i = 0; i < solver->n; i++)
        sum += solver->p[i] = fmax(0, solver->t[i] - top - level);
    conjugate_step_scale(solver, mean, sum, solver->p);
}

/* Returns the longest step along t that leaves no pressure negative or above the hardness. */
static double feasible_step(const struct conjugate_gradient *solver, double step) {
    for (size_t i = 0; i < solver->n; i++) {
        if (solver->t[i] > 0 && solver->p[i] > 0 && solver->p[i] < step * solver->t[i])
            step = solver->p[i] / solver->t[i];
        double room = solver->hardness - solver->p[i];
        if (solver->t[i] < 0 && room > 0 && room < -step * solver->t[i])
            step = -room / solver->t[i];
    }
    return step;
}

/* Gives pressures that were cut the load again. */
static void restore_load(struct conjugate_gradient *solver, double mean, double sum) {
    if (isinf(solver->hardness))
        conjugate_step_scale(solver, mean, sum, solver->p);
    else
        bounded_balance(solver, mean);
}

/* Watches whether the violation has halved within a number of iterations. */
struct stall_watch {
    double best;
    size_t since;
};
static bool stalled(struct stall_watch *progress, double violation, size_t iterations) {
    if (violation < 0.5 * progress->best)
        *progress = (struct stall_watch){violation, 0};
    else
        progress->since++;
    return progress->since >= iterations;
}

/* Goes along the direction t; *stale says whether u must be computed anew from p. */
static void iterate(struct conjugate_gradient *solver, double mean, bool careful,
                    struct step_memory *memory, bool *stale) {
    double step = conjugate_step_length(solver);
    if (careful) {
        double longest = feasible_step(solver, step);
        memory->blocked = longest < step;
        step = memory->blocked ? longest * (1 + 4 * DBL_EPSILON) : step; /* that pressure: 0 */
    }
    double sum = advance(solver->padded, solver->hardness, step, solver->t, solver->w, solver->p,
                         solver->u, stale);
    if (*stale)
        restore_load(solver, mean, sum);
}

/* Makes a projected step, after which the last search direction is no longer used. */
static void step_projected(struct conjugate_gradient *solver, double mean,
                           struct step_memory *memory, bool *stale) {
    if (isinf(solver->hardness))
        project(solver, mean);
    else
        bounded_project(solver, mean, STRIDE);
    *memory = (struct step_memory){0};
    *stale = true;
}

/* Shortens the step from kept_p and kept_u to a p that was cut at 0, to the least energy between
 * them. If the energy does not fall towards p at all, a projected step from kept_p is made instead.
 * *stale: as for iterate. */
static void shorten(struct conjugate_gradient *solver, double mean, const double *kept_p,
                    const double *kept_u, struct step_memory *memory, bool *stale) {
    double slope = 0, curvature = 0;
    conjugate_step_apply_compliance(solver, solver->p, solver->u);
    for (size_t i = 0; i < solver->n; i++) {
        double change = solver->p[i] - kept_p[i];
        slope += (kept_u[i] - solver->z[i]) * change;
        curvature += (solver->u[i] - kept_u[i]) * change;
    }
    bool falls = slope < 0;
    double share = !falls ? 0 : -slope < curvature ? -slope / curvature : 1;
    for (size_t i = 0; share < 1 && i < solver->n; i++) {
        solver->p[i] = kept_p[i] + share * (solver->p[i] - kept_p[i]);
        solver->u[i] = kept_u[i] + share * (solver->u[i] - kept_u[i]);
    }
    *stale = false;
    if (!falls)
        step_projected(solver, mean, memory, stale);
}

/* The same, and shortens the step where pressures were cut. */
static void iterate_shortened(struct conjugate_gradient *solver, double mean,
                              struct step_memory *memory, bool *stale) {
    memcpy(solver->spare[0], solver->p, solver->n * sizeof *solver->p);
    memcpy(solver->spare[1], solver->u, solver->n * sizeof *solver->u);
    iterate(solver, mean, false, memory, stale);
    if (*stale)
        shorten(solver, mean, solver->spare[0], solver->spare[1], memory, stale);
}

/* Returns whether it converged or was stopped. closely: as active_set_run, without a hardness. */
static bool solve_by_sets(struct conjugate_gradient *solver, double mean, double tolerance,
                          bool closely, size_t max_iterations, struct conjugate_gradient_end *end) {
    conjugate_step_apply_compliance(solver, solver->p, solver->u);
    end->approach = approach_of(solver);
    residual(solver->padded, solver->hardness, solver->p, solver->u, solver->z, 1, solver->r, end);
    if (isinf(solver->hardness))
        active_set_run(solver, mean, tolerance, closely, max_iterations, end);
    else
        bounded_set_run(solver, mean, tolerance, max_iterations, end);
    return end->converged || end->stopped;
}

/* Goes on from end->iterations. */
static void solve_by_steps(struct conjugate_gradient *solver, double mean, double tolerance,
                           size_t stall_iterations, size_t max_iterations,
                           struct conjugate_gradient_end *end) {
    struct step_memory memory = {0};
    struct stall_watch progress = {.best = INFINITY};
    bool careful = false, stale = true;
    const double highest = conjugate_step_highest(solver);
    for (;; end->iterations++) {
        if (stale || end->iterations % REFRESH == 0)
            conjugate_step_apply_compliance(solver, solver->p, solver->u);
        end->approach = approach_of(solver);
        residual(solver->padded, solver->hardness, solver->p, solver->u, solver->z, careful ? 0 : 1,
                 solver->r, end);
        double outside = fmax(end->penetration, end->lifted);
        double violation = fmax(end->inside, outside);
        bool number =
            isfinite(end->approach); /* fmax ignores NaN, so that a violation may look finite */
        end->converged =
            number && violation <= fmax(tolerance * end->deepest, CONJUGATE_ROUNDING * highest);
        if (end->converged || !number || end->iterations >= max_iterations)
            return;
        end->stopped = solver->stop != NULL &&
                       end->iterations % CONJUGATE_ASK == CONJUGATE_ASK - 1 &&
                       solver->stop(solver->stop_context) != 0;
        if (end->stopped)
            return;
        if (!careful && stalled(&progress, violation, stall_iterations)) {
            careful = memory.blocked = true;
            memory.energy = 0;
        }
        if (careful && (memory.blocked || outside >= end->inside)) {
            step_projected(solver, mean, &memory, &stale);
            continue;
        }
        conjugate_step_direct(solver, &memory);
        if (!careful && progress.since >= SLOW)
            iterate_shortened(solver, mean, &memory, &stale);
        else
            iterate(solver, mean, careful, &memory, &stale);
    }
}

/* Sets and careful steps in turn. */
static void solve_bounded(struct conjugate_gradient *solver, double mean, double tolerance,
                          size_t max_iterations, struct conjugate_gradient_end *end) {
    for (size_t careful = CAREFUL_FIRST; end->iterations < max_iterations; careful *= 2) {
        if (solve_by_sets(solver, mean, tolerance, false, max_iterations, end))
            return;
        end->bounded = true;
        size_t most =
            end->iterations + careful < max_iterations ? end->iterations + careful : max_iterations;
        solve_by_steps(solver, mean, tolerance, 0, most, end);
        if (end->converged || end->stopped || !isfinite(end->approach))
            return;
    }
}

void conjugate_gradient_run(struct conjugate_gradient *solver, double mean, double tolerance,
                            size_t stall_iterations, size_t max_iterations,
                            struct conjugate_gradient_end *end) {
    *end = (struct conjugate_gradient_end){0};
    if (isfinite(solver->hardness))
        solve_bounded(solver, mean, tolerance, max_iterations, end);
    else if (!solve_by_sets(solver, mean, tolerance, false, max_iterations, end)) {
        const size_t half = end->iterations + (max_iterations - end->iterations) / 2;
        if (!solve_by_sets(solver, mean, tolerance, true, half, end))
            solve_by_steps(solver, mean, tolerance, stall_iterations, max_iterations, end);
    }
}
