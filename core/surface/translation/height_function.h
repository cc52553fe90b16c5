/* The height function of a translation field: z = f(g) of unit deviation from a Gaussian field g of
 * unit variance, f = F^-1(Phi(.)) for the height distribution F (FORMULAS.md, F5.8 and F5.9).
 * Immutable once made; many threads may read one. */
#ifndef RUGO_CORE_SURFACE_TRANSLATION_HEIGHT_FUNCTION_H
#define RUGO_CORE_SURFACE_TRANSLATION_HEIGHT_FUNCTION_H

#include "core/surface/heights.h"

struct height_function;

/* Hermite's series f = sum of c_n He_n/sqrt(n!), n = 1, 2, ...; the sum of c_n^2 is 1. */
enum { HERMITE_TERMS = 80 };
struct hermite_powers {
    double of[HERMITE_TERMS + 1]; /* c_n^2 by n; of[0] = 0. The last one stands for all behind it */
    double slope;                 /* mean of f'^2: m2 of z over that of g */
    double curvature;             /* mean of f''^2 */
};

/* Copies what it needs of the heights. ERROR_INPUT for heights out of range, and for those that a
 * function cannot have: equal heights (f' = 0), on which there are no summits. ERROR_MEMORY. */
int height_function_create(struct height_function **out, const struct heights *heights,
                           struct error *err);
void height_function_destroy(struct height_function **function);

const struct hermite_powers *height_function_powers(const struct height_function *function);
/* Returns the correlation of z where g has this one, in [-1, 1]. */
double hermite_correlation(const struct hermite_powers *powers, double gaussian);
/* Replaces n correlations of g by what the terms behind the first one add to those of z. */
void hermite_correlations_beyond(const struct hermite_powers *powers, size_t n, double *values);
/* Returns the correlation of g where z has this one, in [0, 1]: the inverse of the above. */
double hermite_gaussian_correlation(const struct hermite_powers *powers, double correlation);

/* f, its first derivative, and its inverse, for any finite argument. The inverse of heights beyond
 * the bounds of the distribution is that of the bounds. Errors are below 1e-10 of a deviation. */
struct height_slope {
    double height, slope; /* f(g), f'(g) */
};
struct height_slope height_function_at(const struct height_function *function, double gaussian);
/* Returns the second derivative, with an error below 1e-4 where heights are smooth. */
double height_function_bend(const struct height_function *function, double gaussian);
double height_function_inverse(const struct height_function *function, double height);
/* Replaces n values of g by factor f(g). */
void height_function_apply(const struct height_function *function, double factor, size_t n,
                           double *z);
/* Replaces n values of factor f(g) by g. */
void height_function_undo(const struct height_function *function, double factor, size_t n,
                          double *z);

#endif
