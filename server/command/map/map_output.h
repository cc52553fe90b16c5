/* Values on a grid in a file of their own, by its ending: npy, csv, xyz, or a picture (png, svg).
 */
#ifndef RUGO_SERVER_COMMAND_MAP_MAP_OUTPUT_H
#define RUGO_SERVER_COMMAND_MAP_MAP_OUTPUT_H

#include "server/command/output_file.h"

/* Before anything is computed: ERROR_INPUT for another ending, ERROR_SYSTEM where nothing can be
 * written. A name without an ending is npy. */
int map_output_check(const char *path, struct error *err);
/* Returns whether a file of this name is a picture. */
bool map_output_is_picture(const char *path);
/* Writes the values; a picture has the labels, whose grid and z are left out, and xyz their x0 and
 * y0. */
int map_output_write(const char *path, const struct map_picture *labels, const struct grid *grid,
                     const double *values, struct error *err);

#endif
