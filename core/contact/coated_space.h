/* What a coating adds to the displacement of a half-space in free space. Private to core/contact.
 *
 * Its compliance less 2/k (coating_excess) is even in k only in part, so that its kernel falls off
 * as a power of the distance. It is split smoothly by wave number (F22.4). Long waves are summed as
 * a function of the distance, by quadrature. All others are those of the padded grid; their kernel
 * falls off as a Gaussian. */
#ifndef RUGO_CORE_CONTACT_COATED_SPACE_H
#define RUGO_CORE_CONTACT_COATED_SPACE_H

#include "core/contact/block.h"

struct coated_space;
/* Borrows nothing. ERROR_MEMORY. */
int coated_space_create(struct coated_space **out, const struct grid *grid,
                        const struct grid *padded, const struct block *block, struct error *err);
void coated_space_destroy(struct coated_space **space);

/* Returns by how much the padded grid is longer at least, whatever the grid. */
double coated_space_reach(const struct grid *grid);

/* Returns what long waves add to the displacement times E* at a distance from a unit force; for a
 * profile, from a unit line load. */
double coated_space_far(const struct coated_space *space, double distance);
/* Returns the symbol of all other waves. */
double coated_space_near(const struct coated_space *space, double k);

#endif
