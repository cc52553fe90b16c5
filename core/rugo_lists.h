/* The choices that librugo and the program share. Each list is ENTRY(TYPE, "name", value): rugo.h
 * makes RUGO_TYPE = value of it, core its own enumeration, and studies take the name. An entry is
 * added with the next free value, and no value ever changes: programs are compiled with them. */
#ifndef RUGO_LISTS_H
#define RUGO_LISTS_H

/* Spectra: power |k|^(-2 hurst - 2) (profile - 1), flat beyond the roll-off; autocorrelation
 * exp(-sqrt((x/bx)^2 + (y/by)^2)); a given density. */
#define RUGO_SPECTRA(ENTRY)                                                                        \
    ENTRY(SELF_AFFINE, "self_affine", 0)                                                           \
    ENTRY(EXPONENTIAL_ACF, "exponential_acf", 1)                                                   \
    ENTRY(TABLE, "table", 2)

/* Distributions of heights: normal; F(z) = 1 - exp(-z^shape), z > 0, and its mirror image; log z
 * normal with the standard deviation `shape`; density z^(shape - 1) exp(-z), z > 0; density
 * z^(shape - 1) (1 - z)^(second shape - 1), 0 < z < 1. */
#define RUGO_DISTRIBUTIONS(ENTRY)                                                                  \
    ENTRY(GAUSSIAN, "gaussian", 0)                                                                 \
    ENTRY(WEIBULL_MIN, "weibull_min", 1)                                                           \
    ENTRY(WEIBULL_MAX, "weibull_max", 2)                                                           \
    ENTRY(LOGNORMAL, "lognormal", 4)                                                               \
    ENTRY(GAMMA, "gamma", 5)                                                                       \
    ENTRY(BETA, "beta", 6)
/* Beside them: any distribution that is not constant and has a finite fourth moment, by its
 * quantiles. */
#define RUGO_QUANTILE_VALUE 3

/* What a summit is: above its 8 neighbours, above its 4 neighbours, or a true maximum of the
 * band-limited surface, between the points. */
#define RUGO_SUMMIT_RULES(ENTRY)                                                                   \
    ENTRY(NINE_POINT, "nine_point", 0)                                                             \
    ENTRY(FIVE_POINT, "five_point", 1)                                                             \
    ENTRY(REFINED, "refined", 2)

/* Trends: polynomials of order 0, 1 and 2. */
#define RUGO_TRENDS(ENTRY)                                                                         \
    ENTRY(MEAN, "mean", 0)                                                                         \
    ENTRY(PLANE, "plane", 1)                                                                       \
    ENTRY(QUADRATIC, "quadratic", 2)

/* Models of contact. Linear ones differ in the compliance of their block: roughness as a gap on a
 * half-space or an exact layer; linear finite elements on a flat block. Last: finite elements on
 * the rough geometry, finite strain (Hencky). */
#define RUGO_LINEAR_MODELS(ENTRY)                                                                  \
    ENTRY(HALFSPACE, "halfspace", 0)                                                               \
    ENTRY(LAYERED, "layered", 1)
#define RUGO_MODELS(ENTRY)                                                                         \
    RUGO_LINEAR_MODELS(ENTRY)                                                                      \
    ENTRY(FULL, "full", 2)

#endif
