/* The points and elements of a mesh as files of meshes list them.
 *
 * The periodic sides stand twice, so that no element wraps around. Each level is a plane of its
 * nodes, in which the last column and row repeat the first. Where columns widen, a second plane
 * follows: that of the corners of the narrower columns, which lie between the nodes of the wide
 * ones. Points are numbered from 0, from the face down, x fastest. */
#ifndef RUGO_CORE_FULL_FILE_MESH_POINTS_H
#define RUGO_CORE_FULL_FILE_MESH_POINTS_H

#include "core/full/mesh.h"
#include <stdio.h>

struct mesh_point {
    size_t number;
    size_t level;
    double x, y;           /* in columns of the face */
    size_t count, node[4]; /* it moves as the mean of these nodes */
    bool own;              /* it is the first image of a node: node[0] is this point's */
    bool right, back;      /* it lies on the side of the last column, of the last row */
};
size_t mesh_points_count(const struct mesh *mesh);
void mesh_points_each(const struct mesh *mesh,
                      void (*put)(void *context, const struct mesh_point *point), void *context);
/* Returns a component of a nodal field at a point. */
double mesh_point_mean(const struct mesh_point *point, const double *field, size_t components,
                       size_t component);
/* Fills the undeformed position in the grid's unit: along x, along y (0 in profiles), and upward
 * from the mean face. */
void mesh_point_position(const struct mesh *mesh, const struct mesh_point *point, double out[3]);

struct mesh_cell {
    size_t number, layer, j, i;
    size_t corners;   /* 4; 8 of surfaces */
    size_t corner[8]; /* numbers of points: those nearer to the face, then the deeper ones. They go
                         around as VTK, Gmsh and Abaqus order them */
};
void mesh_cells_each(const struct mesh *mesh,
                     void (*put)(void *context, const struct mesh_cell *cell), void *context);

/* Writes out what is left. ERROR_SYSTEM, with the reason that errno has, where that or anything
 * before it failed. */
int mesh_file_end(FILE *file, struct error *err);

#endif
