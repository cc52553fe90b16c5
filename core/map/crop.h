/* A part of a map. */
#ifndef RUGO_CORE_MAP_CROP_H
#define RUGO_CORE_MAP_CROP_H

#include "core/map/height_map.h"

/* Leaves the points of columns x to x + width - 1 and rows y to y + height - 1, with their heights
 * bit for bit and their spacing. ERROR_INPUT, the map untouched, where they are not all in the map
 * or fewer than 2 by 1. */
int map_crop(struct height_map *map, size_t x, size_t y, size_t width, size_t height,
             struct error *err);

#endif
