/* One linear step of Newton's: generalised minimal residuals (Saad &
 * Schultz 1986; flexible, Saad 1993), preconditioned by the flat block standing on the same nodes:
 * its stiffness is inverted exactly by waves (flat.h), its contact forces come from the face alone
 * (support.h). What is left to iterate is how far the rough block differs from the flat one: about
 * ten iterations at RMS slopes of 0.1, whatever the number of nodes.
 *
 * Where that is too far, as it is for steep or nearly incompressible blocks, a factorisation of the
 * tangent itself (factor.h) takes the flat block's place. With the dual weighting it is exact. */
#ifndef RUGO_CORE_FULL_KRYLOV_H
#define RUGO_CORE_FULL_KRYLOV_H

#include "core/full/factor.h"
#include "core/full/stencil.h"
#include "core/full/support.h"

struct krylov;

int krylov_create(struct krylov **out, const struct mesh *mesh, const struct solid *solid,
                  enum gap_weighting weighting, struct error *err);
void krylov_destroy(struct krylov **krylov);

/* Of an object for this mesh. */
double krylov_bytes(const struct mesh *mesh);

/* Whether the tangent has to tell its bulk part apart. */
bool krylov_needs_bulk(const struct solid *solid);

/* The weighted values of the face's nodes. */
void krylov_weigh(const struct krylov *krylov, const double *in, double *out);
/* What is to be solved; borrows all. */
struct equations {
    const struct stencil *tangent;
    const bool *active;    /* face */
    struct factor *factor; /* of that tangent and set; NULL: the flat block serves */
};

/* x, mesh_freedoms: in, forces, with the far side's vertical ones at its first node, and on
 * vertical freedoms in contact the change asked of the weighted gap; out, displacements. Ends when
 * the residual is `tolerance` of what it was; ERROR_NUMERIC when it does not get there. Adds to
 * *iterations. */
int krylov_solve(struct krylov *krylov, const struct equations *equations, double tolerance,
                 double *x, size_t *iterations, struct error *err);

#endif
