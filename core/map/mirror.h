/* A map that is made to repeat by its mirror images. */
#ifndef RUGO_CORE_MAP_MIRROR_H
#define RUGO_CORE_MAP_MIRROR_H

#include "core/map/height_map.h"

/* Makes the map one of 2nx by 2ny points (a profile: 2nx), each height at equal distances from the
 * mirrors, which stand half a spacing beyond the outermost points: periodic, without steps, the map
 * in its first rows and columns. ERROR_INPUT where that is more than a map may have, ERROR_MEMORY;
 * the map is untouched then. */
int height_map_mirror(struct height_map *map, struct error *err);

#endif
