/* Conjugate gradients in the set of nodes in contact (Polonsky & Keer 1999), preconditioned by the
 * inverse compliance restricted to the set: the residual is transformed, multiplied and transformed
 * back; what lies outside the set is dropped, and the mean is subtracted so that the load stays.
 * Two things differ from the textbook. The search direction is kept when the set changes, with
 * Polak and Ribiere's factor; a restart at every node that opens or closes takes half as many
 * iterations again. On long cells steps that cut pressures at 0 can make long waves overshoot again
 * and again; when progress is slow such steps are shortened to the least energy, which takes no
 * further transform. When there is still no progress, careful steps follow (as in Dostal 1997):
 * conjugate gradients in the set that stop where a pressure becomes 0, and projected gradients
 * where that happened or where penetrations exceed the gaps inside. The energy falls in each of
 * them, in projected steps by at least a fixed part of the square of the change, so that they end
 * at the solution from any start. */
#include "core/contact/conjugate_gradient.h"
#include "core/vectors.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum {
    LANES = CONJUGATE_GRADIENT_LANES,
    REFRESH = 50, /* iterations after which u is computed anew from p */
    TANGENT_MOST = 300,
    SLOW = 30, /* iterations that have not halved the violation, after which steps are shortened */
    ASK = 8, /* iterations after which stop is asked: it may take as long as one of a small grid */
};
/* Length of a projected step over the inverse of the largest compliance, which is 1 here; must be
 * below 2. */
static const double STRIDE = 1.8;
static const double TANGENT_TOLERANCE =
    1e-2; /* relative, of the slope; measured errors are below 3e-4 */
/* Rounding of the highest points can make violations as large as this, over the heights. */
static const double ROUNDING = 64 * DBL_EPSILON;

/* A padded transform takes about as long as three of the grid. */
static const double WIDE_TRANSFORMS = 3;

static void stiffen(struct conjugate_gradient *solver, const double *in, double *out) {
    transform_filter(solver->transform, solver->stiff, 1, in, out);
    solver->transforms += 2;
}

static void soften(struct conjugate_gradient *solver, const double *in, double *out) {
    if (solver->wide == NULL) {
        transform_filter(solver->transform, solver->soft, 1, in, out);
        solver->transforms += 2;
        return;
    }
    transform_filter_part(solver->wide, solver->soft, 1, solver->grid.nx, solver->grid.ny, in, out);
    solver->transforms += 2 * WIDE_TRANSFORMS;
}

static double lanes_sum(const double *lanes) {
    double total = 0;
    for (size_t a = 0; a < LANES; a++)
        total += lanes[a];
    return total;
}

static double lanes_most(const double *lanes) {
    double most = 0;
    for (size_t a = 0; a < LANES; a++)
        most = fmax(most, lanes[a]);
    return most;
}

/* The approach at which nodes under pressure touch on average: minus the mean of u - z over them.
 */
WIDE_VECTORS static double mean_approach(size_t n, const double *p, const double *u,
                                         const double *z) {
    double sum[LANES] = {0}, count[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double in = p[i + a] > 0 ? 1 : 0;
            sum[a] += in * (u[i + a] - z[i + a]);
            count[a] += in;
        }
    return -lanes_sum(sum) / lanes_sum(count);
}

/* r is the gap in the set {p > 0, or gap < 0 where released}, where it is never exactly 0, and 0
 * outside, so that r != 0 marks the set. Returns the size of the set. end->approach is an input;
 * all other fields of end are filled. */
WIDE_VECTORS static double residual(size_t n, const double *p, const double *u, const double *z,
                                    double released, double *r,
                                    struct conjugate_gradient_end *end) {
    double inside[LANES] = {0}, outside[LANES] = {0}, deep[LANES] = {0}, members[LANES] = {0};
    double approach = end->approach;
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double gap = u[i + a] - z[i + a] + approach;
            double in = p[i + a] > 0 ? 1 : 0;
            double within = in * fabs(gap), depth = fabs(u[i + a]);
            double through = gap < 0 ? (in - 1) * gap : 0;
            double member = in + through * released > 0 ? 1 : 0;
            inside[a] = within > inside[a] ? within : inside[a];
            outside[a] = through > outside[a] ? through : outside[a];
            deep[a] = depth > deep[a] ? depth : deep[a];
            members[a] += member;
            r[i + a] = member * (gap == 0 ? DBL_MIN : gap);
        }
    end->inside = lanes_most(inside);
    end->penetration = lanes_most(outside);
    end->deepest = lanes_most(deep);
    return lanes_sum(members);
}

/* The same for the tangent: r = u + approach in the set p > 0. Returns the largest |r|. */
WIDE_VECTORS static double tangent_residual(size_t n, const double *p, const double *u,
                                            double approach, double *r) {
    double most[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double slope = u[i + a] + approach;
            slope = p[i + a] > 0 ? (slope == 0 ? DBL_MIN : slope) : 0;
            most[a] = fabs(slope) > most[a] ? fabs(slope) : most[a];
            r[i + a] = slope;
        }
    return lanes_most(most);
}

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
    return (struct products){.members = lanes_sum(m),
                             .w = lanes_sum(sw),
                             .r = lanes_sum(sr),
                             .old = lanes_sum(so),
                             .t = lanes_sum(st),
                             .w_r = lanes_sum(wr),
                             .w_old = lanes_sum(wo)};
}

