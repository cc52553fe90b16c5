/* Columns, or rows, that hold nothing of their own: copies of a neighbour, and what lies on a line
 * between both neighbours (FORMULAS.md, F18.41). */
#ifndef RUGO_CORE_MAP_ARTEFACTS_REPEATED_LINES_H
#define RUGO_CORE_MAP_ARTEFACTS_REPEATED_LINES_H

#include "core/error.h"
#include "core/map/artefacts/differences.h"

struct repeated_lines {
    size_t copies, between; /* 0 where all lines are alike */
    size_t lines;           /* of the map */
    bool every_second;      /* nearly all of them, beside each other's neighbours */
    size_t measured;        /* the first of the others then: 0 or 1 */
};
/* Looks along an axis: 0: at columns, along x, 1: at rows; of a profile at its points. step: of
 * the heights, 0: none. Holes (NaN) are left out. Memory: two lines. ERROR_MEMORY. */
int repeated_lines_find(const struct grid *grid, const double *z, int axis,
                        const struct map_differences *differences, double step,
                        struct repeated_lines *out, struct error *err);

#endif
