#include "core/contact/solver/active_set.h"
#include "core/vectors.h"
#include <float.h>
#include <math.h>

enum {
    LANES = CONJUGATE_GRADIENT_LANES,
    STEPS_MOST = 8, /* within one set */
    SETS_STALLED = 12
};
/* A set is solved until its gaps are this part of the initial ones, of profiles mostly in two
 * steps, of surfaces in one. Profiles of 512 longest waves took 175 steps with the part of
 * surfaces, and 128 with theirs. After a set that was no better gaps must be CLOSER times smaller
 * still: long waves that are left over make nodes leave and join again and again. */
static const double PROFILE_PART = 0.03, SURFACE_PART = 0.1, CLOSER = 0.3;

/* A set after its steps. */
struct set {
    double members, left, joined; /* numbers of nodes */
    double penetration, deepest;  /* as in struct conjugate_gradient_end */
    double sum;                   /* of p, without negative pressures */
};

/* r = u - z in the set r != 0, never 0 there. Returns the sum, and the size of the set. */
WIDE_VECTORS static double fill(size_t n, const double *u, const double *z, double *r,
                                double *members) {
    double sum[LANES] = {0}, count[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double in = r[i + a] != 0 ? 1 : 0, gap = in * (u[i + a] - z[i + a]);
            sum[a] += gap;
            count[a] += in;
            r[i + a] = in * (gap == 0 ? DBL_MIN : gap);
        }
    *members = conjugate_lanes_sum(count);
    return conjugate_lanes_sum(sum);
}

/* Takes the mean off r in the set r != 0, where it is never 0. Returns the largest |r|. */
WIDE_VECTORS static double centre(size_t n, double mean, double *r) {
    double most[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double in = r[i + a] != 0 ? 1 : 0, gap = in * (r[i + a] - mean);
            r[i + a] = in * (gap == 0 ? DBL_MIN : gap);
            most[a] = fabs(gap) > most[a] ? fabs(gap) : most[a];
        }
    return conjugate_lanes_most(most);
}

/* p -= step t, u -= step w, r = old - step w in the set old != 0, never 0 there. Returns the sum of
 * r. */
WIDE_VECTORS static double advance(size_t n, double step, const double *t, const double *w,
                                   const double *old, double *p, double *u, double *r) {
    double sum[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double in = old[i + a] != 0 ? 1 : 0, gap = in * (old[i + a] - step * w[i + a]);
            p[i + a] -= step * t[i + a];
            u[i + a] -= step * w[i + a];
            r[i + a] = in * (gap == 0 ? DBL_MIN : gap);
            sum[a] += gap;
        }
    return conjugate_lanes_sum(sum);
}

/* Makes r != 0 the next set, and sets negative p to 0. */
WIDE_VECTORS static struct set follow(size_t n, const double *u, const double *z, double approach,
                                      double *p, double *r) {
    double members[LANES] = {0}, left[LANES] = {0}, joined[LANES] = {0}, sum[LANES] = {0};
    double through[LANES] = {0}, deep[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double gap = u[i + a] - z[i + a] + approach, depth = fabs(u[i + a]);
            double in = r[i + a] != 0 ? 1 : 0;
            double leaves = p[i + a] < 0 ? in : 0, joins = gap < 0 ? 1 - in : 0;
            double below = -joins * gap;
            left[a] += leaves;
            joined[a] += joins;
            members[a] += in - leaves + joins;
            through[a] = below > through[a] ? below : through[a];
            deep[a] = depth > deep[a] ? depth : deep[a];
            p[i + a] = p[i + a] < 0 ? 0 : p[i + a];
            sum[a] += p[i + a];
            r[i + a] = in - leaves + joins;
        }
    return (struct set){.members = conjugate_lanes_sum(members),
                        .left = conjugate_lanes_sum(left),
                        .joined = conjugate_lanes_sum(joined),
                        .penetration = conjugate_lanes_most(through),
                        .deepest = conjugate_lanes_most(deep),
                        .sum = conjugate_lanes_sum(sum)};
}

/* Reduces the gap in the set r != 0 to a share of what it was, or to `enough`. Fills approach and
 * inside, and counts the steps, max_iterations at most. */
static void close_set(struct conjugate_gradient *solver, double enough, double share,
                      size_t max_iterations, struct conjugate_gradient_end *end) {
    struct step_memory memory = {.continued = true};
    double members, sum = fill(solver->padded, solver->u, solver->z, solver->r, &members);
    double begun = 0;
    conjugate_step_take_set(solver, solver->r);
    end->approach = 0;
    for (size_t i = 0; i < solver->padded; i++)
        solver->t[i] = solver->old[i] = 0;
    for (int step = 0;; step++) {
        end->inside = centre(solver->padded, sum / members, solver->r);
        end->approach -= sum / members;
        begun = step == 0 ? end->inside : begun;
        if (end->inside <= enough || (step > 0 && end->inside <= share * begun) ||
            step == STEPS_MOST || end->iterations >= max_iterations || !isfinite(end->approach))
            return;
        conjugate_step_direct(solver, &memory);
        sum = advance(solver->padded, conjugate_step_length(solver), solver->t, solver->w,
                      solver->old, solver->p, solver->u, solver->r);
        end->iterations++;
    }
}

void active_set_run(struct conjugate_gradient *solver, double mean, double tolerance,
                    size_t max_iterations, struct conjugate_gradient_end *end) {
    const double rounding = CONJUGATE_ROUNDING * conjugate_step_highest(solver);
    const double part = grid_is_profile(&solver->grid) ? PROFILE_PART : SURFACE_PART;
    double least = INFINITY, best = INFINITY; /* changes of the set, violations */
    size_t asked = end->iterations;
    int stalled = 0;
    while (stalled < SETS_STALLED && end->iterations < max_iterations) {
        close_set(solver, fmax(tolerance * end->deepest, rounding), part * pow(CLOSER, stalled),
                  max_iterations, end);
        struct set next =
            follow(solver->padded, solver->u, solver->z, end->approach, solver->p, solver->r);
        end->penetration = next.penetration;
        end->deepest = next.deepest;
        double violation = fmax(end->inside, end->penetration);
        end->converged = !(next.left > 0) && isfinite(end->approach) &&
                         violation <= fmax(tolerance * end->deepest, rounding);
        if (end->converged || !isfinite(end->approach))
            return;
        if (end->iterations >= asked + CONJUGATE_ASK) {
            asked = end->iterations;
            end->stopped = solver->stop != NULL && solver->stop(solver->stop_context) != 0;
        }
        double changed = next.left + next.joined;
        bool better = changed < least || violation < 0.5 * best;
        stalled = better ? 0 : stalled + 1;
        if (better) {
            least = changed;
            best = violation;
        }
        if (next.left > 0) {
            conjugate_step_scale(solver->n, mean, next.sum, solver->p);
            conjugate_step_apply_compliance(solver, solver->p, solver->u);
        }
        if (end->stopped)
            return;
    }
}
