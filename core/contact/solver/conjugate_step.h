/* Parts of a step of conjugate gradients for the quadratic programme of contact (F9.2): the arrays,
 * products with compliance and preconditioner, and directions within a set of nodes. Private to
 * core/contact.
 *
 * The caller scales heights and pressures to be near 1. */
#ifndef RUGO_CORE_CONTACT_SOLVER_CONJUGATE_STEP_H
#define RUGO_CORE_CONTACT_SOLVER_CONJUGATE_STEP_H

#include "core/contact/compliance.h"
#include "core/contact/solver/pass.h"
#include "core/contact/solver/pyramid.h"
#include "core/surface/transform.h"
#include <float.h>

enum { CONJUGATE_GRADIENT_LANES = 8 }; /* independent partial sums, so that reductions vectorise */

/* Arrays of the grid have `padded` entries, a multiple of the lanes. Those from n on stand for
 * nodes that never touch: their z is far below and all else 0. */
struct conjugate_gradient {
    struct transform *transform; /* of `around`; owned, as all below */
    struct transform *wide;      /* of the padded grid where the compliance is open; else NULL */
    struct grid grid;
    struct grid around; /* what residuals are continued over: the grid itself, where open with a
                           margin, so that opposite sides do not meet */
    size_t n, padded;
    double largest;           /* largest compliance, the unit of the two below; the grid's length */
    const double *compliance; /* by wave: factor times this is the weighted compliance over largest;
                                 0 for the mean; where open, that of the padded grid */
    double factor;
    double local;    /* displacement of a node under a pressure of 1 on it alone */
    double *product; /* owns `compliance` where that is weighted; else NULL */
    double *inverse; /* inverse of the compliance over largest, 0 for the mean. Where open, that of
                        the half-space which repeats `around`: a preconditioner alone */
    double *z;       /* heights of mean 0, filled by the caller */
    double *p, *u;   /* pressures, and the displacements that they make */
    double hardness; /* largest pressure, held where it is reached; INFINITY: none */
    double *q;       /* tangent dp/d(mean p): of mean 1, 0 outside of the contact */
    double *r, *old, *t, *w; /* scratch */
    double *spare[2];        /* points of `around` each: scratch of preconditioning where open, and
                                of steps that may be shortened */
    struct pass_board board; /* of passes over the nodes */
    struct pyramid pyramid;  /* of surfaces, over `around` */
    double transforms;       /* Fourier transforms made so far, forward and inverse */
    int (*stop)(void *context); /* called every few iterations, non-zero stops; may be NULL */
    void *stop_context;
    bool stopped; /* a tangent was stopped; the caller clears it */
};

/* Borrows the compliance. */
int conjugate_gradient_create(struct conjugate_gradient *out, const struct compliance *compliance,
                              struct error *err);
/* Lets a team work along, with the same digits; borrowed until the next one. ERROR_MEMORY. */
int conjugate_gradient_set_team(struct conjugate_gradient *solver, struct team *team,
                                struct error *err);
void conjugate_gradient_clear(struct conjugate_gradient *solver);
/* Of a periodic grid, but for what only careful steps touch. */
double conjugate_gradient_bytes(const struct grid *grid, const struct block *block);

struct conjugate_gradient_end {
    bool converged, stopped;
    size_t iterations;
    double approach;    /* D: the gap is D + u - z */
    double inside;      /* largest |gap| under pressure */
    double penetration; /* largest -gap elsewhere */
    double lifted;      /* largest gap at the hardness */
    bool bounded;       /* the hardness has changed a step */
    double deepest;     /* largest |u|, to which the tolerance refers */
};

/* Rounding of the highest points can make violations as large as this, over the heights. */
#define CONJUGATE_ROUNDING (64 * DBL_EPSILON)
/* Steps between calls of stop, which may take as long as a step on a small grid. */
enum { CONJUGATE_ASK = 8 };

/* What a step of the iteration passes on to the next one. */
struct step_memory {
    /* Whether the residual is continued outside the set before it is multiplied by the inverse
     * compliance; the product is brought back by the transpose. With zeros there, long waves on a
     * sparse set look like short ones: on a profile the condition number grows with the number of
     * patches in contact (from 44 to 132 for 142 to 433 patches), and the steps on a surface with
     * its side. Profiles are continued by straight lines between patches (2, however long the
     * cell), surfaces by a pyramid (pyramid.h). This serves sets that are solved before nodes leave
     * or join: pressures that are cut at 0 after one such step make long waves overshoot. */
    bool continued;
    double energy; /* w.r of the last direction; 0 restarts */
    bool blocked;  /* a careful step ended where a pressure came to 0 */
};

/* Prepares continued steps in the set r != 0, which holds until the next call. */
void conjugate_step_take_set(struct conjugate_gradient *solver, const double *r);
/* Computes the next direction t in the set r != 0 of nodes, and w = S t. r is old from then on. */
void conjugate_step_direct(struct conjugate_gradient *solver, struct step_memory *memory);
/* Returns old.t/t.w, the multiple of t at which the energy is least. */
double conjugate_step_length(struct conjugate_gradient *solver);
/* out = S in. */
void conjugate_step_apply_compliance(struct conjugate_gradient *solver, const double *in,
                                     double *out);
/* Multiplies x, of all nodes, so that its mean, of the sum given, is `mean`. */
void conjugate_step_scale(struct conjugate_gradient *solver, double mean, double sum, double *x);
/* Returns the largest |z|. */
double conjugate_step_highest(const struct conjugate_gradient *solver);
double conjugate_lanes_sum(const double *lanes);
double conjugate_lanes_most(const double *lanes);

#endif
