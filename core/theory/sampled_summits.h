/* Summits of Gaussian surfaces on a grid (FORMULAS.md, F8.4). Nayak's theory is for surfaces
 * without a grid; this is for the points that are above their 8, 4 or (profiles) 2 neighbours, for
 * any spectrum, isotropic or not.
 *
 * The expectations are integrals over the Gaussian vector of a point and its neighbours, by lattice
 * rules. The error of the density is estimated; those of the other results are similar. Surfaces of
 * random amplitudes are exactly Gaussian; those of fixed ones differ by about one over the number
 * of modes.
 *
 * A surface that is translated from a Gaussian field has its summits, mapped (F6.12). Its curvature
 * by differences is not that of the field times f', as differences see f'' too: it has an
 * expectation of its own. There is none here of its exact curvature, nor of densities of
 * curvatures. */
#ifndef RUGO_CORE_THEORY_SAMPLED_SUMMITS_H
#define RUGO_CORE_THEORY_SAMPLED_SUMMITS_H

#include "core/statistics/heights/histogram.h"
#include "core/statistics/summits/summits.h"
#include "core/surface/spectrum.h"
#include "core/theory/translated_summits.h"

struct sampled_surface {
    const struct modes *modes;     /* borrowed */
    const struct moments *moments; /* of modes, borrowed: they set the units */
    enum summit_stencil stencil;   /* not SUMMITS_REFINED */
    enum summit_curvature curvature;
    /* Of a translated surface, whose field has these modes and moments; borrowed. NULL: none. */
    const struct translated_surface *translated;
};

struct sampled_summits {
    double density;       /* per area (length) */
    double density_error; /* standard error of the integral, as a share of the density */
    double height_mean, height_variance, height_skewness, height_kurtosis; /* of z* */
    double curvature; /* mean of kappa_m/sqrt(m4); profiles -z''/sqrt(m4). NaN: none */
};

/* Averages over bins as in bin_averages.h, NaN where there is hardly any summit; NULL: not wanted.
 * pdf and cdf come together, and curvature with them alone. The joint density is
 * joint[height bin * t1->count + t1 bin]. It and t1_pdf are not written for a translated surface.
 * The caller owns the arrays. */
struct sampled_bins {
    const struct bins *height, *t1;
    double *pdf, *cdf, *curvature; /* of summits by height */
    double *t1_pdf;
    double *joint;
};

/* ERROR_INPUT for refined summits, which the theory without a grid describes; ERROR_MEMORY. Nothing
 * is written on failure. bins may be NULL. */
int sampled_summits(const struct sampled_surface *surface, struct sampled_summits *out,
                    const struct sampled_bins *bins, struct error *err);

#endif
