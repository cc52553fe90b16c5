/* The mesh of a rough block: a column of elements a grid cell, layers that grow with depth as the
 * layered model's (block_layers), the lower face on the surface. Sides are periodic: a node stands
 * for all its images.
 *
 * Lengths in steps along x (dx = 1). Node level*face + j*nx + i, level 0 on the face; its vertical
 * position is depth[level] - z * factor, the factor falling smoothly from 1 to 0 over the fine
 * zone: 40 RMS heights as the reference's, where the block is high enough. */
#ifndef RUGO_CORE_FULL_MESH_H
#define RUGO_CORE_FULL_MESH_H

#include "core/contact/compliance.h"

struct mesh {
    int dimension; /* 2: profiles */
    size_t nx, ny; /* columns */
    size_t face;   /* nodes a level: nx*ny */
    size_t layers; /* levels less 1 */
    size_t nodes;
    double across;  /* dy/dx; 1 in profiles */
    double unit;    /* dx, the grid's length */
    double *depth;  /* owned: layers + 1 levels of the flat mesh */
    double *height; /* owned: nodes, reference positions upward from the mean face */
    double slope;   /* steepest edge of the face */
    double quality; /* of the worst element (element_quality) */
};

/* A flat face. ERROR_INPUT for a grid or block out of range (compliance.h); ERROR_MEMORY. */
int mesh_create(struct mesh **out, const struct grid *grid, const struct block *block,
                struct error *err);
void mesh_destroy(struct mesh **mesh);
/* Puts the face on a surface of mean 0, z[face] in steps. ERROR_INPUT for one too steep or too high
 * for the block; the mesh is of no use then until the next call. */
int mesh_shape(struct mesh *mesh, const double *z, struct error *err);

/* Node a (element.h) of the element over column cell of the layer; side 1 of the last axis is the
 * deeper one. */
size_t mesh_node(const struct mesh *mesh, size_t layer, size_t j, size_t i, int a);
/* Reference positions of its nodes, from its own corner sideways. */
void mesh_position(const struct mesh *mesh, size_t layer, size_t j, size_t i,
                   double position[8][3]);
static inline size_t mesh_freedoms(const struct mesh *mesh) {
    return mesh->nodes * (size_t)mesh->dimension;
}
/* Freedom of a node's vertical displacement. */
static inline size_t mesh_vertical(const struct mesh *mesh, size_t node) {
    return (node + 1) * (size_t)mesh->dimension - 1;
}

#endif
