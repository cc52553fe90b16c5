/* Height maps as text: CSV, and x y z lines. Private to height_map_file.c. */
#ifndef RUGO_CORE_MAP_HEIGHT_MAP_TEXT_H
#define RUGO_CORE_MAP_HEIGHT_MAP_TEXT_H

#include "core/map/height_map.h"
#include <stdio.h>

/* text[size] must be 0. On failure *map may hold heights, for the caller to clear. */
int height_map_csv_parse(struct height_map *map, const char *text, size_t size, double dx,
                         struct error *err);
int height_map_xyz_parse(struct height_map *map, const char *text, size_t size, struct error *err);

void height_map_csv_write(FILE *file, const struct grid *grid, const double *z);
void height_map_xyz_write(FILE *file, const struct grid *grid, const double *z);

#endif
