#include "core/contact/solver/active_set.h"
#include "core/vectors.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum {
    LANES = CONJUGATE_GRADIENT_LANES,
    STEPS_MOST = 8, /* within one set */
    STEPS_CLOSELY = 400,
    SETS_STALLED = 12,
    SETS_EXCHANGED = 6, /* stalled, after which one node alone leaves or joins */
    SETS_MOST = 100,    /* where they are to be solved closely next; random contacts take 5 to 10 */
};
/* A set is solved until its gaps are this part of the initial ones, of profiles mostly in two
 * steps, of surfaces in one. Profiles of 512 longest waves took 175 steps with the part of
 * surfaces, and 128 with theirs. After a set that was no better gaps must be CLOSER times smaller
 * still: long waves that are left over make nodes leave and join again and again. */
static const double PROFILE_PART = 0.03, SURFACE_PART = 0.1, CLOSER = 0.3;
/* Of these parts where sets are to be solved closely: under a thin coating that is hundreds of
 * times as stiff as the block a residual gap of 1e-2 leaves pressures of both signs, and sets that
 * change for ever. */
static const double CLOSELY = 1e-3;

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

/* Takes so many steps at most. */
static void close_set(struct conjugate_gradient *solver, double enough, double share, int steps,
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
        if (end->inside <= enough || (step > 0 && end->inside <= share * begun) || step == steps ||
            end->iterations >= max_iterations || !isfinite(end->approach))
            return;
        pass_run(&solver->board, &pass, centre_block);
        conjugate_step_direct(solver, &memory);
        pass.step = conjugate_step_length(solver);
        gaps = pass_run(&solver->board, &pass, advance_block);
        end->iterations++;
    }
}

void active_set_close(struct conjugate_gradient *solver, double enough, double share,
                      size_t max_iterations, struct conjugate_gradient_end *end) {
    close_set(solver, enough, share, STEPS_MOST, max_iterations, end);
}

double active_set_share(const struct conjugate_gradient *solver, int stalled) {
    return (grid_is_profile(&solver->grid) ? PROFILE_PART : SURFACE_PART) * pow(CLOSER, stalled);
}

/* Returns the last node that is under tension in the set r != 0, or penetrates outside of it; n
 * without any. Keeps the set in w. */
static size_t last_wrong(const struct conjugate_gradient *solver, double approach) {
    size_t last = solver->n;
    memcpy(solver->w, solver->r, solver->padded * sizeof *solver->r);
    for (size_t i = 0; i < solver->n; i++) {
        const bool in = solver->r[i] != 0;
        if (in ? solver->p[i] < 0 : solver->u[i] - solver->z[i] + approach < 0)
            last = i;
    }
    return last;
}

/* Makes r the set of w again, but for one node. */
static void exchange(struct conjugate_gradient *solver, size_t node) {
    memcpy(solver->r, solver->w, solver->padded * sizeof *solver->r);
    solver->r[node] = solver->r[node] != 0 ? 0 : 1;
}

void set_progress_watch(struct set_progress *progress, double changed, double violation,
                        bool never_rises) {
    const bool better = changed < progress->least || violation < 0.5 * progress->best;
    progress->stalled = better ? 0 : progress->stalled + 1;
    if (never_rises) {
        progress->least = fmin(changed, progress->least);
        progress->best = fmin(violation, progress->best);
    } else if (better) {
        progress->least = changed;
        progress->best = violation;
    }
}

/* Solves in the set, with a residual that is smaller after sets that were no better. */
static void close_next(struct conjugate_gradient *solver, double enough, int stalled, bool closely,
                       size_t max_iterations, struct conjugate_gradient_end *end) {
    const double share = active_set_share(solver, stalled < SETS_STALLED ? stalled : SETS_STALLED);
    if (closely)
        close_set(solver, enough, share * CLOSELY, STEPS_CLOSELY, max_iterations, end);
    else
        close_set(solver, enough, share, STEPS_MOST, max_iterations, end);
}

void active_set_run(struct conjugate_gradient *solver, double mean, double tolerance, bool closely,
                    size_t max_iterations, struct conjugate_gradient_end *end) {
    const double rounding = CONJUGATE_ROUNDING * conjugate_step_highest(solver);
    struct set_progress progress = {INFINITY, INFINITY, 0};
    size_t asked = end->iterations;
    const size_t most = closely ? max_iterations : SETS_MOST; /* a set may take no step */
    for (size_t set = 0; set < most && end->iterations < max_iterations; set++) {
        if (!closely && progress.stalled >= SETS_STALLED)
            return;
        close_next(solver, fmax(tolerance * end->deepest, rounding), progress.stalled, closely,
                   max_iterations, end);
        const size_t wrong = closely && progress.stalled >= SETS_EXCHANGED
                                 ? last_wrong(solver, end->approach)
                                 : solver->n;
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
        set_progress_watch(&progress, next.sum[LEFT] + next.sum[JOINED], violation, closely);
        if (wrong < solver->n)
            exchange(solver, wrong);
        if (next.sum[LEFT] > 0) {
            conjugate_step_scale(solver, mean, next.sum[PRESSURE], solver->p);
            conjugate_step_apply_compliance(solver, solver->p, solver->u);
        }
        if (end->stopped)
            return;
    }
}
