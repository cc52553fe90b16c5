/* Rank ordering by a table, for iterates that are far from their end: heights are placed by the
 * distribution of the keys, known exactly at the edges of narrow bins and taken as linear between
 * them. It costs one look-up a key, in any blocks, where rank.h orders them all; what differs is
 * the order within a bin. */
#ifndef RUGO_CORE_SURFACE_RANK_TABLE_H
#define RUGO_CORE_SURFACE_RANK_TABLE_H

#include "core/error.h"
#include <stddef.h>

struct rank_table;

/* Makes a table for n keys. */
int rank_table_create(struct rank_table **out, size_t n, struct error *err);
void rank_table_destroy(struct rank_table **table);
double rank_table_bytes(size_t n);

/* Begins to count; keys outside of low < high are counted in the outer bins. */
void rank_table_start(struct rank_table *table, double low, double high);
/* Counts n more keys; those that are not numbers are taken as the lowest. */
void rank_table_count(struct rank_table *table, size_t n, const double *key);
/* Once all keys are counted: makes the table from the n heights to be placed, rising. Sets the
 * range of the counted keys. */
void rank_table_finish(struct rank_table *table, const double *sorted, double *low, double *high);
/* placed[i] = height of the rank of key[i]. */
void rank_table_place(const struct rank_table *table, size_t n, const double *key, double *placed);

#endif
