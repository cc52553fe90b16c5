/* The integrand of sampled_summits.h: over the Gaussian vector of a point and its neighbours
 * (sampled_field.h), those that make the point a summit.
 *
 * The even vector is taken in other coordinates: the curvature by differences, which leads and is
 * positive at a summit, then s along x, which it bounds (s along y is the rest of the curvature),
 * then s along the diagonals. */
#ifndef RUGO_CORE_THEORY_SUMMIT_INTEGRAND_H
#define RUGO_CORE_THEORY_SUMMIT_INTEGRAND_H

#include "core/statistics/summits.h"
#include "core/theory/sampled_field.h"

/* A lower triangle such that root root' is a covariance. A pivot that the pivots before it explain
 * to rounding is 0: such a variable is known once they are. */
struct triangle {
    size_t n;
    double root[PAIRS_MOST][PAIRS_MOST];
};
/* A Gaussian variable by the unit normals of a triangle; what they do not tell is normal. */
struct regression {
    double slope[PAIRS_MOST];
    double variance; /* of the rest */
};

static inline double regression_value(const struct regression *regression, const double *y) {
    double sum = 0;
    for (size_t a = 0; a < PAIRS_MOST; a++)
        sum += regression->slope[a] * y[a];
    return sum;
}

/* All that the integrand needs. */
struct summit_integrand {
    size_t pairs;
    double bend[2];
    struct triangle even, odd;
    struct regression height, curvature; /* of z* and of kappa_m/sqrt(m4) */
    double common;                       /* covariance of what is left of height and curvature */
};

void summit_integrand_prepare(struct sampled_field *field, enum summit_curvature curvature,
                              struct summit_integrand *out);

/* The curvature by differences goes from 0 to this many of its deviations: beyond, exp(-36) of the
 * density is left. */
#define LEAD_MOST 8.5
enum { UNIFORMS = 2 * PAIRS_MOST - 2 }; /* dimensions beside that of the curvature */

/* Fills the unit normals y[PAIRS_MOST] of the even vector of a point, whose curvature by
 * differences is lead of its deviations, and returns its weight: the mean of weights over lead,
 * evenly from 0 to LEAD_MOST, and over u, evenly in the unit cube, is the share of points that are
 * summits. u[UNIFORMS] lies inside of (0, 1). */
double summit_integrand_weigh(const struct summit_integrand *f, double lead, const double *u,
                              double *y);

#endif
