/* Equilibrium of a meshed block on a rigid flat with Coulomb's friction, after one increment of
 * the load and of the flat's displacement along the face (F14.7). Pressures, tractions and the sets
 * of free, sticking and sliding nodes are solved together by one Newton's method (Hueber, Stadler
 * & Wohlmuth 2008; Gitterle, Popp, Gee & Wall 2010). Private to core/full/friction.
 *
 * Multipliers have dual functions, one vector a node: the force on the node over its tributary
 * area. So they are the inner forces at the face, and are not unknowns. With pressure p, gap g,
 * traction q of the flat on the block and slip w of the face over the flat in this increment, and
 * any c > 0, nodes meet
 *
 *   p - max(0, p - c g) = 0,  q - P(q - c w) = 0,  P: to within friction * max(0, p - c g) of 0
 *
 * where q and w have one component in profiles, two on surfaces. A sliding node's direction is that
 * of q - c w; it follows each iteration as long as it turns by less than a right angle.
 *
 * Slip is the change of the node's displacement along the flat, less that of the flat: a motion of
 * both alike is none, whatever the strain. Of GAP_STANDARD the gap is a mean over neighbours, but
 * the slip is of the node alone, so that its work on the traction is that of the forces.
 *
 * The far side bears the load and the shear evenly; its mean displacement along the face is 0. The
 * flat is driven along one axis. Across it nothing holds the flat: the shear there is 0.
 *
 * Equations of profiles are solved by a sparse factorisation (unsymmetric.h), those of surfaces by
 * iterations with the flat block (gmres.h).
 * Lengths are in the mesh's unit, pressures in E*. */
#ifndef RUGO_CORE_FULL_FRICTION_FRICTION_NEWTON_H
#define RUGO_CORE_FULL_FRICTION_FRICTION_NEWTON_H

#include "core/full/linear/unsymmetric.h"
#include "core/full/newton.h"

struct friction_newton {
    const struct mesh *mesh; /* borrowed */
    struct material material;
    struct face_conditions conditions; /* what nodes do is owned, as all below */
    unsigned char *node;               /* by node of the face: enum face_node */
    bool *touches;                     /* scratch of friction_newton_touching */
    double *direction, *turn;          /* of sliding nodes (face_conditions.h) */
    struct tangent *tangent;
    struct unsymmetric *lu; /* of profiles */
    struct gmres *gmres;    /* borrowed, of surfaces */
    double *u;     /* unknowns: displacements, then pressures of elements where they are unknowns
                      (gmres.h); whoever changes them sets evaluated to false */
    double *force; /* unknowns: inner forces, and the excess of the pressures */
    double *before, *change; /* unknowns: scratch */
    double *step;            /* unknowns of the linear equations: scratch */
    double *reference;       /* [node * directions + axis]: displacement over the flat, along the
                                face, at the beginning of the increment */
    double *gap, *opening;   /* by node of the face, at u */
    double shear[SIDEWAYS_MOST], flat[SIDEWAYS_MOST]; /* force along the face on the block, and the
                                                         flat's displacement */
    bool overhangs;                                   /* as in newton.h, and the next three */
    struct self_contact self;
    double drag, *anchor;
    double energy; /* of the block at u, E* times the cube (profiles: square) of the mesh's unit */
    double flat_height;      /* vertical position of the flat */
    double tolerance;        /* largest residual, over the largest contact force */
    struct full_limit limit; /* of the next solution */
    size_t unknowns, max_iterations;
    size_t sideways;            /* directions of the face: 1 of profiles, 2 of surfaces */
    size_t axis;                /* along which the flat is driven: 0, or of surfaces 1 */
    bool evaluated;             /* force, tangent and energy belong to u */
    int (*stop)(void *context); /* called before each iteration, also of linear
                                   equations by gmres.h; non-zero stops; may be NULL */
    void *context;
};

/* gmres: that of the mesh and material without friction, for surfaces. ERROR_INPUT for a profile
 * with too many nodes; ERROR_MEMORY. */
int friction_newton_create(struct friction_newton *out, const struct mesh *mesh,
                           const struct material *material, enum gap_weighting weighting,
                           double friction, struct gmres *gmres, struct error *err);
void friction_newton_clear(struct friction_newton *newton);
/* As newton_allow_overhangs; the face meets itself with the same friction. ERROR_MEMORY alone. */
int friction_newton_allow_overhangs(struct friction_newton *newton, struct error *err);

/* Computes forces, energy and tangent at u, with the pairs of a face that meets itself as they are.
 * Returns false where an element is turned inside out. */
bool friction_newton_evaluate(struct friction_newton *newton);

/* By node of the face, whether it touches the flat; valid until the next call. */
const bool *friction_newton_touching(struct friction_newton *newton);

/* The loads at the end of the increment. */
struct friction_goal {
    double pressure; /* mean, above 0 */
    double drive;    /* value of conditions.drive along the axis */
};
/* The course of a solution; as newton_end. */
struct friction_end {
    size_t iterations, cycles;
    struct unsymmetric_work work;
    double residual; /* largest out-of-balance force, over the largest contact force */
    double inside;   /* largest |weighted gap| in contact, and |slip| of sticking nodes */
};
/* Solves for u, shear, flat and the nodes, starting from those given. After ERROR_NUMERIC, and
 * ERROR_STOPPED when stop returned non-zero, these are undefined. */
int friction_newton_solve(struct friction_newton *newton, const struct friction_goal *goal,
                          struct friction_end *end, struct error *err);
/* Computes gap and opening from u. */
void friction_newton_measure_gaps(struct friction_newton *newton);
/* Returns a node's slip along an axis since the beginning of the increment. */
double friction_newton_slip(const struct friction_newton *newton, size_t node, size_t axis);
/* Drives the flat along its axis by this. */
void friction_newton_drive(struct friction_newton *newton, struct drive drive);

#endif
