/* The flat face of an elastic half-space that is pressed in a rectangle alone: nothing repeats, and
 * the face is free beyond the rectangle.
 *
 * u = K * p is a convolution over the points of the rectangle, by transforms of a grid padded to at
 * least twice its sides (F18.24). K holds the waves of the grid alone, as the compliance of a
 * periodic half-space does (F10.1). Both discretise pressures alike, so that the law of edges
 * (edge.h) of the one holds for the other. */
#ifndef RUGO_CORE_CONTACT_FREE_SPACE_H
#define RUGO_CORE_CONTACT_FREE_SPACE_H

#include "core/contact/block.h"

/* The padded grid has even sides whose transforms are fast, and the same spacings. A coating pads
 * small grids more. */
void free_space_padded(const struct grid *grid, const struct block *block, struct grid *padded);

/* A grid that is an eighth wider to the right and below, with the same spacings: what a
 * preconditioner repeats, so that it does not couple opposite sides of the rectangle. Conjugate
 * gradients on 256 x 256 points took 10 steps a load with an eighth and a quarter, 14 with a
 * twentieth, and 28 without. */
void free_space_around(const struct grid *grid, struct grid *around);

/* Fills symbol, a value a wave of the padded grid in the layout of transform.h. The transform of
 * the pressures times symbol is that of the displacements times E*, in the grid's length.
 * Displacements are relative to far points. Profiles have no far points at rest; theirs are
 * relative to a point on the face at a distance lx from a line load. The block is a half-space, and
 * may have a coating. ERROR_MEMORY. */
int free_space_symbol(const struct grid *grid, const struct grid *padded, const struct block *block,
                      double *symbol, struct error *err);

/* Memory of contact in free space beyond that on a periodic grid: a transform of the padded grid,
 * its symbol twice, and what the solver needs for the grid around. */
double free_space_bytes(const struct grid *grid);

#endif
