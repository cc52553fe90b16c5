/* By what both Newton's methods of core/full (newton.c, friction/friction_newton.c) judge their
 * rounds: what rounding leaves, what counts as balanced, and when to give up. Private to
 * core/full. */
#ifndef RUGO_CORE_FULL_ROUNDS_H
#define RUGO_CORE_FULL_ROUNDS_H

#include "core/full/material.h"
#include "core/full/mesh.h"
#include <float.h>
#include <math.h>

/* Stiffness c that weights gaps and slips against forces in the choice of sets: E* over the mesh's
 * unit. */
static const double COMPLEMENTARITY = 1;
/* Contact forces may change the sets once the largest residual over the largest contact force is
 * below TRUSTED; while nodes change one at a time, below TRUSTED_ONE. */
static const double TRUSTED = 0.1, TRUSTED_ONE = 1e-4;
/* Residual at which iterations of the linear equations end, over Newton's. */
static const double LINEAR_PART = 0.1;
/* Gaps are sums of heights and displacements. Their rounding error is taken as ROUNDINGS units in
 * the last digit of the highest height. A load is refused when forces by strains of that size
 * exceed ROUNDING_MOST times the load. */
static const double ROUNDINGS = 8, ROUNDING_MOST = 0.01;
/* HALVINGS: of a step that folds the face or inverts an element. PATIENCE: rounds with the same
 * sets that do not improve on the best one. RETURNS: sets met before, after which Newton's method
 * gives up. */
enum { HALVINGS = 8, PATIENCE = 10, RETURNS = 3 };

/* Returns the rounding error of gaps, from the largest of the lengths that they are sums of. */
static inline double rounds_gap(double length) {
    return ROUNDINGS * DBL_EPSILON * length;
}
/* Returns that of forces on nodes, which strains of that size cause. */
static inline double rounds_force(double gap, const struct material *material, double area) {
    return gap * (2 * material->shear + material->local + material->mean) * area;
}

static inline double rounds_largest_force(const struct mesh *mesh, const double *force) {
    double most = 0;
    for (size_t node = 0; node < mesh->face; node++)
        most = fmax(most, fabs(force[mesh_vertical(mesh, node)]));
    return most;
}

/* Returns whether forces may change the sets, one node at a time when careful. */
static inline bool rounds_trust(double residual, double largest, bool careful) {
    return residual <= (careful ? TRUSTED_ONE : TRUSTED) * largest;
}

/* The best round since the sets changed. */
struct round_progress {
    double least;  /* smallest residual, in the units of the tolerance */
    size_t rounds; /* rounds since then */
    size_t begun;  /* iterations before contact of the face with itself was last found */
};
/* Takes a round. Returns whether the iteration has gone on for too long without a better one. */
static inline bool round_progress_ends(struct round_progress *progress, double off, bool changed,
                                       size_t iterations, size_t most) {
    bool better = changed || off < progress->least;
    progress->least = better ? off : progress->least;
    progress->rounds = better ? 0 : progress->rounds + 1;
    return iterations - progress->begun == most || progress->rounds > PATIENCE;
}

#endif
