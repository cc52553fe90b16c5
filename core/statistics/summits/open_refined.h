/* Refined summits of an open map. Private to open_summits.c, but for how many
 * points around it needs. */
#ifndef RUGO_CORE_STATISTICS_SUMMITS_OPEN_REFINED_H
#define RUGO_CORE_STATISTICS_SUMMITS_OPEN_REFINED_H

#include "core/statistics/measured_map.h"
#include "core/statistics/summits/summit_list.h"

/* Appends the true maxima of the interpolant of local_wave.h to an empty list, in the order of
 * rows. They are searched from the maxima of a grid of at least 16 points a shortest wave, 64 for
 * profiles, as in refined.h, and counted in the cells that are marked. */
int open_refined_find(const struct measured_map *map, const unsigned char *whole,
                      struct summit_list *list, struct error *err);
/* How many points a marked cell, which is that behind a point, needs before and after that. */
enum { OPEN_REFINED_BEFORE = 8, OPEN_REFINED_AFTER = 9 };

#endif
