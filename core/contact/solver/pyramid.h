/* Continuation of values in a set of nodes of a surface over the whole periodic grid, by a pyramid
 * of ever coarser grids: a linear map E, and its transpose. Private to core/contact.
 *
 * Upwards, a cell of a level has the mean of what is known in its children, with the weight min(1,
 * FALL times the sum of their weights). Downwards, what is not known is interpolated from the level
 * above, as images are filled by push and pull (Gortler, Grzeszczuk, Szeliski & Cohen 1996). FALL
 * is below 1/2, so that values fall off away from the set, as the field of a patch does. */
#ifndef RUGO_CORE_CONTACT_SOLVER_PYRAMID_H
#define RUGO_CORE_CONTACT_SOLVER_PYRAMID_H

#include "core/error.h"
#include "core/surface/grid.h"
#include "core/team.h"

/* A level has half of the cells of the one below in each direction, rounded up. */
struct pyramid_level {
    size_t nx, ny;
    /* nx * ny each, of levels from 1 on; of the grid itself the set is known by r. */
    double *sum;   /* of the weights of a cell's children */
    double *value; /* scratch */
};
enum { PYRAMID_LEVELS_MOST = 65 };
struct pyramid {
    size_t count;
    struct pyramid_level levels[PYRAMID_LEVELS_MOST];
    double *memory; /* owned: all arrays of the levels */
    double *lines;  /* owned, scratch: for each thread a row, with a cell before and two behind */
    struct team *team; /* borrowed; NULL: the caller alone */
};
int pyramid_create(struct pyramid *out, const struct grid *grid, struct error *err);
/* Lets a team work along, with the same digits; borrowed until the next one. ERROR_MEMORY. */
int pyramid_set_team(struct pyramid *pyramid, struct team *team, struct error *err);
void pyramid_clear(struct pyramid *pyramid);
double pyramid_bytes(const struct grid *grid);

/* Takes the set of nodes r != 0. */
void pyramid_set(struct pyramid *pyramid, const double *r);
/* out = E r. r has the set that was taken; out is r in it. */
void pyramid_continue(struct pyramid *pyramid, const double *r, double *out);
/* x = E^T x in the set r != 0, which was taken; elsewhere x is of no meaning. */
void pyramid_transpose(struct pyramid *pyramid, const double *r, double *x);

#endif
