/* Sparse Cholesky factorisation of a tangent (CHOLMOD, supernodal). The pattern does not depend on
 * the nodes in contact, so that it is analysed only once, but for a face that meets itself: its
 * pairs change the pattern, which is then analysed in every run.
 *
 * All nodes of the far side share one vertical displacement, and its first node does not move
 * sideways. Rows and columns of vertical displacements in contact are replaced by those of the
 * identity. */
#ifndef RUGO_CORE_FULL_LINEAR_FACTORISATION_H
#define RUGO_CORE_FULL_LINEAR_FACTORISATION_H

#include "core/full/tangent.h"

struct factorisation;

int factorisation_create(struct factorisation **out, const struct mesh *mesh, struct error *err);
void factorisation_destroy(struct factorisation **factorisation);

/* Factorises the tangent for an active set (a flag for each node of the face). ERROR_NUMERIC when
 * the matrix is not positive definite. */
int factorisation_run(struct factorisation *factorisation, const struct tangent *tangent,
                      const bool *active, struct error *err);
/* Replaces the forces x (mesh_degrees_of_freedom values) by the displacements of the last
 * factorisation, which are 0 where nodes are held. Vertical forces on the far side are summed. */
int factorisation_solve(struct factorisation *factorisation, double *x, struct error *err);

#endif
