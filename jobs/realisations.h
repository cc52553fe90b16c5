/* The scalars of a case's realisations, kept in their order whatever the order of arrival. */
#ifndef RUGO_JOBS_REALISATIONS_H
#define RUGO_JOBS_REALISATIONS_H

#include "core/error.h"
#include "schema/result/block_result.h"

struct realisation_block {
    uint64_t first, count;
    double *scalars; /* owned, count x scalar_count */
};
struct realisations {
    size_t scalar_count;              /* set by the owner before the first add */
    uint64_t count;                   /* realisations in all blocks */
    struct realisation_block *blocks; /* owned, rising, without overlap */
    size_t block_count, capacity;
};
void realisations_clear(struct realisations *set);
/* Returns 0 if the block is of this kind and overlaps none so far; ERROR_INPUT with the reason. */
int realisations_check(const struct realisations *set, const struct block_result *result,
                       struct error *err);
/* Copies the scalars of a block that passed realisations_check. Nothing is added on failure. */
int realisations_add(struct realisations *set, const struct block_result *result,
                     struct error *err);
/* Copies scalar number `scalar` of every realisation, in order, into out[count]. */
void realisations_column(const struct realisations *set, size_t scalar, double *out);

#endif
