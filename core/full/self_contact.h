/* Contact of the rough face of a profile with itself, where it overhangs and folds (F14.10).
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

#include "core/full/tangent.h"

enum { ARC_NODES = 3, PAIRS_A_NODE = 3 };

/* What a pair is: a node of the left or the right flank and an arc of the other one, or two lips
 * on the flat. */
enum self_kind { SELF_LEFT, SELF_RIGHT, SELF_LIPS, SELF_KINDS };
struct self_pair {
    size_t node, arc; /* of the face: the node, and that around which the arc is */
    enum self_kind kind;
    double at;         /* t, as all below at the displacements last evaluated */
    double normal[2];  /* n */
    double along[2];   /* c'(t) */
    double bend;       /* n . c''(t) */
    double multiplier; /* q */
    double gap, force;
    /* With friction: where on the curve it was at self_contact_settle, in arcs, and what it slid
     * along since then; the force on the node along c', its multiplier, and that force then. */
    double start, slip, shear, shear_multiplier, shear_before;
};

struct self_contact {
    const struct mesh *mesh; /* borrowed */
    double friction;         /* coefficient; 0 where created */
    size_t count;
    struct self_pair *pair; /* owned, as all below: by kind, and of each kind at most one a node, in
                             * their order */
    struct self_pair *old;  /* scratch of the search */
    struct tangent_link *link; /* of pairs with a force */
    size_t *bin, *next;        /* of the search: arcs by their position along x */
    double *turning;           /* angle of a segment over that of the first, twice around */
};

int self_contact_create(struct self_contact *out, const struct mesh *mesh, struct error *err);
void self_contact_clear(struct self_contact *self);
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

/* Slip counts from the present points on; and the work that friction has taken since then, by
 * trapezoids. */
void self_contact_settle(struct self_contact *self);
double self_contact_dissipation(const struct self_contact *self);

/* What a face does to itself. */
struct self_measure {
    size_t nodes;       /* that bear a force */
    double length;      /* of the face at these nodes, as it stands */
    double force;       /* sum */
    double penetration; /* of the deepest node in the smoothed face */
};
struct self_measure self_contact_measure(struct self_contact *self, const double *u,
                                         const bool *active);

#endif
