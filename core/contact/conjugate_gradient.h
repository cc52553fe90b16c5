/* Solves the quadratic programme of contact (F9.2), to find the pressures p >= 0 of a given mean
 * whose energy p.Sp/2 - p.z is least, and the tangent of that solution by the load. Private to
 * core/contact.
 *
 * The caller scales heights and pressures to be near 1. */
#ifndef RUGO_CORE_CONTACT_CONJUGATE_GRADIENT_H
#define RUGO_CORE_CONTACT_CONJUGATE_GRADIENT_H

#include "core/contact/compliance.h"
#include "core/surface/transform.h"

enum { CONJUGATE_GRADIENT_LANES = 8 }; /* independent partial sums, so that reductions vectorise */

/* Arrays of the grid have `padded` entries, a multiple of the lanes: those from n on stand for
 * nodes that never touch, with z far below and all else 0. */
struct conjugate_gradient {
    struct transform *transform; /* owned, as all below */
    struct transform *wide;      /* of the padded grid where the compliance is open; else NULL */
    struct grid grid;
    size_t n, padded;
    double largest; /* largest compliance, the unit of soft and stiff; in the grid's length */
    double *soft,
        *stiff;    /* by wave: weighted compliance over largest, and its inverse; 0 for the mean.
                      Where open, soft is that of the padded grid, and stiff is the inverse of the
                      periodic half-space's: a preconditioner, no exact inverse */
    double *z;     /* heights of mean 0, filled by the caller */
    double *p, *u; /* pressures, and the displacements that they make */
    double *q;     /* tangent dp/d(mean p): of mean 1, 0 outside of the contact */
    double *r, *old, *t, *w;    /* scratch */
    double *kept_p, *kept_u;    /* before a step that may be shortened */
    double transforms;          /* Fourier transforms made so far, forward and inverse */
    int (*stop)(void *context); /* called every few iterations, non-zero stops; may be NULL */
    void *stop_context;
};

int conjugate_gradient_create(struct conjugate_gradient *out, const struct compliance *compliance,
                              struct error *err);
void conjugate_gradient_clear(struct conjugate_gradient *solver);
double conjugate_gradient_bytes(const struct grid *grid);

struct conjugate_gradient_end {
    bool converged, stopped;
    size_t iterations;
    double approach;    /* D: the gap is D + u - z */
    double inside;      /* largest |gap| under pressure */
    double penetration; /* largest -gap elsewhere */
    double deepest;     /* largest |u|, to which the tolerance refers */
};

/* Iterates from the p given (of mean `mean` > 0) until no violation is larger than tolerance *
 * deepest or than rounding errors. When stall_iterations have not halved the violation, careful
 * steps follow: each lowers the energy, so that they reach the solution from any start, though
 * slowly. p keeps its mean whether the iteration converged or not. */
void conjugate_gradient_run(struct conjugate_gradient *solver, double mean, double tolerance,
                            size_t stall_iterations, size_t max_iterations,
                            struct conjugate_gradient_end *end);
/* Solves for q in the set p > 0, starting from the q given, and returns -d(approach)/d(mean p) > 0,
 * which is minus the derivative of the mean gap. The value is an energy, whose error is the square
 * of that of q. */
double conjugate_gradient_tangent(struct conjugate_gradient *solver);

#endif
