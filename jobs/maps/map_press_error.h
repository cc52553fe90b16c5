/* What the points of a map do to its contact: the change from every second point. */
#ifndef RUGO_JOBS_MAPS_MAP_PRESS_ERROR_H
#define RUGO_JOBS_MAPS_MAP_PRESS_ERROR_H

#include "jobs/maps/map_press.h"

/* Presses the map with every second point along each axis under the same forces, and fills errors
 * of the uncertain columns with the size of the change: the error itself where it falls with the
 * spacing, more than it where it falls faster. All others are NaN, as are those of maps that cannot
 * be thinned (fewer than 16 points along a side, of a periodic one an odd number) or whose coarse
 * contact is not found. press may be released; pressures are the loads, in E*. ERROR_MEMORY
 * alone. */
int map_press_error(const struct map_press *press, const struct height_map *map,
                    const struct press_block *block, size_t loads, const double *pressures,
                    struct press_row *rows, struct error *err);

#endif
