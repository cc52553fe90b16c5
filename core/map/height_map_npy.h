/* NumPy's npy format for height maps. For height_map_file.c, and for archives of such files. */
#ifndef RUGO_CORE_MAP_HEIGHT_MAP_NPY_H
#define RUGO_CORE_MAP_HEIGHT_MAP_NPY_H

#include "core/map/height_map.h"
#include <stdio.h>

int height_map_npy_parse(struct height_map *map, const char *data, size_t size, double dx,
                         struct error *err);
/* Reads rows and columns from the first bytes of a file; ERROR_INPUT where its type or dimensions
 * are not those of a map. */
int height_map_npy_shape(const char *data, size_t size, size_t *ny, size_t *nx, struct error *err);
void height_map_npy_write(FILE *file, const struct grid *grid, const double *z);

#endif
