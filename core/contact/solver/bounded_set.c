#include "core/contact/solver/bounded_set.h"
#include "core/contact/solver/active_set.h"
#include "core/vectors.h"
#include <float.h>
#include <math.h>

enum { LANES = CONJUGATE_GRADIENT_LANES, SETS_STALLED = 12, LEVELS_MOST = 200 };
/* The largest part of a load that no node bears where none is elastic. */
static const double ROUNDING = 1e-12;

/* Sums and largest values of a pass: numbers of nodes, and their pressures. */
enum { STAY, OPENED, YIELDED, JOINED, PRESSURE };
enum { PENETRATION, DEEPEST, LIFTED }; /* as in struct conjugate_gradient_end */

static inline double larger(double a, double b) {
    return a > b ? a : b;
}

/* Returns p, at its bound where it is beyond one. */
static inline double within(double p, double hardness, double opens, double yields) {
    double below = yields > 0 ? hardness : p;
    return opens > 0 ? 0 : below;
}

/* Makes r != 0 the next set of elastic nodes, and sets p to 0 below it and to the hardness above.
 */
WIDE_VECTORS static void follow(size_t n, double hardness, const double *u, const double *z,
                                double approach, double *p, double *r, struct pass_result *out) {
    double members[LANES] = {0}, opened[LANES] = {0}, yielded[LANES] = {0}, joined[LANES] = {0};
    double sum[LANES] = {0}, through[LANES] = {0}, deep[LANES] = {0}, lifted[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double gap = u[i + a] - z[i + a] + approach, depth = fabs(u[i + a]);
            double in = r[i + a] != 0 ? 1 : 0, held = p[i + a] >= hardness ? 1 - in : 0;
            double opens = p[i + a] < 0 ? in : 0, yields = p[i + a] > hardness ? in : 0;
            double joins = gap < 0 ? 1 - in - held : 0, lifts = gap > 0 ? held : 0;
            double below = -joins * gap, above = lifts * gap;
            double member = in - opens - yields + joins + lifts;
            opened[a] += opens;
            yielded[a] += yields;
            joined[a] += joins + lifts;
            members[a] += member;
            through[a] = larger(below, through[a]);
            lifted[a] = larger(above, lifted[a]);
            deep[a] = larger(depth, deep[a]);
            p[i + a] = within(p[i + a], hardness, opens, yields);
            sum[a] += p[i + a];
            r[i + a] = member;
        }
    out->sum[STAY] = conjugate_lanes_sum(members);
    out->sum[OPENED] = conjugate_lanes_sum(opened);
    out->sum[YIELDED] = conjugate_lanes_sum(yielded);
    out->sum[JOINED] = conjugate_lanes_sum(joined);
    out->sum[PRESSURE] = conjugate_lanes_sum(sum);
    out->most[PENETRATION] = conjugate_lanes_most(through);
    out->most[DEEPEST] = conjugate_lanes_most(deep);
    out->most[LIFTED] = conjugate_lanes_most(lifted);
}

static void follow_block(const struct pass *pass, size_t first, size_t n, struct pass_result *out) {
    const struct conjugate_gradient *s = pass->solver;
    follow(n, s->hardness, s->u + first, s->z + first, pass->approach, s->p + first, s->r + first,
           out);
}

double bounded_approach(const struct conjugate_gradient *solver) {
    double least = INFINITY;
    for (size_t i = 0; i < solver->n; i++)
        if (solver->p[i] >= solver->hardness)
            least = fmin(least, solver->z[i] - solver->u[i]);
    return least;
}

/* Returns the sum of t - level within 0 and the hardness; *inside: nodes between. */
static double sum_within(size_t n, double hardness, const double *t, double level, double *inside) {
    double sum = 0, count = 0;
    for (size_t i = 0; i < n; i++) {
        double above = t[i] - level;
        double within = above > 0 && above < hardness ? 1 : 0;
        count += within;
        sum += above >= hardness ? hardness : within * above;
    }
    *inside = count;
    return sum;
}

/* The sum falls with the level, linearly between kinks: Newton's steps, or halved intervals
 * where they leave what is left. */
void bounded_project(struct conjugate_gradient *solver, double mean, double stride) {
    const double load = mean * (double)solver->n, hardness = solver->hardness;
    double *t = solver->t, low = INFINITY, high = -INFINITY, inside;
    for (size_t i = 0; i < solver->n; i++) {
        t[i] = solver->p[i] - stride * (solver->u[i] - solver->z[i]);
        low = fmin(low, t[i]);
        high = fmax(high, t[i]);
    }
    low -= hardness;
    double level = 0.5 * (low + high);
    for (size_t step = 0; step < LEVELS_MOST; step++) {
        double over = sum_within(solver->n, hardness, t, level, &inside) - load;
        if (over > 0)
            low = level;
        else
            high = level;
        double next = inside > 0 ? level + over / inside : INFINITY;
        if (fabs(over) <= 4 * DBL_EPSILON * load || next == level)
            break;
        level = next > low && next < high ? next : 0.5 * (low + high);
    }
    for (size_t i = 0; i < solver->n; i++)
        solver->p[i] = fmin(hardness, fmax(0, t[i] - level));
}

