/* Forces on the nodes in contact that keep a flat block's face in place there: the linear contact
 * problem of a given set of nodes, by conjugate gradients on the face alone (as the tangent in
 * core/contact/descent.c). Private to core/full. */
#ifndef RUGO_CORE_FULL_SUPPORT_H
#define RUGO_CORE_FULL_SUPPORT_H

#include "core/full/flat.h"
#include "core/surface/transform.h"

struct support {
    struct transform *transform; /* owned, as all below */
    size_t face;
    double *weight;          /* by wave: of the gap's weighting; NULL: 1 */
    double *soft, *stiff;    /* by wave: weighted compliance, and its inverse */
    double *r, *old, *t, *w; /* face: scratch */
};

int support_create(struct support *out, const struct mesh *mesh, const struct flat *flat,
                   enum gap_weighting weighting, struct error *err);
void support_clear(struct support *support);

/* The weighted values of the face's nodes; in and out may be the same. */
void support_weigh(const struct support *support, const double *in, double *out);
/* Forces on the active nodes, of the sum given, 0 elsewhere, that together with a shift of the
 * whole block move the weighted face, which is at `face`, to `target` where active: to a part
 * `tolerance` of what there was to move. Returns the shift. */
double support_solve(struct support *support, const bool *active, const double *face,
                     const double *target, double sum, double tolerance, double *forces);

#endif
