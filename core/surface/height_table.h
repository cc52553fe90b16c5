/* A height distribution by numbers: heights at probabilities, such as a bearing curve, or samples
 * (FORMULAS.md, F4.6). Immutable once made; many threads may read one. */
#ifndef RUGO_CORE_SURFACE_HEIGHT_TABLE_H
#define RUGO_CORE_SURFACE_HEIGHT_TABLE_H

#include "core/error.h"
#include "core/surface/height_moments.h"
#include <stddef.h>

struct height_table;

enum { HEIGHT_QUANTILES_LEAST = 5, HEIGHT_SAMPLES_LEAST = 8 };

/* Checks n probabilities of quantiles: ERROR_INPUT unless there are enough, in [0, 1] and rising.
 */
int height_table_check(size_t n, const double *probability, struct error *err);
/* Makes a table of n heights of any unit, height number a being the quantile at probability[a].
 * Heights may not fall; equal ones are a plateau of that share. Those at probabilities 0 and 1 are
 * the bounds; without them the tails are Gaussian. Copies the arrays. ERROR_INPUT for probabilities
 * as above, and for heights that are not finite, fall or are all equal; ERROR_MEMORY. */
int height_table_of_quantiles(struct height_table **out, size_t n, const double *probability,
                              const double *height, struct error *err);
/* Makes one of n samples in any order: in rising order, number a from 0 is the quantile at
 * (a + 1/2)/n. Errors as above. */
int height_table_of_samples(struct height_table **out, size_t n, const double *sample,
                            struct error *err);
void height_table_destroy(struct height_table **table);

/* Returns the quantile of the raw variable, whose unit is the table's own, at a probability in (0,
 * 1). */
double height_table_quantile(const struct height_table *table, double probability);
/* Returns the quantile at the probability of a standard Gaussian score. */
double height_table_at_score(const struct height_table *table, double score);
/* Returns the share of heights up to a raw one. */
double height_table_cdf(const struct height_table *table, double raw);
void height_table_moments(const struct height_table *table, struct height_moments *out);

#endif