/* Returns whether the load was right, or elastic nodes could bear what was missing: each by its
 * distance to both bounds. */
static bool balance_elastic(struct conjugate_gradient *solver, double mean) {
    const double load = mean * (double)solver->n, hardness = solver->hardness;
    double sum = 0, room = 0;
    for (size_t i = 0; i < solver->n; i++) {
        sum += solver->p[i];
        room += solver->p[i] * (1 - solver->p[i] / hardness);
    }
    double part = (load - sum) / room;
    if (!(fabs(part) <= 1))
        return fabs(load - sum) <= ROUNDING * load;
    for (size_t i = 0; i < solver->n; i++)
        solver->p[i] += part * solver->p[i] * (1 - solver->p[i] / hardness);
    return true;
}

bool bounded_balance(struct conjugate_gradient *solver, double mean) {
    if (balance_elastic(solver, mean))
        return true;
    bounded_project(solver, mean, 1 / solver->local);
    balance_elastic(solver, mean);
    return false;
}

/* Makes r != 0 the nodes between the bounds. */
static void take_elastic(struct conjugate_gradient *solver) {
    for (size_t i = 0; i < solver->n; i++)
        solver->r[i] = solver->p[i] > 0 && solver->p[i] < solver->hardness ? 1 : 0;
}

/* Returns the number of nodes in the set r != 0. */
static double count_members(const struct conjugate_gradient *solver) {
    double members = 0;
    for (size_t i = 0; i < solver->n; i++)
        members += solver->r[i] != 0 ? 1 : 0;
    return members;
}

/* Brings pressures of any size within the bounds and to the mean. */
static void cut(struct conjugate_gradient *solver, double mean) {
    for (size_t i = 0; i < solver->n; i++)
        solver->p[i] = fmin(solver->hardness, fmax(0, solver->p[i]));
    bounded_balance(solver, mean);
}

/* Goes on from pressures that were set to a bound. */
static void balance(struct conjugate_gradient *solver, double mean, double sum,
                    const struct conjugate_gradient_end *end) {
    if (!end->bounded)
        conjugate_step_scale(solver, mean, sum, solver->p);
    else if (!bounded_balance(solver, mean))
        take_elastic(solver);
    conjugate_step_apply_compliance(solver, solver->p, solver->u);
}

/* Fills what a pass found, and whether that is the solution. Returns the largest violation. */
static double fill_end(const struct pass_result *next, double tolerance, double rounding,
                       struct conjugate_gradient_end *end) {
    end->bounded = end->bounded || next->sum[YIELDED] > 0;
    end->penetration = next->most[PENETRATION];
    end->lifted = next->most[LIFTED];
    end->deepest = next->most[DEEPEST];
    double violation = fmax(end->inside, fmax(end->penetration, end->lifted));
    end->converged = !(next->sum[OPENED] + next->sum[YIELDED] > 0) && isfinite(end->approach) &&
                     violation <= fmax(tolerance * end->deepest, rounding);
    return violation;
}

void bounded_set_run(struct conjugate_gradient *solver, double mean, double tolerance,
                     size_t max_iterations, struct conjugate_gradient_end *end) {
    const double rounding = CONJUGATE_ROUNDING * conjugate_step_highest(solver);
    struct set_progress progress = {INFINITY, INFINITY, 0};
    double members = count_members(solver);
    double changed = INFINITY;
    size_t asked = end->iterations;
    /* The first guess may have yielded nodes, which no elastic step must scale. */
    for (size_t i = 0; i < solver->n && !end->bounded; i++)
        end->bounded = solver->p[i] >= solver->hardness;
    while (progress.stalled < SETS_STALLED && end->iterations < max_iterations) {
        /* A set that has not changed is solved to the end. */
        double share =
            changed > 0 || !end->bounded ? active_set_share(solver, progress.stalled) : 0;
        end->inside = 0;
        if (members > 0)
            active_set_close(solver, fmax(tolerance * end->deepest, rounding), share,
                             max_iterations, end);
        else
            end->approach = bounded_approach(solver);
        const struct pass pass = {.solver = solver, .approach = end->approach};
        struct pass_result next = pass_run(&solver->board, &pass, follow_block);
        double cuts = next.sum[OPENED] + next.sum[YIELDED];
        members = next.sum[STAY];
        double violation = fill_end(&next, tolerance, rounding, end);
        if (end->converged || !isfinite(end->approach))
            return;
        if (end->iterations >= asked + CONJUGATE_ASK) {
            asked = end->iterations;
            end->stopped = solver->stop != NULL && solver->stop(solver->stop_context) != 0;
        }
        changed = cuts + next.sum[JOINED];
        set_progress_watch(&progress, changed, violation, end->bounded);
        if (cuts > 0) {
            balance(solver, mean, next.sum[PRESSURE], end);
            members = count_members(solver);
        }
        if (end->stopped)
            break;
    }
    cut(solver, mean);
}
