/* Rank ordering, which takes most of the time of non-Gaussian generation. */
#ifndef RUGO_CORE_SURFACE_RANK_H
#define RUGO_CORE_SURFACE_RANK_H

#include "core/error.h"
#include <stddef.h>

struct ranker;

/* Makes a workspace for n values; rank.c states its memory. */
int ranker_create(struct ranker **out, size_t n, struct error *err);
void ranker_destroy(struct ranker **ranker);
/* Returns the bytes that are used where few keys are alike. */
size_t ranker_bytes(size_t n);

/* ordered[i] = sorted[rank of key[i]], equal keys ranked in order of index (as a stable sort).
 * sorted rises; ordered may not overlap key or sorted. ERROR_NUMERIC when a key is NaN or infinite
 * (ordered is then undefined). */
int rank_order(struct ranker *ranker, const double *key, const double *sorted, double *ordered,
               struct error *err);
/* Sorts z so that it rises; fails with ERROR_NUMERIC as above. */
int rank_sort(struct ranker *ranker, double *z, struct error *err);

#endif