/* Sets t to w - w_mean + beta (t - t_mean) in the set, to 0 outside. */
WIDE_VECTORS static void redirect(size_t n, const double *r, const double *w, double w_mean,
                                  double beta, double t_mean, double *t) {
    for (size_t i = 0; i < n; i++) {
        double direction = w[i] - w_mean + beta * (t[i] - t_mean);
        t[i] = r[i] != 0 ? direction : 0;
    }
}

/* Returns r.t/t.w with w = S t: the step to the least energy along t. */
WIDE_VECTORS static double step_length(size_t n, const double *r, const double *t,
                                       const double *w) {
    double above[LANES] = {0}, below[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            above[a] += r[i + a] * t[i + a];
            below[a] += t[i + a] * w[i + a];
        }
    double curvature = lanes_sum(below);
    return curvature > 0 ? lanes_sum(above) / curvature : 0;
}

/* p -= step t, cut at 0, and u -= step w. Returns the sum of p; *cut: whether any was. */
WIDE_VECTORS static double advance(size_t n, double step, const double *t, const double *w,
                                   double *p, double *u, bool *cut) {
    double sum[LANES] = {0}, below[LANES] = {0};
    for (size_t i = 0; i < n; i += LANES)
        for (size_t a = 0; a < LANES; a++) {
            double next = p[i + a] - step * t[i + a];
            below[a] += next < 0 ? 1 : 0;
            next = next < 0 ? 0 : next;
            p[i + a] = next;
            u[i + a] -= step * w[i + a];
            sum[a] += next;
        }
    *cut = lanes_sum(below) > 0;
    return lanes_sum(sum);
}

WIDE_VECTORS static void advance_tangent(size_t n, double step, const double *t, const double *w,
                                         double *q, double *u) {
    for (size_t i = 0; i < n; i++) {
        q[i] -= step * t[i];
        u[i] -= step * w[i];
    }
}

static void scale(size_t n, double factor, double *x) {
    for (size_t i = 0; i < n; i++)
        x[i] *= factor;
}

/* A step of the iteration passes this on to the next one. */
struct step_memory {
    double energy; /* w.r of the last direction; 0 restarts */
    bool blocked;  /* a careful step ended where a pressure came to 0 */
};

/* Computes the next direction t, and w = S t. */
static void direct(struct conjugate_gradient *solver, struct step_memory *memory) {
    stiffen(solver, solver->r, solver->w);
    struct products s = multiply(solver->padded, solver->r, solver->w, solver->old, solver->t);
    double mean = s.w / s.members;
    double energy = s.w_r - mean * s.r, change = energy - (s.w_old - mean * s.old);
    double beta = memory->energy > 0 ? fmax(0, change / memory->energy) : 0;
    redirect(solver->padded, solver->r, solver->w, mean, beta, s.t / s.members, solver->t);
    memory->energy = energy;
    double *last = solver->old;
    solver->old = solver->r;
    solver->r = last;
    soften(solver, solver->t, solver->w);
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
                sum += solver->t[i] - top; /* from the top, so that the lightest load is not lost */
                count++;
            }
        level = (sum - mean * (double)solver->n) / (double)count;
    } while (count != last);
    sum = 0;
    for (size_t i = 0; i < solver->n; i++)
        sum += solver->p[i] = fmax(0, solver->t[i] - top - level);
    scale(solver->n, mean * (double)solver->n / sum, solver->p);
}

