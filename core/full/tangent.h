/* Forces and tangent stiffness of a whole mesh. A node has neighbours only one step away in each
 * direction, so that the matrix is a tangent: no indices are stored. It is symmetric; what a node
 * feels of the level above is kept there. */
#ifndef RUGO_CORE_FULL_TANGENT_H
#define RUGO_CORE_FULL_TANGENT_H

#include "core/full/volumetric.h"

enum { NEIGHBOURS_MOST = 18 };

/* values[((node*slots + slot)*d + i)*d + j]: force i of the node by displacement j of its
 * neighbour in the slot. Far side and held node are not treated yet (gmres.h, factorisation.h). */
struct tangent {
    const struct mesh *mesh;       /* borrowed */
    size_t slots;                  /* 2 * 3^(dimension - 1): of its own level, then of the next */
    double *values;                /* owned */
    struct volumetric *volumetric; /* owned: part of the values; NULL: not told apart */
    bool bound; /* pressures are taken to be those of the dilatation, whatever is given */
};

/* volumetric: whether it is. */
int tangent_create(struct tangent **out, const struct mesh *mesh, bool pressures,
                   struct error *err);
void tangent_destroy(struct tangent **tangent);
double tangent_bytes(const struct mesh *mesh, bool pressures);

/* Neighbours, by slot, of the node of a level in row j, column i; SIZE_MAX beyond the far side. */
void tangent_neighbours(const struct mesh *mesh, size_t level, size_t j, size_t i,
                        size_t neighbour[NEIGHBOURS_MOST]);
/* y = K x, both mesh_degrees_of_freedom. */
void tangent_apply(const struct tangent *tangent, const double *x, double *y);

/* Displacements and, where the tangent tells the volumetric apart, the pressures of the elements.
 */
size_t tangent_unknowns(const struct tangent *tangent);

/* Energy (NULL: not wanted) and inner forces at displacements u, both mesh_degrees_of_freedom, and
 * the tangent (NULL: not wanted; all forces of u alone). Where it tells the volumetric apart u and
 * force go on with tangent_unknowns: pressures of elements, and what they are beyond those of the
 * dilatation. False when an element is turned inside out; the outputs are void then. */
bool tangent_evaluate(const struct mesh *mesh, const struct material *material, const double *u,
                      double *energy, double *force, struct tangent *tangent);

#endif
