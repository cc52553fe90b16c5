/* Equations of a membrane on coarser and coarser points. Private to membrane.c. */
#ifndef RUGO_CORE_MAP_MEMBRANE_LEVELS_H
#define RUGO_CORE_MAP_MEMBRANE_LEVELS_H

#include "core/surface/grid.h"
#include <stdint.h>

enum { MEMBRANE_SIDES = 4, MEMBRANE_LEVELS_MOST = 40 };
#define MEMBRANE_NONE UINT32_MAX

/* Point a has the equation diagonal[a] u[a] - sum over its sides of weight[d] u[neighbour[d]] =
 * right side. Points stand in rising order of their cells, row by row. */
struct membrane_level {
    size_t nx, ny, count;
    uint32_t *cell_x, *cell_y;             /* owned, count each: where the point lies */
    uint32_t (*neighbour)[MEMBRANE_SIDES]; /* owned: left, right, below, above, or NONE */
    double (*weight)[MEMBRANE_SIDES];      /* owned; 0 where there is no neighbour */
    double *diagonal, *solution, *right;   /* owned */
    uint32_t *parent;                      /* owned: point of the next level; NULL: the last */
};

/* Allocates the arrays of a level but `parent`. */
int membrane_level_create(struct membrane_level *level, size_t nx, size_t ny, size_t count,
                          struct error *err);
void membrane_level_clear(struct membrane_level *level);

/* Makes the next level: the points within two by two cells become one, whose equation is half the
 * sum of theirs. periodic: the last cell of a row or column has the first for a neighbour. */
int membrane_level_coarsen(struct membrane_level *fine, struct membrane_level *coarse,
                           struct error *err);

/* One cycle: improves the solutions of levels[0], from 0, for its right side, symmetrically, so
 * that it is a preconditioner of conjugate gradients. */
void membrane_cycle(struct membrane_level *levels, size_t count);

#endif
