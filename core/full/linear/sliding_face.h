/* The contact forces on a flat block's face of which some nodes stick and others slide: the
 * equations of face_conditions.h on the face alone, solved by minimal residuals (Saad & Schultz
 * 1986). For surfaces; as face_solver.h is without friction. Private to core/full.
 *
 * A vector has the components of all nodes, [component * face + node], the vertical one last, and
 * behind them the motions: the flat's displacements along the face, and the vertical shift of the
 * block. Components of free nodes are 0. */
#ifndef RUGO_CORE_FULL_LINEAR_SLIDING_FACE_H
#define RUGO_CORE_FULL_LINEAR_SLIDING_FACE_H

#include "core/full/linear/face_conditions.h"
#include "core/full/linear/preconditioner.h"

struct sliding_face;

int sliding_face_create(struct sliding_face **out, const struct mesh *mesh,
                        const struct preconditioner *preconditioner, enum gap_weighting weighting,
                        struct error *err);
/* Takes the matrices of the preconditioner anew, after it has changed. */
void sliding_face_renew(struct sliding_face *sliding, const struct mesh *mesh,
                        const struct preconditioner *preconditioner);
void sliding_face_destroy(struct sliding_face **handle);
/* Returns the number of values of a vector. */
size_t sliding_face_values(const struct sliding_face *sliding);

/* Solves for forces on the nodes in contact, and the motions. The given values are, of a node in
 * contact, the weighted vertical displacement; of one that sticks, its displacement over the flat;
 * of one that slides, what the changes of face_conditions.h are to be; then the drives, and the sum
 * of the vertical forces. Down to a residual of `tolerance` times that of 0, or as near as some
 * iterations come. */
void sliding_face_solve(struct sliding_face *sliding, const struct face_conditions *conditions,
                        const double *given, double tolerance, double *out);

#endif
