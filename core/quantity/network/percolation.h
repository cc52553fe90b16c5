/* Nodes of a grid that are joined to both of its ends. Private to core/quantity/network. */
#ifndef RUGO_CORE_QUANTITY_NETWORK_PERCOLATION_H
#define RUGO_CORE_QUANTITY_NETWORK_PERCOLATION_H

#include <stdbool.h>
#include <stddef.h>

/* Nodes with k > 0 are joined along grid lines, unless walled also from the last row to the first.
 * Sets k = 0
 * where a node is not joined to both the first and the last column, and returns whether any is.
 * k[j * stride + i], i < nx; link: scratch for nx * ny. */
bool percolation_keep(size_t nx, size_t ny, bool walled, size_t stride, double *k, ptrdiff_t *link);

#endif
