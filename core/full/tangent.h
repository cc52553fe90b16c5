/* Forces and tangent stiffness of a whole mesh. A node is coupled only to nodes one step away in
 * each direction, so that the matrix is stored as a stencil, without indices. It is symmetric: the
 * blocks between a node and the level above it are stored with the nodes of that level. */
#ifndef RUGO_CORE_FULL_TANGENT_H
#define RUGO_CORE_FULL_TANGENT_H

#include "core/full/volumetric.h"

enum { NEIGHBOURS_MOST = 18 };

/* Stiffness between degrees of freedom at[i] and at[j] that need be no neighbours; symmetric but
 * for friction. */
enum { LINK_MOST = 8 };
struct tangent_link {
    size_t at[LINK_MOST];
    double stiffness[LINK_MOST][LINK_MOST];
};

/* As a link, between a node and the nine of a patch of a surface (self_contact_surface.h): V^T C V
 * with the vectors V, one a row, of three values a node, and the symmetric matrix C. */
enum { PATCH_NODES = 9, PATCH_VECTORS = 5 };
struct tangent_patch {
    size_t node[1 + PATCH_NODES];
    double vector[PATCH_VECTORS][3 * (1 + PATCH_NODES)];
    double matrix[PATCH_VECTORS][PATCH_VECTORS];
};

/* Beside a patch, where it has friction: V^T C V with the nine values V of how the node moves over
 * the point of the patch that it meets, and how the two tangents there change with the nodes alone,
 * three components each. They are sums over the nodes of displacements by weights. */
enum { FRICTION_VECTORS = 3, FRICTION_VALUES = 3 * FRICTION_VECTORS };
struct tangent_friction {
    size_t node[1 + PATCH_NODES];
    double weight[FRICTION_VECTORS][1 + PATCH_NODES];
    double matrix[FRICTION_VALUES][FRICTION_VALUES];
};

/* values[((node*slots + slot)*d + i)*d + j]: force i of the node by displacement j of its
 * neighbour in the slot. The conditions on the far side are not applied here but in gmres.c and
 * factorisation.c. */
struct tangent {
    const struct mesh *mesh; /* borrowed */
    size_t slots;            /* 2 * 3^(dimension - 1): neighbours on the own level, then below */
    double *values;          /* owned */
    const struct tangent_link *link; /* borrowed */
    size_t links;
    const struct tangent_patch *patch; /* borrowed; not in factorisations */
    size_t patches;
    const struct tangent_friction *rubbing; /* borrowed; not in factorisations */
    size_t rubbings;
    struct volumetric
        *volumetric; /* owned: the volumetric part apart, which values hold too; or NULL */
};

/* Makes a tangent; pressures says whether it has a volumetric part (gmres.h). */
int tangent_create(struct tangent **out, const struct mesh *mesh, const struct material *material,
                   bool pressures, struct error *err);
void tangent_destroy(struct tangent **tangent);
double tangent_bytes(const struct mesh *mesh, bool pressures);

/* Finds the neighbours, by slot, of a level's node in row j and column i; SIZE_MAX below the far
 * side. */
void tangent_neighbours(const struct mesh *mesh, size_t level, size_t j, size_t i,
                        size_t neighbour[NEIGHBOURS_MOST]);
/* Computes y = K x; x and y have mesh_degrees_of_freedom values. */
void tangent_apply(const struct tangent *tangent, const double *x, double *y);

/* Returns the number of displacements and, where the tangent stores the volumetric part apart, of
 * the elements' pressures. */
size_t tangent_unknowns(const struct tangent *tangent);

/* Adds a drag (E* times the mesh's unit) on each displacement from `before` to forces and tangent.
 */
void tangent_add_drag(struct tangent *tangent, double drag, const double *u, const double *before,
                      double *force);

/* Computes the energy (E* times the cube, of profiles the square, of the mesh's unit; may be NULL),
 * the inner forces at displacements u, and the tangent (may be NULL), which contains all forces as
 * functions of u alone. With a volumetric part, u and force have tangent_unknowns values: behind
 * the displacements the elements' pressures, and behind the forces the excess of these pressures
 * over those of the dilatations, times volumetric->row. Returns false, with undefined outputs, when
 * an element is inverted. */
bool tangent_evaluate(const struct mesh *mesh, const struct material *material, const double *u,
                      double *energy, double *force, struct tangent *tangent);

#endif
