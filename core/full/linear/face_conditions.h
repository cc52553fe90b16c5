/* What the nodes of a face do under friction, and how the flat is driven along it: what the linear
 * equations of a step hold to. Private to core/full.
 *
 * Behind the displacements (and pressures) these equations have two unknowns for each direction of
 * the face: first the shears, the forces along the face on all nodes of the far side, in equal
 * parts; then the flat, its displacements. Behind the forces there are as many rows: the mean
 * displacements of the far side along the face, and the drives. */
#ifndef RUGO_CORE_FULL_LINEAR_FACE_CONDITIONS_H
#define RUGO_CORE_FULL_LINEAR_FACE_CONDITIONS_H

#include "core/contact/block.h"
#include <stdbool.h>

/* What a node of the face does. Forces are those on the block; forward is along the first axis. */
enum face_node {
    NODE_FREE,
    NODE_STICKS,
    NODE_FORWARD, /* the flat slides over it and pulls it forward */
    NODE_BACKWARD
};
static inline bool face_node_slides(enum face_node does) {
    return does == NODE_FORWARD || does == NODE_BACKWARD;
}

/* flat * (displacement of the flat) + shear * (shear) is given. */
struct drive {
    double flat, shear;
};

/* Directions of a face: 1 of profiles, 2 of surfaces. */
enum { SIDEWAYS_MOST = 2 };

/* Arrays are borrowed. A sliding node's traction q, pressure p and slip w change by
 *
 *   dq - turn N (dq - stiffness dw) - friction dp e,  N = 1 - e e^T
 *
 * where e is its direction: the linear part of q - friction p (q - stiffness w)/|q - stiffness w|.
 * Of profiles N is 0. */
struct face_conditions {
    const unsigned char *node; /* by node of the face: enum face_node */
    const double *direction;   /* [node * directions + axis]: of the tractions of sliding nodes */
    const double *turn;        /* by node, of sliding ones: 0 to 1 */
    double friction, stiffness;
    enum gap_weighting weighting;
    struct drive drive[SIDEWAYS_MOST];
};

#endif
