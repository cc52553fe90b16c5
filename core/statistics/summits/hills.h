/* Hills of a surface that stand out: each has one peak. Its height is how far one must go down from
 * the peak to reach a higher one. */
#ifndef RUGO_CORE_STATISTICS_SUMMITS_HILLS_H
#define RUGO_CORE_STATISTICS_SUMMITS_HILLS_H

#include "core/statistics/measured_map.h"
#include "core/statistics/summits/summit_list.h"

struct hills {
    size_t count;
    double density;   /* per area of the points all of whose 8 neighbours are there */
    double curvature; /* mean of -(z_xx + z_yy)/2 at the peaks, central differences; NaN: no hill */
};
/* Finds the peaks whose hills are `least` or more above their highest saddle to a higher peak,
 * after Wolf's pruning of the change tree (FORMULAS.md, F18.10). A point has 8 neighbours. Points
 * at the side of an open map and beside holes prune others, but do not count: they may be the slope
 * of a higher one. Nothing stands out by 0, as a share of the range of a flat map is. Surfaces
 * alone. peaks: an empty list that those which count are put in, highest
 * first, or NULL. Memory: a byte a point, and 4 for each that lies less than `least` below a peak.
 * ERROR_MEMORY, or ERROR_INPUT for 2^32 - 1 points or more. */
int hills_find(const struct measured_map *map, double least, struct summit_list *peaks,
               struct hills *out, struct error *err);

#endif
