/* What `characterise` tells of a map in a file: first what was done to it, and why. */
#ifndef RUGO_SERVER_SHOW_MAP_CHARACTERISATION_H
#define RUGO_SERVER_SHOW_MAP_CHARACTERISATION_H

#include "core/map/height_map.h"
#include "server/show/characterisation.h"

/* In the order of these words: */
#define MAP_BOUNDARIES "auto|open|periodic"
#define MAP_DETRENDS "auto|none|mean|plane|quadratic"

/* Numbers of the words above. auto is, of the boundary, periodic where the map is whole and its
 * seam no rougher than the roughest place inside (FORMULAS.md, F18.3), else open; of the trend,
 * none in a periodic map and a plane in an open one. */
struct map_request {
    int boundary, detrend;
};

/* Takes the trend out of the map and fills *out, {0} at first, which the caller clears either way;
 * *boundary tells what the map was taken as.
 * ERROR_INPUT where the map has no heights, is to be
 * periodic with holes, or has too few heights for its trend. */
int map_characterise(struct characterisation *out, struct height_map *map,
                     const struct map_request *request, enum boundary *boundary, struct error *err);

#endif
