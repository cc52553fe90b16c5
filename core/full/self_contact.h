/* Contact of the rough face with itself, where it overhangs and folds: of profiles as follows
 * (F14.10), of surfaces as in self_contact_surface.h (F14.11).
 *
 * Nodes on each flank of a fold meet the other one, which is smoothed: the quadratic B-spline of
 * its nodes, a curve without corners that touches the middles of the cells. Nodes of one flank
 * alone would let corners of the other through between them. Its arc around node
 * k is c(t) = sum B_i(t) x_i, i = k - 1 to k + 1, t from 0 to 1. A node meets the nearest point of
 * the nearest arc across air, at the gap
 *
 *   g = n . (x_node - c(t))
 *
 * along the unit normal n out of the block there, and the force along n is p = max(0, q - STIFFNESS
 * g). Newton's method solves for equilibrium under these forces, with n and t as they follow the
 * face; then q becomes p, until nothing changes (augmented Lagrangian: Hestenes 1969, Powell 1969).
 * Then g p = 0 to the tolerance: q is the multiplier, and STIFFNESS does not matter. With friction
 * there is a force along the arc, likewise within friction times p, against the slip since the last
 * step.
 *
 * Lips of a fold that both lie on the flat meet as nodes: of two nodes in contact with the flat,
 * between which none is and the face overhangs, the gap is the distance along the flat. The curve
 * there is rounded off, so that one lip could slide under the other.
 *
 * A face without cells that are turned from the flat is a graph, and cannot meet itself: nothing
 * is searched. Lengths are in the mesh's unit, forces in E* times it. Private to core/full. */
#ifndef RUGO_CORE_FULL_SELF_CONTACT_H
#define RUGO_CORE_FULL_SELF_CONTACT_H

#include "core/full/self_pair.h"

int self_contact_create(struct self_contact *out, const struct mesh *mesh, struct error *err);
void self_contact_clear(struct self_contact *self);
/* Gives the face this friction with itself. ERROR_MEMORY. */
int self_contact_add_friction(struct self_contact *self, double friction, struct error *err);
double self_contact_bytes(const struct mesh *mesh);

/* Find the pairs at displacements u, and how deep the deepest node is in the face. active: by node
 * of the face, whether it touches the flat. Nodes that had a pair before keep its multiplier. */
void self_contact_search(struct self_contact *self, const double *u, const bool *active);
double self_contact_depth(struct self_contact *self, const double *u, const bool *active);
/* Adds the forces of the pairs at u to inner forces, and gives the tangent their stiffness. Without
 * friction it is symmetric, and positive definite where convex: without the terms of the forces. */
void self_contact_evaluate(struct self_contact *self, bool convex, const double *u, double *force,
                           struct tangent *tangent);
/* Takes the forces as multipliers and finds the pairs anew. Returns the largest change of a force
 * that is left: what gaps under force, and depths, are times STIFFNESS. */
double self_contact_renew(struct self_contact *self, const double *u, const bool *active);

/* Of a step of Newton's method: depth of a node in columns that makes it too long, and columns that
 * it moves a node at most, as what meets across more may pass through unseen. */
#define SELF_DEEPEST 0.25
#define SELF_LONGEST 0.5

/* Rounds in which multipliers settle. Initialise with {0}. */
struct self_rounds {
    int count;
    bool settled; /* the last one left nothing but rounding of the balance */
};
/* Does self_contact_renew where Newton's method has balanced to a tolerance over the largest
 * contact force. *met: whether there are pairs, or were before, so that forces are to be evaluated
 * anew. ERROR_NUMERIC after too many rounds. */
int self_contact_round(struct self_contact *self, const double *u, const bool *active,
                       double tolerance, double largest, struct self_rounds *rounds, bool *met,
                       struct error *err);

/* Slip counts from the present points on; and the work that friction has taken since then, by
 * trapezoids. */
void self_contact_settle(struct self_contact *self);
double self_contact_dissipation(const struct self_contact *self);

/* What a face does to itself. */
struct self_measure {
    size_t nodes;       /* that bear a force */
    double length;      /* of the face at these nodes, as it stands; of surfaces its area */
    double force;       /* sum */
    double penetration; /* of the deepest node in the smoothed face */
};
struct self_measure self_contact_measure(struct self_contact *self, const double *u,
                                         const bool *active);

#endif
