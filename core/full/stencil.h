/* Forces and tangent stiffness of a whole mesh. A node has neighbours only one step away in each
 * direction, so that the matrix is a stencil: no indices are stored. It is symmetric; what a node
 * feels of the level above is kept there. */
#ifndef RUGO_CORE_FULL_STENCIL_H
#define RUGO_CORE_FULL_STENCIL_H

#include "core/full/bulk.h"

enum { STENCIL_MOST = 18 };

/* values[((node*slots + slot)*d + i)*d + j]: force i of the node by displacement j of its
 * neighbour in the slot. Far side and held node are not treated yet (krylov.h, factor.h). */
struct stencil {
    const struct mesh *mesh; /* borrowed */
    size_t slots;            /* 2 * 3^(dimension - 1): of its own level, then of the next */
    double *values;          /* owned */
    struct bulk *bulk;       /* owned: part of the values; NULL: not told apart */
    bool bound; /* pressures are taken to be those of the dilatation, whatever is given */
};

/* bulk: whether it is. */
int stencil_create(struct stencil **out, const struct mesh *mesh, bool bulk, struct error *err);
void stencil_destroy(struct stencil **stencil);
double stencil_bytes(const struct mesh *mesh, bool bulk);

/* Neighbours, by slot, of the node of a level in row j, column i; SIZE_MAX beyond the far side. */
void stencil_neighbours(const struct mesh *mesh, size_t level, size_t j, size_t i,
                        size_t neighbour[STENCIL_MOST]);
/* y = K x, both mesh_freedoms. */
void stencil_apply(const struct stencil *stencil, const double *x, double *y);

/* Displacements and, where the tangent tells the bulk apart, the pressures of the elements. */
size_t stencil_unknowns(const struct stencil *stencil);

/* Energy (NULL: not wanted) and inner forces at displacements u, both mesh_freedoms, and the
 * tangent (NULL: not wanted; all forces of u alone). Where it tells the bulk apart u and force go
 * on with stencil_unknowns: pressures of elements, and what they are beyond those of the
 * dilatation. False when an element is turned inside out; the outputs are void then. */
bool stencil_evaluate(const struct mesh *mesh, const struct solid *solid, const double *u,
                      double *energy, double *force, struct stencil *tangent);

#endif
