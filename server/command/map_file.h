/* A height map in a file that was named on the command line. */
#ifndef RUGO_SERVER_COMMAND_MAP_FILE_H
#define RUGO_SERVER_COMMAND_MAP_FILE_H

#include "core/map/height_map.h"

/* --dx; false, told on standard error, for what is no number above 0. text NULL: *dx is 0. */
bool map_spacing(const char *command, const char *text, double *dx);
/* Reads the map by the ending of its name, or by its first byte; errors name the file. */
int map_file_read(struct height_map *out, const char *path, double dx, struct error *err);

#endif
