/* The compliance of a block under a bonded layer of another material: exact, wave by wave (F22.1,
 * F22.2). Private to core/contact, but for its stiffness. */
#ifndef RUGO_CORE_CONTACT_COATING_H
#define RUGO_CORE_CONTACT_COATING_H

#include "core/contact/block.h"

/* S E* under a wave number k > 0, E* that of the block below the layer. For a block with a layer,
 * of any height that is above the layer's thickness. */
double coating_compliance(double k, const struct block *block);

/* The part of that compliance beyond that of the uncoated half-space: S E* - 2/k, for k >= 0. */
double coating_excess(double k, const struct block *block);

#endif
