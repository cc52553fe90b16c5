/* Files that `press` writes: pressures, gaps and contact under the last load. */
#ifndef RUGO_SERVER_COMMAND_PRESS_FILES_H
#define RUGO_SERVER_COMMAND_PRESS_FILES_H

#include "server/command/press_solver.h"

/* Paths; NULL: not wanted. By their endings maps are npy, csv, xyz, or pictures (png, svg); without
 * one npy. */
struct press_paths {
    const char *pressures, *gap, *contact;
    const char *mesh; /* VTU of the surface with all three */
};

/* Before anything is computed: ERROR_INPUT for another ending, ERROR_SYSTEM where nothing can be
 * written. */
int press_files_check(const struct press_paths *paths, struct error *err);
/* Writes the part of the map that was measured: pressures are over E* h' times `unit`, gaps in the
 * map's length, contact is 1 or 0. z: heights as they were pressed. */
int press_files_write(const struct press_paths *paths, const struct press *press, const double *z,
                      double unit, const char *unit_name, struct error *err);

#endif
