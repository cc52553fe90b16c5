/* The quadratic programme of contact: the pressures p >= 0 of a given mean whose energy
 * p.Sp/2 - p.z is least, and the tangent of that solution over the load. Private to core/contact.
 *
 * Heights and pressures should be near 1: the caller scales. */
#ifndef RUGO_CORE_CONTACT_CONJUGATE_GRADIENT_H
#define RUGO_CORE_CONTACT_CONJUGATE_GRADIENT_H

#include "core/contact/compliance.h"
#include "core/surface/transform.h"

/* Arrays of the grid are `padded` long: entries from n on stand for nodes that never touch, z far
 * below and all else 0. */
struct conjugate_gradient {
    struct transform *transform; /* owned, as all below */
    size_t n, padded;
    double largest;          /* compliance: unit of the symbols, the grid's length */
    double *soft, *stiff;    /* weighted compliance over largest, a value a wave, and its inverse; 0
                                for the mean */
    double *z;               /* heights, mean 0: the caller's to fill */
    double *p, *u;           /* pressures, and their displacements */
    double *q;               /* tangent dp/d(mean p): mean 1, 0 outside of the contact */
    double *r, *old, *t, *w; /* scratch */
    double transforms;       /* made so far, both ways */
};

int conjugate_gradient_create(struct conjugate_gradient *out, const struct compliance *compliance,
                              struct error *err);
void conjugate_gradient_clear(struct conjugate_gradient *solver);
double conjugate_gradient_bytes(const struct grid *grid);

struct conjugate_gradient_end {
    bool converged;
    size_t iterations;
    double approach;    /* D: the gap is D + u - z */
    double inside;      /* largest |gap| under pressure */
    double penetration; /* largest -gap elsewhere */
    double deepest;     /* largest |u|, to which the tolerance refers */
};

/* From the p given (mean p = mean > 0), until no violation is larger than tolerance * deepest (or
 * than rounding allows). After stall_iterations that did not halve the violation steps become
 * careful: each lowers the energy, and they end at the solution from anywhere, if slowly. p has the
 * mean whether converged or not. */
void conjugate_gradient_run(struct conjugate_gradient *solver, double mean, double tolerance,
                            size_t stall_iterations, size_t max_iterations,
                            struct conjugate_gradient_end *end);
/* From the q given: solves for q in the set p > 0, and returns -d(approach)/d(mean p) > 0: minus
 * the slope of the mean gap. It is an energy, so that its error is the square of q's. */
double conjugate_gradient_tangent(struct conjugate_gradient *solver);

#endif
