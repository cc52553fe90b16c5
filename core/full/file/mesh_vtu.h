/* A meshed block, and a solved step on it, as a VTU file (VTK's XML of unstructured grids, as
 * text), which ParaView, VisIt and meshio open.
 *
 * The periodic sides are written twice, so that no element wraps around. Profiles lie in the plane
 * z = 0 with y upward, surfaces have z upward: the flat is below the block.
 *
 * Arrays of elements are `quality` (core/full/element.h), and in a step `stress`, the element's
 * mean Cauchy stress, tension positive (XX, YY, XY in the plane of a profile; XX, YY, ZZ, XY, YZ,
 * XZ). Arrays of points, in a step, are `displacement`, and on the face `pressure` and `gap`, 0
 * elsewhere. */
#ifndef RUGO_CORE_FULL_FILE_MESH_VTU_H
#define RUGO_CORE_FULL_FILE_MESH_VTU_H

#include "core/full/full.h"
#include <stdio.h>

struct mesh_step {
    struct material material;
    const double *u;           /* full_displacement */
    struct contact_state face; /* its pressures and gaps */
    double unit;               /* in E*: pressures and stresses are written over it */
};
/* Writes a mesh; title is one line without "--", step may be NULL for the mesh alone. */
int mesh_vtu(FILE *file, const char *title, const struct mesh *mesh, const struct mesh_step *step,
             struct error *err);

#endif
