/* The equations of a step with friction, of profiles. Sliding nodes make the matrix unsymmetric. It
 * is factorised (LU, by UMFPACK), and that factorisation preconditions the equations of later
 * steps, which differ by what a few nodes do and by a little strain: generalised minimal residuals
 * (Saad & Schultz 1986) take some ten solves, each about a thirtieth of a factorisation. Where they
 * take more, the matrix is factorised anew. Its pattern does not depend on what nodes do, so that
 * it is analysed only once, but for a face that meets itself: its pairs change the pattern, which
 * is then analysed anew with each matrix.
 *
 * Unknowns and rows are those of face_conditions.h. Private to core/full. */
#ifndef RUGO_CORE_FULL_LINEAR_UNSYMMETRIC_H
#define RUGO_CORE_FULL_LINEAR_UNSYMMETRIC_H

#include "core/full/linear/face_conditions.h"
#include "core/full/tangent.h"

struct unsymmetric;

/* ERROR_INPUT for a surface, whose face has two directions, or more entries than an int counts;
 * ERROR_MEMORY. */
int unsymmetric_create(struct unsymmetric **out, const struct mesh *mesh, struct error *err);
void unsymmetric_destroy(struct unsymmetric **handle);
/* Bytes but for those of the factorisation itself, by UMFPACK. */
double unsymmetric_bytes(const struct mesh *mesh);

/* Takes the matrix. */
int unsymmetric_set(struct unsymmetric *lu, const struct tangent *tangent,
                    const struct face_conditions *conditions, struct error *err);
/* Forgets the factorisation, so that later results do not depend on what was solved before. */
void unsymmetric_forget(struct unsymmetric *lu);

struct unsymmetric_work {
    size_t iterations, factored;
};
/* Replaces x (mesh_degrees_of_freedom + 2 values) by the solution, to this residual over that of 0,
 * and adds to work. On entry x holds forces (at the first node of the far side the sum of the
 * vertical ones there), the mean displacement of the far side and the drive. At nodes in contact
 * the vertical value is the weighted displacement, and the other one is the displacement over the
 * flat where the node sticks, the force less friction times the vertical one in its direction where
 * it slides. ERROR_NUMERIC for a singular matrix, as of a flat that nothing holds. */
int unsymmetric_solve(struct unsymmetric *lu, double tolerance, double *x,
                      struct unsymmetric_work *work, struct error *err);

#endif
