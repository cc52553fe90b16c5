/* The flat face of an elastic half-space that is pressed in a rectangle alone: nothing repeats, and
 * beyond the rectangle the face is free.
 *
 * u = K * p is a convolution over the points of the rectangle, made by transforms of a grid padded
 * to twice its sides or more (F18.24). K holds the waves of the grid alone, as the compliance of a
 * periodic half-space does (F10.1), so that both discretise pressures alike: what is known of edges
 * on the one (edge.h) holds on the other. */
#ifndef RUGO_CORE_CONTACT_FREE_SPACE_H
#define RUGO_CORE_CONTACT_FREE_SPACE_H

#include "core/surface/grid.h"

/* The padded grid: of even sides whose transforms are fast, with the same spacings. */
void free_space_padded(const struct grid *grid, struct grid *padded);

/* Fills symbol, a value a wave of the padded grid in the layout of transform.h, with what the
 * transform of the pressures is multiplied by to give that of the displacements E*, the grid's
 * length. Displacements are against far points; of profiles, which have none at rest, against a
 * place on the face at a distance lx from a line load. */
int free_space_symbol(const struct grid *grid, const struct grid *padded, double *symbol,
                      struct error *err);

/* What contact in free space takes beside that of a periodic grid: a transform of the padded grid,
 * and its symbol twice. */
double free_space_bytes(const struct grid *grid);

#endif
