/* Forces and tangent stiffness of a whole mesh. A node has neighbours only one step away in each
 * direction, so that the matrix is a stencil: no indices are stored. */
#ifndef RUGO_CORE_FULL_STENCIL_H
#define RUGO_CORE_FULL_STENCIL_H

#include "core/full/element.h"
#include "core/full/mesh.h"

/* values[((node*slots + slot)*d + i)*d + j]: force i of the node by displacement j of its
 * neighbour in the slot. Far side and held node are not treated yet (solver.h). */
struct stencil {
    const struct mesh *mesh; /* borrowed */
    size_t slots;            /* 3^dimension */
    double *values;          /* owned */
};

int stencil_create(struct stencil **out, const struct mesh *mesh, struct error *err);
void stencil_destroy(struct stencil **stencil);

/* Neighbour of a node in a slot, or SIZE_MAX beyond the face or the far side. */
size_t stencil_neighbour(const struct mesh *mesh, size_t node, size_t slot);
/* y = K x, both mesh_freedoms. */
void stencil_apply(const struct stencil *stencil, const double *x, double *y);

/* Energy (NULL: not wanted) and inner forces (mesh_freedoms) at displacements u, and the tangent
 * (NULL: not wanted). False when an element is turned inside out; the outputs are void then. */
bool stencil_evaluate(const struct mesh *mesh, const struct solid *solid, const double *u,
                      double *energy, double *force, struct stencil *tangent);

#endif
