/* Operator-dependent interpolation between two grids of a network, and the coarser network that it
 * gives (black box multigrid: Alcouffe, Brandt, Dendy & Painter 1981; Dendy 1982). Private to
 * core/quantity/network.
 *
 * A node between two of the coarser grid has a mean of both, weighted with the conductances to
 * their sides; a node amid four has the value at which no flow is left over. So values follow what
 * conducts, and none crosses a contact. A node without such a path has no value from the coarser
 * grid: it is left to relaxation. */
#ifndef RUGO_CORE_QUANTITY_NETWORK_COARSENING_H
#define RUGO_CORE_QUANTITY_NETWORK_COARSENING_H

#include "core/quantity/network/level.h"

/* Fills the interpolation from coarse and its conductances: P^T A P as a network, to rounding of
 * each conductance alone. */
void coarsening_make(const struct level *fine, struct level *coarse);
/* coarse->r = P^T fine->residual. */
void coarsening_restrict(const struct level *fine, struct level *coarse);
/* fine->u += P coarse->u. */
void coarsening_prolong(const struct level *coarse, struct level *fine);
/* The same between the finest level and the next, at nodes of i + j even alone (relaxation.h). */
void coarsening_restrict_finest(const struct level *fine, struct level *coarse);
void coarsening_prolong_finest(const struct level *coarse, struct level *fine);

#endif
