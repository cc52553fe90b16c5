/* Interpolates a map at other points (FORMULAS.md, F18.22). */
#ifndef RUGO_CORE_MAP_MAP_RESAMPLE_H
#define RUGO_CORE_MAP_MAP_RESAMPLE_H

#include "core/map/height_map.h"
#include "core/statistics/measured_map.h"

/* Replaces the points by nx by ny others (ny 1 of a profile). Those of a periodic map cover its
 * cell, whatever dx and dy, and take its waves. Those of an open one are dx and dy apart in the
 * middle of the old ones, by a spline; where they are farther apart than the old ones, a kernel
 * removes the waves that they cannot resolve. The map must have no holes. ERROR_INPUT, the map
 * untouched, names what is allowed. Memory: the new map, and one of nx by the old ny. */
int map_resample(struct height_map *map, enum boundary boundary, size_t nx, size_t ny, double dx,
                 double dy, struct error *err);

#endif
