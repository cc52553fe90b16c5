/* The likelihood of a self-affine law, given the rings of a map, and its maximum. For
 * spectrum_fit.c and spectrum_scores.h. Wave numbers are in waves per shorter side here.
 *
 * Rings count as independent, each as a mean distributed as chi squared (Whittle's likelihood);
 * what neighbours share enters the errors (FORMULAS.md, F18.14). */
#ifndef RUGO_CORE_STATISTICS_SPECTRA_SPECTRUM_LAW_H
#define RUGO_CORE_STATISTICS_SPECTRA_SPECTRUM_LAW_H

#include "core/statistics/spectra/spectrum_leakage.h"

enum law_parameter {
    LAW_AMPLITUDE,
    LAW_HURST,
    LAW_ROLLOFF,
    LAW_SHORT,
    LAW_LONG,
    LAW_BLUR,
    LAW_NOISE,
    LAW_PARAMETERS,
    LAW_PLAIN = LAW_SHORT /* number of the first ones, of a density without ends and blur */
};

/* Logarithms of the density at the reference, as that of the falling part, and of wave numbers, but
 * for H; blur: logarithm of b, where an instrument has taken exp(-b k^2) of the density;
 * noise: of its density, which is white. */
struct law {
    double p[LAW_PARAMETERS];
    bool free[LAW_PARAMETERS]; /* whether it is fitted: else it stays */
    double deviance;
};

/* Rings first to last, and what their likelihood needs. */
struct law_problem {
    const struct map_spectrum *spectrum; /* borrowed */
    struct spectrum_leakage *leakage;    /* owned, as all arrays */
    double dimension;                    /* the density falls by k^-(dimension + 2 H) */
    double reference;                    /* of the amplitude */
    double reference_logarithm;
    /* Density that is added to what is found and to what is expected: so rings beyond a sharp end,
     * which hold leakage alone, do not count. */
    double floor;
    double low[LAW_PARAMETERS], high[LAW_PARAMETERS];
    size_t rings;               /* those of the leakage, and one more: of rings put together */
    double *found;              /* per ring */
    double *freedom;            /* per ring, as of the spectrum; 0 of one that does not count */
    double *share;              /* per ring: of its modes among those put together; 0: none */
    size_t counted;             /* rings that do */
    double *expected;           /* per ring */
    double *density;            /* per node */
    double *plain;              /* per node: without ends and blur, ... */
    double plain_of[LAW_PLAIN]; /* ... of these parameters */
    double *logarithm;          /* per node: of its wave number */
    double *trial;              /* per ring: of a step that is tried */
    double *slope;              /* LAW_PARAMETERS per ring: of the logarithm of what is expected */
};
int law_problem_create(struct law_problem **out, const struct map_spectrum *spectrum, size_t first,
                       size_t last, double floor, struct error *err);
void law_problem_destroy(struct law_problem **problem);
/* Lets rings low to high of the spectrum count by their mean alone, as those which an error blurs.
 * Once a problem. */
void law_problem_put_together(struct law_problem *problem, double low, double high);

/* Returns the density of a law by the logarithm of a wave number, without regard to its ends and to
 * the blur. */
double law_density(const struct law_problem *problem, const double *p, double logarithm);

/* Below so many waves a side a map has no density; a law is taken as constant there. */
#define LAW_FEWEST_WAVES 0.5
/* Fills the deviance of a law: twice by how much the likelihood is less than that of rings that are
 * as expected. */
void law_evaluate(struct law_problem *problem, struct law *law);
/* Moves the free parameters to the nearest maximum, within their bounds. */
void law_maximise(struct law_problem *problem, struct law *law);

typedef double law_matrix[LAW_PARAMETERS][LAW_PARAMETERS];
/* Fills the covariance of the free parameters at a maximum, others having none: by the curvature of
 * the likelihood, and with the correlations of rings. False where it is not known. */
bool law_covariance(struct law_problem *problem, const struct law *law, law_matrix likelihood,
                    law_matrix covariance);

/* Returns where, from a maximum in a direction (1 or -1) of one parameter, the least deviance over
 * the others has risen by so much; NaN where it does not within the bounds. */
double law_bound(struct law_problem *problem, const struct law *best, enum law_parameter parameter,
                 int direction, double rise, double step);

#endif
