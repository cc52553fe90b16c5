/* The coarsest network of a hierarchy, by a sparse Cholesky factorisation (CHOLMOD) whose pattern
 * is analysed once. Private to core/quantity/network. */
#ifndef RUGO_CORE_QUANTITY_NETWORK_COARSEST_H
#define RUGO_CORE_QUANTITY_NETWORK_COARSEST_H

#include "core/error.h"
#include "core/quantity/network/level.h"

struct coarsest;
/* Borrows the level, which must outlive it. */
int coarsest_create(struct coarsest **out, const struct level *level, struct error *err);
void coarsest_destroy(struct coarsest **coarsest);
/* Bytes, about, of one for so many nodes. */
double coarsest_bytes(size_t nodes);
/* Factorises the level's conductances. ERROR_MEMORY, ERROR_NUMERIC. */
int coarsest_factorise(struct coarsest *coarsest, struct error *err);
/* level->u = the solution for level->r. */
int coarsest_solve(struct coarsest *coarsest, struct error *err);

#endif
