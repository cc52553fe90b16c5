/* Forces on the nodes in contact that keep a flat block's face in place there: the linear contact
 * problem of a given set of nodes, by conjugate gradients on the face alone (as the tangent in
 * core/contact/conjugate_gradient.c). Private to core/full. */
#ifndef RUGO_CORE_FULL_FACE_SOLVER_H
#define RUGO_CORE_FULL_FACE_SOLVER_H

#include "core/full/preconditioner.h"
#include "core/surface/transform.h"

struct face_solver {
    struct transform *transform; /* owned, as all below */
    size_t face;
    double *weight;          /* by wave: of the gap's weighting; NULL: 1 */
    double *soft, *stiff;    /* by wave: weighted compliance, and its inverse */
    double *r, *old, *t, *w; /* face: scratch */
};

int face_solver_create(struct face_solver *out, const struct mesh *mesh,
                       const struct preconditioner *preconditioner, enum gap_weighting weighting,
                       struct error *err);
void face_solver_clear(struct face_solver *solver);

/* The weighted values of the face's nodes; in and out may be the same. */
void face_solver_weigh(const struct face_solver *solver, const double *in, double *out);
/* Forces on the active nodes, of the sum given, 0 elsewhere, that together with a shift of the
 * whole block move the weighted face, which is at `face`, to `target` where active: to a part
 * `tolerance` of what there was to move. Returns the shift. */
double face_solver_solve(struct face_solver *solver, const bool *active, const double *face,
                         const double *target, double sum, double tolerance, double *forces);

#endif
