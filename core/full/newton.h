/* Equilibrium of a meshed block on a rigid flat under one load: Newton's method and the primal-dual
 * active set in one loop (Hueber & Wohlmuth 2005; Popp 2012). Private to core/full.
 *
 * A node's multiplier is its contact force over D, its tributary area; the dual basis makes D
 * diagonal. A node is active where force - stiffness x gap > 0, and then its height is that of the
 * flat: what is left is symmetric and positive definite. Lengths are the mesh's, pressures in E*.
 */
#ifndef RUGO_CORE_FULL_NEWTON_H
#define RUGO_CORE_FULL_NEWTON_H

#include "core/full/factor.h"

enum { NEWTON_HISTORY = 64 };

struct newton {
    const struct mesh *mesh; /* borrowed */
    struct solid solid;
    struct stencil *tangent; /* owned, as all below */
    struct factor *factor;
    double *u;                      /* mesh_freedoms: displacements */
    double *force;                  /* inner forces: those of the contact on the face */
    double *before, *change, *rest; /* scratch */
    bool *active;                   /* face */
    double flat;                    /* vertical position of the flat */
    double tolerance;               /* largest residual, over the largest contact force */
    size_t max_iterations;
};

int newton_create(struct newton *out, const struct mesh *mesh, const struct solid *solid,
                  struct error *err);
void newton_clear(struct newton *newton);

/* How an equilibrium was reached. */
struct newton_end {
    size_t iterations;  /* factorisations */
    size_t changes;     /* of single nodes of the active set */
    size_t cycles;      /* active sets that came back and had to be taken apart node by node */
    double residual;    /* largest, over the largest contact force */
    double inside;      /* largest |gap| in contact */
    double penetration; /* largest -gap elsewhere, >= 0 */
    double history[NEWTON_HISTORY]; /* residuals before each iteration; the latest last ... */
    size_t unchanged;               /* ... and how many of them since the active set changed */
};

/* From u and the active set given, which should be a good guess; at least one node is taken as
 * active. ERROR_NUMERIC leaves u and the set of no use. */
int newton_settle(struct newton *newton, double pressure, struct newton_end *end,
                  struct error *err);
/* Gap of a node of the face to the flat. */
double newton_gap(const struct newton *newton, size_t node);
/* D of every node, and its sum. */
double newton_node_area(const struct newton *newton);
/* -d(mean gap)/d(pressure) >= 0 by the last tangent; uses the scratch. */
int newton_compliance(struct newton *newton, double *out, struct error *err);

#endif
