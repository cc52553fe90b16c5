/* Contact of the rough face of a surface with itself (F14.11): what self_contact.h does for
 * profiles. Private to self_contact.c.
 *
 * The face is smoothed to a bi-quadratic B-spline of its nodes. Its patch around node (i, j) is
 *
 *   c(s, t) = sum B_a(s) B_b(t) x_(i+a, j+b),  a, b = -1 to 1,  s, t from 0 to 1
 *
 * and a node of either flank meets the nearest point of the nearest patch across air, as in
 * profiles. Lips on the flat are not treated apart.
 *
 * Friction there (F14.21) has two directions: the axes e_1 along dc/ds and e_2 = n x e_1, which
 * turn with the face. With s and t counted on from patch to patch, a pair slides by the vector
 *
 *   w = dc/ds (s - s0) + dc/dt (t - t0)
 *
 * since self_contact_settle, and bears r = P(q' - STIFFNESS w), the nearest vector within friction
 * times p. Where q' has settled, r is against w, or w is 0, whatever the axes. */
#ifndef RUGO_CORE_FULL_SELF_CONTACT_SURFACE_H
#define RUGO_CORE_FULL_SELF_CONTACT_SURFACE_H

#include "core/full/self_pair.h"

/* Makes the arrays of out, whose mesh is set. ERROR_MEMORY. */
int self_contact_surface_create(struct self_contact *out, struct error *err);
double self_contact_surface_bytes(const struct mesh *mesh);
/* Finds the pairs; those of nodes that had one keep its multiplier. */
void self_contact_surface_search(struct self_contact *self, const double *u);
double self_contact_surface_depth(struct self_contact *self, const double *u);
/* Moves a pair to the point nearest to its node and measures its gap there. Where that is beside
 * the node itself there is none, and the gap is out of reach. */
void self_contact_surface_project(const struct mesh *mesh, const double *u, struct self_pair *pair);
/* Adds the force of a pair, and fills its stiffness. */
void self_contact_surface_add(const struct mesh *mesh, const double *u, double penalty, bool convex,
                              const struct self_pair *pair, double *force,
                              struct tangent_patch *patch);
/* Fills where on the face a pair is, in patches along both axes. */
void self_contact_surface_coordinates(const struct mesh *mesh, const struct self_pair *pair,
                                      double at[SIDEWAYS]);
/* Fills what a pair slid, and the force on its node along the face. */
void self_contact_surface_slide(const struct mesh *mesh, const double *u, double penalty,
                                double friction, struct self_pair *pair);
/* Adds that force, and fills its stiffness, which self_contact_surface_add does not have. */
void self_contact_surface_add_friction(const struct mesh *mesh, const double *u, double penalty,
                                       double friction, const struct self_pair *pair, double *force,
                                       struct tangent_friction *rubbing);
/* Returns the area of the face that belongs to a node, as it stands. */
double self_contact_surface_area(const struct mesh *mesh, const double *u, size_t node);

#endif
