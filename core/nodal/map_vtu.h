/* A map with fields on it as a VTU file (VTK's XML of unstructured grids): what ParaView, VisIt and
 * meshio open.
 *
 * A surface is made of quadrangles between its points, with z upward; a profile of lines in the
 * plane z = 0 with y upward. Numbers are in base64, without loss. */
#ifndef RUGO_CORE_NODAL_MAP_VTU_H
#define RUGO_CORE_NODAL_MAP_VTU_H

#include "core/surface/grid.h"
#include <stdio.h>

struct map_field {
    const char *name;     /* letters, digits and _ */
    const double *values; /* grid_points; borrowed */
};
/* title: one line; what XML takes amiss in it is left out. ERROR_SYSTEM when it cannot be
 * written. */
int map_vtu(FILE *file, const char *title, const struct grid *grid, const double *z,
            size_t field_count, const struct map_field *fields, struct error *err);

#endif
