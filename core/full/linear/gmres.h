/* The linear equations of one step of Newton's method, solved by generalised minimal residuals
 * (Saad & Schultz 1986; flexible, Saad 1993). The preconditioner is the flat block with the same
 * nodes: preconditioner.h inverts its stiffness wave by wave, and face_solver.h computes its
 * contact forces on the face. The number of iterations depends on how far the rough block differs
 * from the flat one: about four at RMS slopes of 0.1, whatever the number of nodes.
 *
 * Nearly incompressible blocks differ more: displacements that keep the volume of a flat element
 * change that of a rough one, and the bulk modulus multiplies the change. For them the pressure p
 * of each element is an unknown of its own, with the equation p - k v = 0 beside the forces. Here v
 * is the change of volume by the displacements and k the bulk modulus over the volume (Brezzi &
 * Fortin 1991). That equation is multiplied by the shear over the bulk modulus: an error of the
 * volume then counts as a shear strain does, while its pressure may be thousands of times as large.
 * The flat block has the same unknowns, and a bulk modulus of its own where that of the rough one
 * is large (gmres.c).
 *
 * Where this converges too slowly, as for steep blocks, a factorisation of the tangent in the
 * displacements alone (factorisation.h) replaces the flat block as the preconditioner. With the
 * dual weighting it is exact. */
#ifndef RUGO_CORE_FULL_LINEAR_GMRES_H
#define RUGO_CORE_FULL_LINEAR_GMRES_H

#include "core/full/linear/face_conditions.h"
#include "core/full/linear/face_solver.h"
#include "core/full/linear/factorisation.h"
#include "core/full/tangent.h"

struct gmres;
/* Iterations that a solution takes at most. */
enum { LINEAR_ITERATIONS_MOST = 240 };

int gmres_create(struct gmres **out, const struct mesh *mesh, const struct material *material,
                 enum gap_weighting weighting, struct error *err);
void gmres_destroy(struct gmres **handle);
/* Makes room for more directions before a restart, up to HESSENBERG_MOST and 250 MB
 * (linear_system.lengthy). */
int gmres_lengthen(struct gmres *gmres, struct error *err);
/* Prepares equations with friction. */
int gmres_add_friction(struct gmres *gmres, enum gap_weighting weighting, struct error *err);
/* Returns the values of x with friction, with those behind. */
size_t gmres_friction_unknowns(const struct gmres *gmres);

/* Returns the bytes that this many iterations of a linear step touch, or those of all directions
 * after gmres_lengthen. */
double gmres_bytes(const struct mesh *mesh, const struct material *material, double iterations,
                   bool lengthened);

/* Returns whether the pressures of elements must be unknowns of their own, so that the tangent
 * needs its volumetric part: the ratio of Poisson is above 0.45. */
bool gmres_needs_pressures(const struct material *material);

/* Applies the gap weighting (F10.5) to values at the face's nodes; in and out may be the same. */
void gmres_weigh(const struct gmres *gmres, const double *in, double *out);
/* The equations of one step; all fields are borrowed. */
struct linear_system {
    const struct tangent *tangent;
    const bool *active; /* by node of the face: whether it is in contact */
    struct factorisation
        *factorisation; /* of that tangent and active set; NULL: the flat block preconditions */
    const struct face_conditions
        *friction; /* in place of both, after gmres_add_friction; or NULL */
    bool pinned;   /* the first node of the far side does not move sideways, whatever its force */
    /* What the tangent has on its diagonal in all displacements, where it is not factorised: the
     * block does not drift then, and is left where it moves. */
    double drag;
    bool lengthy;               /* with all directions that there is room for before a restart */
    size_t most;                /* iterations, up to LINEAR_ITERATIONS_MOST; 0: these */
    int (*stop)(void *context); /* called before each iteration, non-zero stops; may be NULL */
    void *context;
};

/* Solves for x, which has tangent_unknowns values. On entry x holds forces (at the first node of
 * the far side the sum of the vertical ones there), on vertical degrees of freedom in contact the
 * prescribed change of the weighted gap, and the excess of the pressures, times volumetric->row. On
 * return it holds displacements and pressures. With friction, rows of nodes in contact are those of
 * sliding_face_solve, and x has gmres_friction_unknowns values. Ends when the residual is
 * `tolerance` times that of x = 0; ERROR_NUMERIC when it stays larger, ERROR_STOPPED when stop
 * returned non-zero. Adds to *iterations. */
int gmres_solve(struct gmres *gmres, const struct linear_system *system, double tolerance,
                double *x, size_t *iterations, struct error *err);

#endif