/* Returns the longest step along t that leaves no pressure negative. */
static double feasible_step(const struct conjugate_gradient *solver, double step) {
    for (size_t i = 0; i < solver->n; i++)
        if (solver->t[i] > 0 && solver->p[i] > 0 && solver->p[i] < step * solver->t[i])
            step = solver->p[i] / solver->t[i];
    return step;
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

/* Makes one iteration from r; *stale says whether u must be computed anew from p. */
static void iterate(struct conjugate_gradient *solver, double mean, bool careful,
                    struct step_memory *memory, bool *stale) {
    direct(solver, memory);
    double step = step_length(solver->padded, solver->old, solver->t, solver->w);
    if (careful) {
        double longest = feasible_step(solver, step);
        memory->blocked = longest < step;
        step = memory->blocked ? longest * (1 + 4 * DBL_EPSILON) : step; /* that pressure: 0 */
    }
    double sum = advance(solver->padded, step, solver->t, solver->w, solver->p, solver->u, stale);
    if (*stale)
        scale(solver->n, mean * (double)solver->n / sum, solver->p);
}

/* Makes a projected step, after which nothing of the last direction holds. */
static void step_projected(struct conjugate_gradient *solver, double mean,
                           struct step_memory *memory, bool *stale) {
    project(solver, mean);
    *memory = (struct step_memory){0};
    *stale = true;
}

/* Shortens the step from kept_p, where u was kept_u, to a p that was cut at 0: to the one of least
 * energy between them. Where the energy does not fall that way at all, a projected step from kept_p
 * takes its place. *stale: as for iterate. */
static void shorten(struct conjugate_gradient *solver, double mean, struct step_memory *memory,
                    bool *stale) {
    double slope = 0, curvature = 0;
    soften(solver, solver->p, solver->u);
    for (size_t i = 0; i < solver->n; i++) {
        double change = solver->p[i] - solver->kept_p[i];
        slope += (solver->kept_u[i] - solver->z[i]) * change;
        curvature += (solver->u[i] - solver->kept_u[i]) * change;
    }
    bool falls = slope < 0;
    double share = !falls ? 0 : -slope < curvature ? -slope / curvature : 1;
    for (size_t i = 0; share < 1 && i < solver->n; i++) {
        solver->p[i] = solver->kept_p[i] + share * (solver->p[i] - solver->kept_p[i]);
        solver->u[i] = solver->kept_u[i] + share * (solver->u[i] - solver->kept_u[i]);
    }
    *stale = false;
    if (!falls)
        step_projected(solver, mean, memory, stale);
}

/* As iterate, with a step that is shortened where it was cut. */
static void iterate_shortened(struct conjugate_gradient *solver, double mean,
                              struct step_memory *memory, bool *stale) {
    memcpy(solver->kept_p, solver->p, solver->n * sizeof *solver->p);
    memcpy(solver->kept_u, solver->u, solver->n * sizeof *solver->u);
    iterate(solver, mean, false, memory, stale);
    if (*stale)
        shorten(solver, mean, memory, stale);
}

void conjugate_gradient_run(struct conjugate_gradient *solver, double mean, double tolerance,
                            size_t stall_iterations, size_t max_iterations,
                            struct conjugate_gradient_end *end) {
    struct step_memory memory = {0};
    struct stall_watch progress = {.best = INFINITY};
    bool careful = false, stale = true;
    *end = (struct conjugate_gradient_end){0};
    for (size_t i = 0; i < solver->padded; i++)
        solver->t[i] = solver->old[i] = 0;
    double highest = 0;
    for (size_t i = 0; i < solver->n; i++)
        highest = fmax(highest, fabs(solver->z[i]));
    for (;; end->iterations++) {
        if (stale || end->iterations % REFRESH == 0)
            soften(solver, solver->p, solver->u);
        end->approach = mean_approach(solver->padded, solver->p, solver->u, solver->z);
        residual(solver->padded, solver->p, solver->u, solver->z, careful ? 0 : 1, solver->r, end);
        double violation = fmax(end->inside, end->penetration);
        bool number = isfinite(end->approach); /* the largest of numbers and NaNs is a number */
        end->converged = number && violation <= fmax(tolerance * end->deepest, ROUNDING * highest);
        if (end->converged || !number || end->iterations == max_iterations)
            return;
        end->stopped = solver->stop != NULL && end->iterations % ASK == ASK - 1 &&
                       solver->stop(solver->stop_context) != 0;
        if (end->stopped)
            return;
        if (!careful && stalled(&progress, violation, stall_iterations)) {
            careful = memory.blocked = true;
            memory.energy = 0;
        }
        if (careful && (memory.blocked || end->penetration >= end->inside)) {
            step_projected(solver, mean, &memory, &stale);
        } else if (!careful && progress.since >= SLOW) {
            iterate_shortened(solver, mean, &memory, &stale);
        } else {
            iterate(solver, mean, careful, &memory, &stale);
        }
    }
}

double conjugate_gradient_tangent(struct conjugate_gradient *solver) {
    struct step_memory memory = {0};
    double sum = 0, slope = 0;
    for (size_t i = 0; i < solver->padded; i++) {
        solver->q[i] = solver->p[i] > 0 ? solver->q[i] : 0;
        solver->t[i] = solver->old[i] = 0;
        sum += solver->q[i];
    }
    if (!(sum > 0))
        for (size_t i = 0; i < solver->padded; i++)
            sum += solver->q[i] = solver->p[i];
    scale(solver->n, (double)solver->n / sum, solver->q);
    soften(solver, solver->q, solver->u);
    for (size_t iteration = 0;; iteration++) {
        double approach = 0, energy = 0;
        size_t members = 0;
        for (size_t i = 0; i < solver->n; i++) {
            approach -= solver->p[i] > 0 ? solver->u[i] : 0;
            members += solver->p[i] > 0;
            energy += solver->q[i] * solver->u[i];
        }
        approach /= (double)members;
        slope = energy / (double)solver->n;
        double most = tangent_residual(solver->padded, solver->p, solver->u, approach, solver->r);
        if (most <= TANGENT_TOLERANCE * fabs(approach) || iteration == TANGENT_MOST)
            return slope;
        direct(solver, &memory);
        advance_tangent(solver->padded,
                        step_length(solver->padded, solver->old, solver->t, solver->w), solver->t,
                        solver->w, solver->q, solver->u);
    }
}
