/* Equilibrium of a meshed block on a rigid flat under one load: Newton's method and the primal-dual
 * active set in one loop (Hueber & Wohlmuth 2005; Popp 2012). Private to core/full.
 *
 * A node's multiplier is its contact force over D, its tributary area; the dual basis makes D
 * diagonal. A node is active where force - stiffness x gap > 0, and then its height is that of the
 * flat: what is left is symmetric and positive definite. Lengths are the mesh's, pressures in E*.
 */
#ifndef RUGO_CORE_FULL_NEWTON_H
#define RUGO_CORE_FULL_NEWTON_H

#include "core/full/factorisation.h"
#include "core/full/gmres.h"

enum { NEWTON_HISTORY = 64 };

/* How the linear equations of a step are solved: by iterations with the flat block, and where they
 * fail, on meshes of up to 500 000 degrees_of_freedom in profiles and 20 000 on surfaces, with a
 * factorisation for the rest of the load; or always with a factorisation. */
enum equation_solver { SOLVER_ITERATED, SOLVER_FACTORED };

struct newton {
    const struct mesh *mesh; /* borrowed */
    struct material material;
    struct tangent *tangent; /* owned, as all below */
    enum equation_solver solver;
    struct factorisation *factorisation; /* NULL until one is needed */
    bool factored; /* factor is of the last tangent, and takes the rest of the load */
    struct gmres *gmres;
    double *u;      /* newton_unknowns: displacements, and pressures of elements where these are
                       unknowns of their own (tangent.h); who changes them clears evaluated */
    double *force;  /* newton_unknowns: inner forces, those of the contact on the face, and what the
                       pressures are beyond those of the dilatation */
    bool evaluated; /* force and tangent are those of u */
    double *before, *change; /* newton_unknowns: scratch */
    double *gap, *opening;   /* face, at u: at the nodes and weighted */
    bool *active;            /* face */
    double flat;             /* vertical position of the flat */
    double tolerance;        /* largest residual, over the largest contact force */
    size_t max_iterations;
    int (*stop)(void *context); /* asked before each iteration; NULL: not */
    void *context;
};

int newton_create(struct newton *out, const struct mesh *mesh, const struct material *material,
                  enum gap_weighting weighting, enum equation_solver solver, struct error *err);

size_t newton_unknowns(const struct newton *newton);
void newton_clear(struct newton *newton);

/* How an equilibrium was reached. */
struct newton_end {
    size_t iterations;  /* Newton's */
    size_t linear;      /* iterations of the linear equations */
    size_t factored;    /* factorisations */
    size_t changes;     /* of single nodes of the active set */
    size_t cycles;      /* active sets that came back; from the first on nodes change one by one */
    double residual;    /* largest, over the largest contact force */
    double inside;      /* largest |weighted gap| in contact */
    double penetration; /* largest -weighted gap elsewhere, >= 0 */
    double history[NEWTON_HISTORY]; /* residuals before each iteration; the latest last ... */
    size_t unchanged;               /* ... and how many of them since the active set changed */
};

/* From u and the active set given, which should be a good guess; at least one node is taken as
 * active. ERROR_NUMERIC, and ERROR_STOPPED where stop gave non-zero, leave u and the set of no use.
 */
int newton_settle(struct newton *newton, double pressure, struct newton_end *end,
                  struct error *err);
/* Fills gap and opening. */
void newton_measure_gaps(struct newton *newton);
/* D of every node, and its sum. */
double newton_node_area(const struct newton *newton);
/* -d(mean gap)/d(pressure) >= 0 by the tangent at u. */
int newton_compliance(struct newton *newton, double *out, struct error *err);

#endif
