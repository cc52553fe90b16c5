/* Sparse Cholesky factorisation of a tangent (CHOLMOD, supernodal): the pattern is analysed once,
 * whatever is in contact.
 *
 * The far side has one vertical displacement for all its nodes, and its first node is held
 * sideways. Nodes in contact are held vertically: their rows and columns become those of 1. */
#ifndef RUGO_CORE_FULL_FACTOR_H
#define RUGO_CORE_FULL_FACTOR_H

#include "core/full/stencil.h"

struct factor;

int factor_create(struct factor **out, const struct mesh *mesh, struct error *err);
void factor_destroy(struct factor **factor);

/* active[face]. ERROR_NUMERIC when the matrix is not positive definite. */
int factor_run(struct factor *factor, const struct stencil *tangent, const bool *active,
               struct error *err);
/* x, mesh_freedoms: from forces to displacements of the last factorisation; 0 where held. Forces on
 * the far side's vertical are summed. */
int factor_solve(struct factor *factor, double *x, struct error *err);

#endif
