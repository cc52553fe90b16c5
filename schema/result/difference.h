/* One case less another one of its study: curves and scalars, with the errors of their difference.
 *
 * Cases of the same random numbers (study.h) are compared realisation by realisation: the mean
 * difference of pairs has a much smaller statistical error than the means. Other errors are
 * combined: the value of a source is the difference of the two values, its bound the sum of the two
 * bounds. The bound of the mesh is smaller where levels change alike in both cases
 * (difference.c). */
#ifndef RUGO_SCHEMA_RESULT_DIFFERENCE_H
#define RUGO_SCHEMA_RESULT_DIFFERENCE_H

#include "schema/result/result.h"

/* The mean difference over pairs of realisations. */
struct paired_value {
    double value, standard_error; /* NaN: none */
    double deviation;             /* standard deviation of the difference of a pair */
    uint64_t pairs, lacking;      /* realisations of both cases: with both values, or without */
    double effective; /* realisations, where the error is of groups of them: groups; else 0 */
};
/* Functions that compute differences pair by pair. They return false for what is not kept by
 * realisation. */
struct difference_pairs {
    void *context;
    /* Of point `a` of the minuend's curve and point b of the subtrahend's. */
    bool (*point)(void *context, const struct curve *minuend, size_t a,
                  const struct curve *subtrahend, size_t b, struct paired_value *out);
    bool (*scalar)(void *context, const char *name, struct paired_value *out);
};

/* Fills an empty result with the differences of the finest levels of each curve, at the points x
 * that both have. A case with one model alone is compared with whichever model the other has.
 * pairs: NULL where realisations of the two are no pairs. Curves that cannot be compared are named
 * in the remark. On failure the result is cleared. */
int difference_make(const struct case_result *minuend, const struct case_result *subtrahend,
                    const struct difference_pairs *pairs, struct case_result *out,
                    struct error *err);

#endif
