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

/* Sums and largest values of the passes below. */
enum { GAP, MEMBERS };                 /* over the nodes of the set */
enum { HIGHEST, LOWEST };              /* gap in the set; the lowest one with its sign changed */
enum { STAY, LEFT, JOINED, PRESSURE }; /* numbers of nodes, and their pressures */
enum { PENETRATION, DEEPEST };         /* as in struct conjugate_gradient_end */

static double larger(double a, double b) {
    return a > b ? a : b;
}

static double highest_of(const double *lanes) {
    double highest = lanes[0];
    for (size_t a = 1; a < LANES; a++)
        highest = larger(lanes[a], highest);
    return highest;
}

/* r = u - z in the set r != 0, never 0 there. */
WIDE_VECTORS static void fill(size_t n, const double *u, const double *z, double *r,
                              struct pass_result *out) {
    double sum[LANES] = {0}, count[LANES] = {0}, high[LANES], low[LANES];
    for (size_t a = 0; a < LANES; a++)
        high[a] = low[a] = -INFINITY;
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double in = r[i + a] != 0 ? 1 : 0, gap = in * (u[i + a] - z[i + a]);
            double above = in > 0 ? gap : -INFINITY, below = in > 0 ? -gap : -INFINITY;
            high[a] = above > high[a] ? above : high[a];
            low[a] = below > low[a] ? below : low[a];
            sum[a] += gap;
            count[a] += in;
            r[i + a] = in * (gap == 0 ? DBL_MIN : gap);
        }
    out->sum[GAP] = conjugate_lanes_sum(sum);
    out->sum[MEMBERS] = conjugate_lanes_sum(count);
    out->most[HIGHEST] = highest_of(high);
    out->most[LOWEST] = highest_of(low);
}

static void fill_block(const struct pass *pass, size_t first, size_t n, struct pass_result *out) {
    const struct conjugate_gradient *s = pass->solver;
    fill(n, s->u + first, s->z + first, s->r + first, out);
}

/* Takes the mean off r in the set r != 0, where it is never 0. */
WIDE_VECTORS static void centre(size_t n, double mean, double *r) {
    for (size_t i = 0; i < n; i++) {
        double in = r[i] != 0 ? 1 : 0, gap = in * (r[i] - mean);
        r[i] = in * (gap == 0 ? DBL_MIN : gap);
    }
}

static void centre_block(const struct pass *pass, size_t first, size_t n, struct pass_result *out) {
    (void)out;
    centre(n, pass->mean, pass->solver->r + first);
}

/* p -= step t, u -= step w, r = old - step w in the set old != 0, never 0 there. */
WIDE_VECTORS static void advance(size_t n, double step, const double *t, const double *w,
                                 const double *old, double *p, double *u, double *r,
                                 struct pass_result *out) {
    double sum[LANES] = {0}, high[LANES], low[LANES];
    for (size_t a = 0; a < LANES; a++)
        high[a] = low[a] = -INFINITY;
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double in = old[i + a] != 0 ? 1 : 0, gap = in * (old[i + a] - step * w[i + a]);
            double above = in > 0 ? gap : -INFINITY, below = in > 0 ? -gap : -INFINITY;
            high[a] = above > high[a] ? above : high[a];
            low[a] = below > low[a] ? below : low[a];
            p[i + a] -= step * t[i + a];
            u[i + a] -= step * w[i + a];
            r[i + a] = in * (gap == 0 ? DBL_MIN : gap);
            sum[a] += gap;
        }
    out->sum[GAP] = conjugate_lanes_sum(sum);
    out->most[HIGHEST] = highest_of(high);
    out->most[LOWEST] = highest_of(low);
}

static void advance_block(const struct pass *pass, size_t first, size_t n,
                          struct pass_result *out) {
    const struct conjugate_gradient *s = pass->solver;
    advance(n, pass->step, s->t + first, s->w + first, s->old + first, s->p + first, s->u + first,
            s->r + first, out);
}

