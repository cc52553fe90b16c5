/* Equilibrium of a meshed block on a rigid flat under one load, by Newton's method with a
 * primal-dual active set updated in the same loop (F14.4; Hueber & Wohlmuth 2005; Popp 2012).
 * Private to core/full.
 *
 * The multiplier of a node is its contact force over its tributary area D; the dual basis makes the
 * matrix D diagonal. A node is active, that is in contact, where force - stiffness x gap > 0; its
 * height is then prescribed as that of the flat, which leaves a symmetric positive definite system.
 * Lengths are in the mesh's unit, pressures in E*. */
#ifndef RUGO_CORE_FULL_NEWTON_H
#define RUGO_CORE_FULL_NEWTON_H

#include "core/full/linear/factorisation.h"
#include "core/full/linear/gmres.h"
#include "core/full/self_contact.h"
#include <float.h>
#include <math.h>

enum { NEWTON_HISTORY = 64 };

/* How the linear equations of a step are solved. SOLVER_ITERATED: by gmres.h with the flat block;
 * where that fails, the load step ends, and a smaller one is tried (full.c). In profiles of up to
 * 500 000 degrees of freedom a factorisation is tried before, for the rest of the step. On surfaces
 * of 8 to 16 nodes a side, with slopes to 1 and all ratios of Poisson, 69 factorisations took 50 s
 * and solved no load that smaller steps did not, for which the iterations took 13 s.
 * SOLVER_FACTORED: always with a factorisation; for tests, with the dual weighting or a ratio of
 * Poisson up to 0.45, as its condition is that of the bulk modulus. */
enum equation_solver { SOLVER_ITERATED, SOLVER_FACTORED };

/* A limit of counted work: the same on all machines, so that results are. Seconds are those that
 * estimates of time count (core/cost.h). */
struct full_limit {
    double seconds;                  /* 0: none */
    double newton, linear, factored; /* seconds that an iteration of Newton's method, one of the
                                        linear equations and a factorisation count */
};
/* Returns the seconds that so many count. */
static inline double full_limit_count(const struct full_limit *limit, size_t newton, size_t linear,
                                      size_t factored) {
    return limit->newton * (double)newton + limit->linear * (double)linear +
           limit->factored * (double)factored;
}
/* Returns the limit of what follows after these seconds. */
static inline struct full_limit full_limit_left(const struct full_limit *limit, double used) {
    struct full_limit left = *limit;
    left.seconds = limit->seconds > 0 ? fmax(limit->seconds - used, DBL_MIN) : 0;
    return left;
}
/* Returns how many iterations of the linear equations are left of a limit after these seconds, at
 * least 1. */
static inline size_t full_limit_linear(const struct full_limit *limit, double used) {
    double left = (limit->seconds - used) / limit->linear;
    return limit->seconds > 0 && left < (double)LINEAR_ITERATIONS_MOST ? (size_t)fmax(left, 0) + 1
                                                                       : LINEAR_ITERATIONS_MOST;
}

struct newton {
    const struct mesh *mesh; /* borrowed */
    struct material material;
    struct tangent *tangent; /* owned, as all below */
    enum equation_solver solver;
    struct factorisation *factorisation; /* NULL until one is needed */
    bool factored; /* the factorisation is that of the last tangent, and used for the rest of the
                      load */
    struct gmres *gmres;
    double *u; /* newton_unknowns values: displacements and, where they are unknowns of their own
                  (gmres.h), pressures of elements; whoever changes them sets evaluated to false */
    double *force;  /* newton_unknowns values: inner forces, which at active nodes include the
                       contact force, and the excess of the pressures over those of the dilatation */
    bool overhangs; /* the face may turn from the flat and meet itself (newton_allow_overhangs) */
    struct self_contact self;
    /* Each displacement from the anchor (mesh_degrees_of_freedom values) is dragged by a force of
     * so many E* times the mesh's unit. 0: equilibrium. Whoever changes either sets evaluated to
     * false. Of profiles the first node of the far side then does not move sideways. */
    double drag, *anchor;
    bool evaluated;          /* force and tangent belong to u */
    double *before, *change; /* newton_unknowns: scratch */
    double *gap, *opening;   /* by node of the face, at u: the gap, and the weighted gap */
    bool *active;            /* by node of the face: whether it is in contact */
    double flat_height;      /* vertical position of the flat */
    double tolerance;        /* largest residual, over the largest contact force */
    size_t max_iterations;
    struct full_limit limit;    /* of the next solution */
    int (*stop)(void *context); /* called before each iteration, also of the linear equations;
                                   non-zero stops; may be NULL */
    void *context;
};

int newton_create(struct newton *out, const struct mesh *mesh, const struct material *material,
                  enum gap_weighting weighting, enum equation_solver solver, struct error *err);

/* Prepares for overhangs and drag. From then on the face may turn from the flat, and meets itself.
 * ERROR_INPUT for a profile with too many nodes for a factorisation, or a surface with one. */
int newton_allow_overhangs(struct newton *newton, struct error *err);

size_t newton_unknowns(const struct newton *newton);
void newton_clear(struct newton *newton);

/* The course of a solution. */
struct newton_end {
    size_t iterations; /* Newton's */
    size_t linear;     /* iterations of the linear equations */
    size_t factored;   /* factorisations */
    size_t changes;    /* nodes that entered or left the active set */
    size_t cycles;   /* active sets that were met before; after the first one, nodes change one at a
                        time */
    double residual; /* largest, over the largest contact force */
    double inside;   /* largest |weighted gap| in contact */
    double penetration;             /* largest -weighted gap elsewhere, >= 0 */
    double history[NEWTON_HISTORY]; /* residuals before each iteration, the latest last */
    size_t unchanged;               /* residuals in history since the active set last changed */
};

/* Solves for u and the active set, starting from those given, which should be a good guess; where
 * no node is active, the nearest one becomes so. After ERROR_NUMERIC, and ERROR_STOPPED when stop
 * returned non-zero, u and the set are undefined. */
int newton_solve(struct newton *newton, double pressure, struct newton_end *end, struct error *err);
/* Computes forces and tangent at u, with the pairs of a face that meets itself as they are. Returns
 * false where an element is turned inside out. */
bool newton_evaluate(struct newton *newton);
/* Computes gap and opening from u. */
void newton_measure_gaps(struct newton *newton);
/* Returns the tributary area of a node in squares (profiles: steps) of the mesh's unit; all nodes
 * have the same. */
double newton_node_area(const struct newton *newton);
/* Computes -d(mean gap)/d(pressure) >= 0 from the tangent at u, of the gaps last measured, and, by
 * node of the face, the derivative of its pressure by the mean pressure: mean 1, 0 where open. The
 * linear equations are solved to 1000 times the tolerance and to 1e-6; where they stall, to 1e-4.
 * ERROR_STOPPED when stop returned non-zero. */
int newton_compliance(struct newton *newton, double *out, double *tangent, struct error *err);

#endif
