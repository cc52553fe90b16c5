/* The result of one block of realisations, on its path from the runner to the store. */
#ifndef RUGO_SCHEMA_RESULT_BLOCK_RESULT_H
#define RUGO_SCHEMA_RESULT_BLOCK_RESULT_H

#include <stddef.h>
#include <stdint.h>

struct block_text; /* schema/store/store.h */

/* The arrays belong to whoever made the struct. A runner or the reader of a message passes them on,
 * to be freed by block_result_clear; the store lends those that it reads. */
struct block_result {
    uint64_t first, count;         /* realisations first .. first + count - 1 of the case */
    size_t scalar_count;           /* as many as the kind's scalars */
    const char *const *names;      /* scalar_count; texts of the kind, or of what was read */
    const double *scalars;         /* count x scalar_count, realisation by realisation; NaN: none */
    const unsigned char *data;     /* the kind's accumulators, portable, versioned */
    size_t size;                   /* bytes of data */
    double seconds;                /* by the clock */
    double cpu_seconds;            /* of the threads that computed, without those that its BLAS may
                                      start; NaN: not known */
    const struct block_text *text; /* borrowed: its texts in the store; NULL: not made yet */
};
/* Frees names, scalars and data. */
void block_result_clear(struct block_result *result);

#endif
