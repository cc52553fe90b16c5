/* A hierarchy of ever coarser networks, and one cycle through it, which is a symmetric positive
 * definite approximation of the inverse of the finest one. Private to core/quantity/network. */
#ifndef RUGO_CORE_QUANTITY_NETWORK_MULTIGRID_H
#define RUGO_CORE_QUANTITY_NETWORK_MULTIGRID_H

#include "core/error.h"
#include "core/quantity/network/level.h"

/* Spacings grow eightfold: where they exceed the channels between contacts, coarser grids hardly
 * help. With five levels 1024 x 1024 nodes took 80 steps at 0.34 of the area in contact. */
enum { MULTIGRID_LEVELS_MOST = 4 };
struct coarsest;
struct multigrid {
    size_t count;
    struct level levels[MULTIGRID_LEVELS_MOST]; /* from the finest on */
    double *memory;                             /* owned: all arrays of the levels */
    size_t values;                              /* of memory */
    struct coarsest *coarsest;                  /* owned */
};

/* For any shape of at most so many values in a hierarchy (multigrid_values). ERROR_MEMORY. */
int multigrid_create(struct multigrid *out, size_t values, struct error *err);
/* Takes a shape, nx >= 2 and ny even; of another one than before all arrays become 0. ERROR_MEMORY,
 * after which no shape is taken. */
int multigrid_shape(struct multigrid *multigrid, size_t nx, size_t ny, struct error *err);
void multigrid_clear(struct multigrid *multigrid);
size_t multigrid_values(size_t nx, size_t ny);
/* Bytes of what a shape takes beside its values. */
double multigrid_coarsest_bytes(size_t nx, size_t ny);
/* Takes the conductances e, n and s of the finest level. ERROR_MEMORY, ERROR_NUMERIC. */
int multigrid_prepare(struct multigrid *multigrid, struct error *err);
/* u of the finest level approximates the solution for its r. */
int multigrid_cycle(struct multigrid *multigrid, struct error *err);

#endif
