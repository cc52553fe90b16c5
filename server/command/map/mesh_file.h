/* A meshed block as one file, by the ending of its name: .msh for Gmsh, .inp for CalculiX and
 * Abaqus with a step for each load, .vtu for ParaView.
 *
 * Life: {0} with a path -> put (a step) ... -> clear. */
#ifndef RUGO_SERVER_COMMAND_MAP_MESH_FILE_H
#define RUGO_SERVER_COMMAND_MAP_MESH_FILE_H

#include "core/full/file/mesh_inp.h"
#include "core/nodal/nodal_step.h"

struct mesh_file {
    const char *path;         /* borrowed; NULL: none is written */
    struct inp_step *history; /* owned: of the loads so far */
    size_t count;
};
/* Before anything is computed: ERROR_INPUT where the file of a mesh, or of the table of nodes
 * beside it, which is .csv, has a name of another ending. NULL: not wanted. */
int mesh_file_check(const char *mesh, const char *nodes, struct error *err);
/* Notes a step of so many at most, which has a mesh; nothing without a path. ERROR_MEMORY. */
int mesh_file_note(struct mesh_file *mesh, const struct nodal_step *step, size_t most,
                   struct error *err);
/* Writes the block as it is in this step, with all that were noted, over what was there. What was
 * there stays where the format cannot hold the block; no file is left where it cannot be written.
 */
int mesh_file_write(const struct mesh_file *mesh, const struct nodal_step *step, struct error *err);
void mesh_file_clear(struct mesh_file *mesh);

#endif
