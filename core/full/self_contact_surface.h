/* Contact of the rough face of a surface with itself (F14.11): what self_contact.h does for
 * profiles. Private to self_contact.c.
 *
 * The face is smoothed to a bi-quadratic B-spline of its nodes. Its patch around node (i, j) is
 *
 *   c(s, t) = sum B_a(s) B_b(t) x_(i+a, j+b),  a, b = -1 to 1,  s, t from 0 to 1
 *
 * and a node of either flank meets the nearest point of the nearest patch across air, as in
 * profiles. Lips on the flat are not treated apart. */
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
/* Returns the area of the face that belongs to a node, as it stands. */
double self_contact_surface_area(const struct mesh *mesh, const double *u, size_t node);

#endif
