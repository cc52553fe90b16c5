/* The files that `press` writes of the first model, load by load, and of the last load that has
 * values: maps, meshes, steps and a table of nodes.
 *
 * Life: open -> write (each load) ... -> close. */
#ifndef RUGO_SERVER_COMMAND_MAP_PRESS_FILES_H
#define RUGO_SERVER_COMMAND_MAP_PRESS_FILES_H

#include "core/nodal/step_folder.h"
#include "jobs/maps/press/map_press.h"
#include "server/command/map/mesh_file.h"
#include "server/command/map/press/press_loads.h"

/* Paths; NULL: not wanted. By their endings maps are npy, csv, xyz, or pictures (png, svg); without
 * one npy. */
struct press_paths {
    const char *pressures, *gap, *contact;
    const char *face;  /* VTU of the surface with all three */
    const char *mesh;  /* of the block (mesh_file.h) */
    const char *steps; /* folder of all loads */
    const char *nodes; /* table of all loads */
};
/* Before anything is computed: ERROR_INPUT for another ending, ERROR_SYSTEM where nothing can be
 * written. */
int press_files_check(const struct press_paths *paths, struct error *err);
/* Returns whether a file is asked for. */
bool press_paths_ask(const struct press_paths *paths);

/* What the maps of a load are in. */
struct press_units {
    const char *length, *height; /* of the map */
    bool modulus;                /* pressures are in Pa, else over E* h' */
};

struct press_files {
    const struct press_paths *paths; /* borrowed, as the next two */
    const struct press_loads *loads;
    const double *z; /* heights as they are pressed */
    struct press_units units;
    struct step_folder folder;
    struct mesh_file mesh;
    struct contact_step step; /* the last with values */
};
/* Opens those of all loads; what is above `folder` is filled. */
int press_files_open(struct press_files *files, struct error *err);
/* Writes the part of the map that was measured: pressures are over E* h', with a modulus in Pa,
 * gaps in the map's length, contact is 1 or 0. */
int press_files_write(struct press_files *files, const struct map_press *press, size_t load,
                      struct error *err);
/* Writes those of the last load, where one has values and status is 0, and closes all. Returns the
 * status passed in, or its own. */
int press_files_close(struct press_files *files, int status, struct error *err);

#endif
