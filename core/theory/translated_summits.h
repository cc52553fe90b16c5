/* Summits of surfaces that are translated from a Gaussian field, z = f(g) (FORMULAS.md, F6.12).
 *
 * f rises, so that summits of z are those of g: their density is Nayak's (of peaks of profiles,
 * that of Rice 1945) with the moments of g, and f maps their heights and curvatures. Heights are
 * z* = z/sqrt(m0), and t1 is that of nayak.h with the m4 of z. Integrals are over values of g, in
 * which everything is smooth where f is. Results are NaN for a field out of the domain of nayak.h.
 */
#ifndef RUGO_CORE_THEORY_TRANSLATED_SUMMITS_H
#define RUGO_CORE_THEORY_TRANSLATED_SUMMITS_H

#include "core/statistics/heights/histogram.h"
#include "core/surface/moments.h"
#include "core/theory/nayak.h"
#include "core/theory/translated_heights.h"

struct translated_surface {
    int dimension; /* 1 profile, 2 surface */
    struct translated_heights heights;
    struct moments gaussian; /* of g, which has unit variance */
    struct moments reached;  /* of z */
};

/* Returns the curvature of z in sqrt(m4) of z over f' times that of g in sqrt(m4) of g. */
double translated_stretch(const struct translated_surface *surface);
struct summit_expectation translated_summits_expectation(const struct translated_surface *surface);

/* For sums over the summits of a surface, by values of g: */
/* Returns where the panel of quadrature ends that begins at a value of g, at most at `high`: as far
 * on as densities are smooth, which bend near 0 where alpha is near its bound. */
double translated_panel_end(const struct translated_surface *surface, double at, double high);
/* Given the height of g, its s = -t1 has the density of a normal variable times a power of s. It is
 * negligible outside of these bounds. */
struct curvature_range {
    double low, high;
};
struct curvature_range translated_curvatures_at(const struct translated_surface *surface,
                                                double score);

/* Averages over bins as in bin_averages.h. Heights that the law does not have have no mean
 * curvature (NaN). */
void translated_summits_heights(const struct translated_surface *surface, const struct bins *bins,
                                double *pdf, double *cdf, double *curvature);
void translated_summits_curvatures(const struct translated_surface *surface,
                                   const struct bins *bins, double *pdf);
void translated_summits_joint(const struct translated_surface *surface, const struct bins *height,
                              const struct bins *t1, double *pdf);

#endif
