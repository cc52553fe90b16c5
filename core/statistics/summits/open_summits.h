/* Summits of maps that do not repeat, or that have holes. */
#ifndef RUGO_CORE_STATISTICS_SUMMITS_OPEN_SUMMITS_H
#define RUGO_CORE_STATISTICS_SUMMITS_OPEN_SUMMITS_H

#include "core/statistics/measured_map.h"
#include "core/statistics/summits/summits.h"

/* Replaces the contents of list by the summits of an open map, in the order of rows. *searched: the
 * area (of a profile: the length) in which there could have been some. It is that of the points all
 * of whose 8 neighbours (of a profile: 2) are there; for refined summits, of the cells that have
 * LOCAL_HALF points and one more to all sides. Curvatures are central differences; refined summits
 * and their curvatures come from local interpolation (FORMULAS.md, F18.5). */
int open_summits_find(const struct measured_map *map, enum summit_stencil stencil,
                      struct summit_list *list, double *searched, struct error *err);

#endif
