/* Approximate rank ordering by a table, for iterates that are far from convergence. The
 * distribution of the keys is exact at the edges of narrow bins and linear between them, and
 * heights follow from it. It costs one look-up a key, in blocks of any size. Only the order within
 * a bin differs from that of rank.h. */
#ifndef RUGO_CORE_SURFACE_RANK_TABLE_H
#define RUGO_CORE_SURFACE_RANK_TABLE_H

#include "core/error.h"
#include <stddef.h>

struct rank_table;

/* Makes a table for n keys. */
int rank_table_create(struct rank_table **out, size_t n, struct error *err);
void rank_table_destroy(struct rank_table **table);
double rank_table_bytes(size_t n);

/* Begins to count; keys outside low < high are counted in the outer bins. */
void rank_table_start(struct rank_table *table, double low, double high);
/* Counts n more keys; NaN counts as the lowest. */
void rank_table_count(struct rank_table *table, size_t n, const double *key);
/* Once all keys are counted: makes the table from the n heights to be ordered, rising. Returns the
 * range of the counted keys in low and high. */
void rank_table_finish(struct rank_table *table, const double *sorted, double *low, double *high);
/* ordered[i] = height of the rank of key[i]. */
void rank_table_order(const struct rank_table *table, size_t n, const double *key, double *ordered);

#endif
