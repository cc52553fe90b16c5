/* The contact forces that move given nodes of a flat block's face to given heights: the linear
 * contact problem of a known active set, solved by preconditioned conjugate gradients on the face
 * alone (as in core/contact/solver/conjugate_gradient.h). Private to core/full. */
#ifndef RUGO_CORE_FULL_LINEAR_FACE_SOLVER_H
#define RUGO_CORE_FULL_LINEAR_FACE_SOLVER_H

#include "core/full/linear/preconditioner.h"
#include "core/surface/transform.h"

struct face_solver {
    struct transform *transform; /* owned, as all below */
    size_t face;
    double *weight;               /* by wave: symbol of the gap weighting; NULL: 1 */
    double *compliance, *inverse; /* by wave: the weighted compliance, and its inverse */
    double *r, *old, *t, *w;      /* by node of the face: scratch */
};

int face_solver_create(struct face_solver *out, const struct mesh *mesh,
                       const struct preconditioner *preconditioner, enum gap_weighting weighting,
                       struct error *err);
/* Takes the compliance of the preconditioner anew, after it has changed. */
void face_solver_renew(struct face_solver *solver, const struct mesh *mesh,
                       const struct preconditioner *preconditioner);
void face_solver_clear(struct face_solver *solver);

/* Applies the gap weighting (F10.5) to values at the face's nodes; in and out may be the same. */
void face_solver_weigh(const struct face_solver *solver, const double *in, double *out);
/* Computes forces on the active nodes (0 elsewhere) with the given sum. Together with a shift of
 * the whole block, which is returned, they move the weighted face from `face` to `target` at the
 * active nodes, to within `tolerance` of the distance they had to move. */
double face_solver_solve(struct face_solver *solver, const bool *active, const double *face,
                         const double *target, double sum, double tolerance, double *forces);

#endif
