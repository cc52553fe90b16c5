/* A height map in a file that was named on the command line. */
#ifndef RUGO_SERVER_COMMAND_MAP_FILE_H
#define RUGO_SERVER_COMMAND_MAP_FILE_H

#include "core/map/height_map_file.h"

#define MAP_SPACING_HELP "distance of points (what the file says, or 1)"

/* Reads the map by the ending of its name, or by its first byte; dx 0: the distance of points
 * that the file tells, or 1. Errors name the file. */
int map_file_read(struct height_map *out, const char *path, double dx, struct error *err);

#endif
