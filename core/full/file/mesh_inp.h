/* A meshed block on a rigid flat as an input file of CalculiX and Abaqus: a complete model, which
 * they run as it stands.
 *
 * Sets: BLOCK (elements C3D8); FACE, FAR (all points of the rough side and of the side away from
 * it); FAR_OWN (those of FAR that are no images); FLAT_NODES; BLOCK_NODES. Points on the sides of
 * the last column and row follow their images, and points between wider columns the mean of their
 * neighbours, by *EQUATION. The flat is one element whose nodes are held. Contact of the surfaces
 * ROUGH and FLAT is frictionless, with a linear penalty.
 *
 * A profile is one layer of elements as thick as its points lie apart, with y upward, held along z:
 * plane strain. Surfaces have z upward. Lengths are in the grid's unit, stresses in E*, so that E =
 * 1 - nu^2. */
#ifndef RUGO_CORE_FULL_FILE_MESH_INP_H
#define RUGO_CORE_FULL_FILE_MESH_INP_H

#include "core/full/material.h"
#include "core/full/mesh.h"
#include <stdio.h>

/* A step prescribes how far the far side moves towards the flat. */
struct inp_step {
    double displacement; /* from where the face touches first, the grid's unit */
    double pressure;     /* mean, in E*: for the reader, as a comment */
};
struct inp_model {
    const struct mesh *mesh;
    struct material material; /* finite strain: the steps say NLGEOM */
    size_t step_count;
    const struct inp_step *steps; /* borrowed */
};
/* lengths: the grid's unit, of one line, for the heading. ERROR_MEMORY; ERROR_SYSTEM when it cannot
 * be written. */
int mesh_inp(FILE *file, const char *lengths, const struct inp_model *model, struct error *err);

#endif