/* Makes r != 0 the next set, and sets negative p to 0. */
WIDE_VECTORS static void follow(size_t n, const double *u, const double *z, double approach,
                                double *p, double *r, struct pass_result *out) {
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
    out->sum[STAY] = conjugate_lanes_sum(members);
    out->sum[LEFT] = conjugate_lanes_sum(left);
    out->sum[JOINED] = conjugate_lanes_sum(joined);
    out->sum[PRESSURE] = conjugate_lanes_sum(sum);
    out->most[PENETRATION] = conjugate_lanes_most(through);
    out->most[DEEPEST] = conjugate_lanes_most(deep);
}

static void follow_block(const struct pass *pass, size_t first, size_t n, struct pass_result *out) {
    const struct conjugate_gradient *s = pass->solver;
    follow(n, s->u + first, s->z + first, pass->approach, s->p + first, s->r + first, out);
}

void active_set_close(struct conjugate_gradient *solver, double enough, double share,
                      size_t max_iterations, struct conjugate_gradient_end *end) {
    struct step_memory memory = {.continued = true};
    struct pass pass = {.solver = solver};
    struct pass_result gaps = pass_run(&solver->board, &pass, fill_block);
    const double members = gaps.sum[MEMBERS];
    double begun = 0;
    conjugate_step_take_set(solver, solver->r);
    end->approach = 0;
    for (int step = 0;; step++) {
        pass.mean = gaps.sum[GAP] / members;
        end->inside = larger(gaps.most[HIGHEST] - pass.mean, gaps.most[LOWEST] + pass.mean);
        end->approach -= pass.mean;
        begun = step == 0 ? end->inside : begun;
        if (end->inside <= enough || (step > 0 && end->inside <= share * begun) ||
            step == STEPS_MOST || end->iterations >= max_iterations || !isfinite(end->approach))
            return;
        pass_run(&solver->board, &pass, centre_block);
        conjugate_step_direct(solver, &memory);
        pass.step = conjugate_step_length(solver);
        gaps = pass_run(&solver->board, &pass, advance_block);
        end->iterations++;
    }
}

double active_set_share(const struct conjugate_gradient *solver, int stalled) {
    return (grid_is_profile(&solver->grid) ? PROFILE_PART : SURFACE_PART) * pow(CLOSER, stalled);
}

void active_set_run(struct conjugate_gradient *solver, double mean, double tolerance,
                    size_t max_iterations, struct conjugate_gradient_end *end) {
    const double rounding = CONJUGATE_ROUNDING * conjugate_step_highest(solver);
    double least = INFINITY, best = INFINITY; /* changes of the set, violations */
    size_t asked = end->iterations;
    int stalled = 0;
    while (stalled < SETS_STALLED && end->iterations < max_iterations) {
        active_set_close(solver, fmax(tolerance * end->deepest, rounding),
                         active_set_share(solver, stalled), max_iterations, end);
        const struct pass pass = {.solver = solver, .approach = end->approach};
        struct pass_result next = pass_run(&solver->board, &pass, follow_block);
        end->penetration = next.most[PENETRATION];
        end->deepest = next.most[DEEPEST];
        double violation = fmax(end->inside, end->penetration);
        end->converged = !(next.sum[LEFT] > 0) && isfinite(end->approach) &&
                         violation <= fmax(tolerance * end->deepest, rounding);
        if (end->converged || !isfinite(end->approach))
            return;
        if (end->iterations >= asked + CONJUGATE_ASK) {
            asked = end->iterations;
            end->stopped = solver->stop != NULL && solver->stop(solver->stop_context) != 0;
        }
        double changed = next.sum[LEFT] + next.sum[JOINED];
        bool better = changed < least || violation < 0.5 * best;
        stalled = better ? 0 : stalled + 1;
        if (better) {
            least = changed;
            best = violation;
        }
        if (next.sum[LEFT] > 0) {
            conjugate_step_scale(solver, mean, next.sum[PRESSURE], solver->p);
            conjugate_step_apply_compliance(solver, solver->p, solver->u);
        }
        if (end->stopped)
            return;
    }
}
