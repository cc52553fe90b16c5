/* The error of a value by the height of its block, from the pair of an exact layer as high as the
 * block and a half-space, both on a coarse mesh. Studies and single maps share it. */
#ifndef RUGO_JOBS_CONTACT_COMPANION_BLOCK_ERROR_H
#define RUGO_JOBS_CONTACT_COMPANION_BLOCK_ERROR_H

#include "core/contact/block.h"
#include "jobs/contact/contact_error.h"
#include "jobs/estimate.h"

/* Returns a bound of the relative change of a measure by the height, several times the relative
 * difference of compliance from a half-space at the longest wave of the cell. */
double block_bound(const struct block *block, double longest);
/* Returns whether a block of such a bound needs the pair; others are as if they were infinite. */
bool block_is_low(double bound);
struct contact_error block_error_high(double y, double bound);
/* y: the value; block: that of the layer; change: the layer less the half-space. */
struct contact_error block_error_low(double y, double block, struct estimate change);

#endif
