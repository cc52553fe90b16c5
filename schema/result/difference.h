/* One case less another one of its study: curves and scalars, with the errors of their difference.
 *
 * Cases of the same random numbers (study.h) go together, realisation by realisation, so that the
 * mean difference over pairs is known far better than the cases. Other errors are combined: the
 * value of a source is the difference of the two values, its bound the sum of the two bounds; that
 * of the mesh is less where the changes between levels go together (difference_mesh.h). */
#ifndef RUGO_SCHEMA_RESULT_DIFFERENCE_H
#define RUGO_SCHEMA_RESULT_DIFFERENCE_H

#include "schema/result/result.h"

/* Pairs of realisations tell this. */
struct paired_value {
    double value, standard_error; /* NaN: none */
    double deviation;             /* of the difference of a pair */
    uint64_t pairs, lacking;      /* realisations of both cases: with both values, or without */
};
/* How differences are found pair by pair. These return false for what is not kept by realisation.
 */
struct difference_pairs {
    void *context;
    /* Of point `a` of the minuend's curve and point b of the subtrahend's. */
    bool (*point)(void *context, const struct curve *minuend, size_t a,
                  const struct curve *subtrahend, size_t b, struct paired_value *out);
    bool (*scalar)(void *context, const char *name, struct paired_value *out);
};

/* Fills an empty result: of each curve the finest level, at the places x that both have. Where a
 * case has one model alone, it is compared with whichever the other has. pairs: NULL where
 * realisations of the two are no pairs. Curves that cannot be compared are named in the remark. On
 * failure it is cleared. */
int difference_make(const struct case_result *minuend, const struct case_result *subtrahend,
                    const struct difference_pairs *pairs, struct case_result *out,
                    struct error *err);

#endif
