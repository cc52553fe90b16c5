/* Files of steps: in a folder step-1.vtu and so on, which are the block where there is a mesh, else
 * its face, and steps.pvd, which lists them by load for ParaView (VTK's collection of files with a
 * time each); and a table of nodes (node_table.h).
 *
 * Life: open -> put (a step) ... -> close. */
#ifndef RUGO_CORE_NODAL_STEP_FOLDER_H
#define RUGO_CORE_NODAL_STEP_FOLDER_H

#include "core/nodal/nodal_step.h"

struct step_folder {
    const char *path;  /* borrowed; NULL: no steps */
    const char *nodes; /* borrowed; NULL: no table */
    char *name;        /* owned: room for the path of a file */
    size_t name_size;
    FILE *collection, *table;
    size_t count; /* steps so far */
};
/* Makes the folder if it is missing, and opens its files. The first step replaces those of an
 * earlier run, and closing takes away those of more steps. ERROR_SYSTEM names what could not be
 * made. */
int step_folder_open(struct step_folder *out, const char *path, const char *nodes,
                     struct error *err);
int step_folder_put(struct step_folder *folder, const struct nodal_step *step, struct error *err);
/* Closes what is open, also after a failure, and returns the status passed in, or its own. The
 * collection then lists the steps that were put; after a failure before the first one the files of
 * an earlier run are as they were, and without such a run there are none. Accepts a zeroed struct.
 */
int step_folder_close(struct step_folder *folder, int status, struct error *err);

/* Writes a step as one VTU file. */
int step_vtu(FILE *file, const struct nodal_step *step, struct error *err);

#endif
