/* One grid of a hierarchy: a network of conductances between the nodes of a grid, open across x and
 * periodic along y, whose first and last column also lead to the ends. Private to
 * core/quantity/network.
 *
 * Node (i, j) is at level_row(j) + i, with i from -1 to nx: the columns -1 and nx stay 0. The
 * number of rows is even. */
#ifndef RUGO_CORE_QUANTITY_NETWORK_LEVEL_H
#define RUGO_CORE_QUANTITY_NETWORK_LEVEL_H

#include <stddef.h>

/* How a node that the next coarser grid lacks has its value from those that it has. Cell (I, J) has
 * the corners (2I, 2J) A, (2I+2, 2J) B, (2I, 2J+2) C, (2I+2, 2J+2) D of the finer grid. Arrays of
 * the coarser grid's layout. */
struct interpolation {
    double *x_a, *x_b;             /* of the node between A and B */
    double *y_a, *y_c;             /* ... between A and C */
    double *z_a, *z_b, *z_c, *z_d; /* ... in the middle */
};

struct level {
    size_t nx, ny;
    size_t rows; /* that the finer grid has: ny, or one less (network.c) */
    size_t stride;
    double *e, *n;           /* conductances to (i+1, j) and (i, j+1) */
    double *ne, *nw;         /* ... to (i+1, j+1) and (i-1, j+1); of the finest grid NULL */
    double *s;               /* ... to the ends, of both together */
    double *inverse;         /* of the sum of all conductances of a node; 0 of a node without */
    double *u, *r;           /* solution and right-hand side */
    double *residual;        /* NULL of the finest grid */
    struct interpolation to; /* the finer grid from this one; NULLs of the finest */
};

static inline size_t level_row(const struct level *level, size_t j) {
    return j * level->stride + 1;
}
/* Values of an array. */
static inline size_t level_size(const struct level *level) {
    return level->ny * level->stride + 2;
}
static inline size_t level_above(const struct level *level, size_t j) {
    return level_row(level, j + 1 < level->ny ? j + 1 : 0);
}
static inline size_t level_below(const struct level *level, size_t j) {
    return level_row(level, j > 0 ? j - 1 : level->ny - 1);
}

#endif
