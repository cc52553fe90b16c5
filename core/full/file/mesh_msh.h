/* A meshed block as a file of Gmsh, format 2.2 in ASCII (Geuzaine & Remacle 2009), which Gmsh,
 * meshio and most finite element programs read.
 *
 * Physical groups: "block", the elements; "face" (the rough side), "far" (the side away from it),
 * and the periodic sides "left", "right", of surfaces also "front", "back". Periodic links name for
 * each point of "right" and "back" its image on the other side. Profiles lie in the plane z = 0
 * with y upward, surfaces have z upward: the flat is below the block. */
#ifndef RUGO_CORE_FULL_FILE_MESH_MSH_H
#define RUGO_CORE_FULL_FILE_MESH_MSH_H

#include "core/full/mesh.h"
#include <stdio.h>

/* ERROR_INPUT for a mesh whose columns widen: the format has no points that hang between others. */
int mesh_msh_check(const struct mesh *mesh, struct error *err);
/* Writes it; errors as of mesh_msh_check, and ERROR_SYSTEM. */
int mesh_msh(FILE *file, const struct mesh *mesh, struct error *err);

#endif
