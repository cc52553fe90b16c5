/* The nearest cells that tell something, around each cell of a row of a tally in turn: what rare
 * cells ask of their neighbours. Most cells of a sparse tally tell nothing, and a walk through the
 * row passes each of them once, where a window around every cell would pass most of them again and
 * again. */
#ifndef RUGO_JOBS_TALLY_NEAR_H
#define RUGO_JOBS_TALLY_NEAR_H

#include "jobs/tally.h"

/* What a cell tells: of things in it; of things that are not; of their scatter. */
enum tally_telling { TELLING_THINGS, TELLING_OTHERS, TELLING_SCATTER };

/* As many cells on either side as can be asked for: each tells of one realisation at least. */
struct tally_near {
    const struct tally *tally; /* borrowed */
    uint64_t realisations;
    enum tally_telling telling;
    size_t cell, low, high;              /* where the walk is; its row, up to high - 1 */
    size_t left_count, left[TALLY_RARE]; /* nearest first */
    size_t right_count, right[TALLY_RARE];
    size_t ahead; /* the first cell to the right that has not been looked at */
};
void tally_near_begin(struct tally_near *near, const struct tally *tally, uint64_t realisations,
                      enum tally_telling telling, size_t cell);
/* Goes on to the next cell, which may be the first of the next row. */
void tally_near_next(struct tally_near *near);

#endif
