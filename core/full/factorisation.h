/* Sparse Cholesky factorisation of a tangent (CHOLMOD, supernodal): the pattern is analysed once,
 * whatever is in contact.
 *
 * The far side has one vertical displacement for all its nodes, and its first node is held
 * sideways. Nodes in contact are held vertically: their rows and columns become those of 1. */
#ifndef RUGO_CORE_FULL_FACTORISATION_H
#define RUGO_CORE_FULL_FACTORISATION_H

#include "core/full/tangent.h"

struct factorisation;

int factorisation_create(struct factorisation **out, const struct mesh *mesh, struct error *err);
void factorisation_destroy(struct factorisation **factorisation);

/* active[face]. ERROR_NUMERIC when the matrix is not positive definite. */
int factorisation_run(struct factorisation *factorisation, const struct tangent *tangent,
                      const bool *active, struct error *err);
/* x, mesh_degrees_of_freedom: from forces to displacements of the last factorisation; 0 where held.
 * Forces on the far side's vertical are summed. */
int factorisation_solve(struct factorisation *factorisation, double *x, struct error *err);

#endif
