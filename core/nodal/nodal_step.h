/* What one load leaves at the nodes of a face, for files. Everything is borrowed. */
#ifndef RUGO_CORE_NODAL_NODAL_STEP_H
#define RUGO_CORE_NODAL_NODAL_STEP_H

#include "core/full/file/mesh_vtu.h"

struct nodal_step {
    double load;           /* in the unit in which it was given; 0: out of contact */
    const char *title;     /* units and mean pressure in one line without "--" */
    const char *lengths;   /* the grid's unit, as the title has it */
    struct grid grid;      /* of the nodes of the face */
    const double *z;       /* by node: height towards the flat before the load, the grid's unit */
    const double *gap;     /* by node: the grid's unit */
    const double *contact; /* by node: 1 in contact, else 0 */
    const double *p;       /* by node: in the unit that the title names */
    /* By node: displacement along x, along y and towards the flat, [3*node + k], the grid's unit.
     * NULL of models that have none. */
    const double *u;
    const struct mesh *mesh;      /* the whole block; NULL of models without one */
    const struct mesh_step *step; /* on the mesh; without a load its material alone matters */
};

#endif
